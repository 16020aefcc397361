// Draws the scene and lights every pixel at once: the shortest way from triangles to radiance.
#pragma once

#include <optional>
#include <string>

#include "gl/gpu_scene.hpp"
#include "gl/handles.hpp"
#include "gl/shaders.hpp"

namespace conebook {

// What the pass writes; forward.frag has the same numbers.
enum class ForwardOutput : int { radiance, direct, emission, base_color, normal, depth };

// That of the view with this name, if any: the outputs' names are those of the views that all chapters have.
std::optional<ForwardOutput> forward_output(const std::string& view);

class ForwardPass {
public:
    explicit ForwardPass(gl::Shaders& shaders);

    // RGBA32F of `size` pixels, alpha 1 where there is a surface, all 0 elsewhere. radiance, direct and emission in
    // W/(sr m^2), linear base colour, normal * 0.5 + 0.5 (scene space), depth along the camera's axis in m.
    // The result is valid until the next call.
    const gl::Texture& run(const GpuScene& scene, const shared::CameraData& camera, glm::ivec2 size,
                           ForwardOutput output);

    std::vector<gl::Resource> resources() const;

private:
    gl::Program program_;
    gl::Buffer camera_buffer_;
    gl::Texture color_, depth_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
