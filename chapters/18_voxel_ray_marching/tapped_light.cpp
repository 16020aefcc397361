#include "18_voxel_ray_marching/tapped_light.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, TapParams& params)
{
    table.add("shadow_taps", params.shadow_taps, 1, 256, "",
              "looks into the shadow map a pixel; 1: chapter 03's filter");
    table.add("shadow_radius", params.shadow_radius, 0.0, 64.0, "texels", "of the disc of the taps");
}

TappedLight::TappedLight(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "18_voxel_ray_marching/tapped_light.frag"}))
{
}

const gl::Texture& TappedLight::run(const GBuffer& g_buffer, const GpuScene& scene, const ShadowMaps& maps,
                                    const TapParams& params)
{
    gl::fit_to_pixels(radiance_, framebuffer_, "direct light", GL_RGBA32F, g_buffer.size());
    g_buffer.bind();
    scene.bind_lights(program_);
    maps.bind(program_);
    program_.set("shadow_taps", params.shadow_taps);
    program_.set("shadow_radius", params.shadow_radius);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, g_buffer.size());
    return radiance_;
}

}  // namespace conebook
