// Deferred shading, second half: direct light from the g-buffer, every pixel once however many triangles it had.
#pragma once

#include "02_g_buffer/g_buffer.hpp"

namespace conebook {

enum class Shadows { none, maps };
enum class LightingOutput { direct, direct_and_emission };

class DirectLightingPass {
public:
    // Shadows::maps: bind the maps of chapter 03 to program() before run().
    DirectLightingPass(gl::Shaders& shaders, Shadows shadows);

    const gl::Program& program() const { return program_; }

    // RGBA32F, W/(sr m^2), size of the g-buffer; alpha 1 where there is a surface. Valid until the next call.
    const gl::Texture& run(const GBuffer& g_buffer, const GpuScene& scene, LightingOutput output);

    std::vector<gl::Resource> resources() const { return {radiance_.resource()}; }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture radiance_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
