// What emitters send to the pixels.
#pragma once

#include "11_emissives/emitters.hpp"

namespace conebook {

class EmitterLight {
public:
    explicit EmitterLight(gl::Shaders& shaders);
    // RGBA32F of the g-buffer's size: what `cones` have gathered (`gathered`, their last result), and what emitters send.
    const gl::Texture& run(const GBuffer& g_buffer, const ConeVolumes& volumes, const Emitters& emitters,
                           const DiffuseCones& cones, const gl::Texture& gathered, const ConeParams& params, int sample = 0);
    std::vector<gl::Resource> resources() const;

private:
    gl::ProgramVariants sample_, add_;
    PointFilter arriving_filter_, unshadowed_filter_;
    gl::VertexArray no_vertices_;
    gl::Texture arriving_, unshadowed_, light_;
    gl::Framebuffer samples_framebuffer_, light_framebuffer_;
};

}  // namespace conebook
