// Deferred shading, first half: the surface under each pixel, drawn once and read by every later pass.
#pragma once

#include "gl/gpu_scene.hpp"
#include "gl/handles.hpp"
#include "gl/shaders.hpp"

namespace conebook {

// 44 bytes a pixel:
//   depth               DEPTH32F       reversed: 1 at the near plane, 0 at the far one and where nothing was drawn
//   normal              RG16_SNORM     shading normal, octahedral, scene space, of the side that is seen
//   geometric_normal    RG16_SNORM     of the triangle, octahedral, towards the camera
//   base_color_metallic RGBA16         linear; 8 bits would be 10 % off at 0.02; 0 for unlit materials
//   f0_f90              RGBA16         specular reflectance at normal and at grazing incidence
//   emission_roughness  RGBA32F        radiance, W/(sr m^2); perceptual roughness
class GBuffer {
public:
    GBuffer(gl::Shaders& shaders, glm::ivec2 size);

    // Size in pixels; does nothing when it is the same.
    void resize(glm::ivec2 size);
    void draw(const GpuScene& scene, const shared::CameraData& camera);
    // For shaders that include common/g_buffer.glsl: textures on units 8..13, kCameraBlock.
    void bind() const;

    std::size_t drawn() const { return drawn_; }  // draws of the last picture: of objects that the camera may see
    glm::ivec2 size() const { return depth_.size_2d(); }
    const gl::Texture& depth() const { return depth_; }
    const gl::Texture& normal() const { return normal_; }
    const gl::Texture& geometric_normal() const { return geometric_normal_; }
    const gl::Texture& base_color_metallic() const { return base_color_metallic_; }
    const gl::Texture& f0_f90() const { return f0_f90_; }
    const gl::Texture& emission_roughness() const { return emission_roughness_; }
    std::vector<gl::Resource> resources() const;

private:
    gl::Program program_;
    std::size_t drawn_ = 0;
    gl::Buffer camera_buffer_;
    gl::Texture depth_, normal_, geometric_normal_, base_color_metallic_, f0_f90_, emission_roughness_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
