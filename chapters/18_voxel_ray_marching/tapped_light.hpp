// Direct light with the document's soft shadows: many taps into the shadow map round each point.
#pragma once

#include "02_g_buffer/g_buffer.hpp"
#include "03_shadow_map/shadow_maps.hpp"

namespace conebook {

struct TapParams {
    int shadow_taps = 64;        // of each pixel and light, 1 .. 256; 1: chapter 03's filter
    float shadow_radius = 2.0f;  // of the disc that they are spread over, texels, 0 .. 64
};
void add_parameters(ParameterTable& table, TapParams& params);

class TappedLight {
public:
    explicit TappedLight(gl::Shaders& shaders);
    // RGBA32F, W/(sr m^2), alpha 1 where there is a surface. Valid until the next call.
    const gl::Texture& run(const GBuffer& g_buffer, const GpuScene& scene, const ShadowMaps& maps,
                           const TapParams& params);
    std::vector<gl::Resource> resources() const { return {radiance_.resource()}; }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture radiance_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
