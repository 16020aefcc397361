#include "02_g_buffer/direct_lighting.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

DirectLightingPass::DirectLightingPass(gl::Shaders& shaders, Shadows shadows)
    : program_(shaders.load({"common/fullscreen.vert", "02_g_buffer/direct_light.frag"},
                            {{"SHADOWS", shadows == Shadows::maps ? "1" : "0"}}))
{
}

const gl::Texture& DirectLightingPass::run(const GBuffer& g_buffer, const GpuScene& scene, LightingOutput output)
{
    gl::fit_to_pixels(radiance_, framebuffer_, "direct light", GL_RGBA32F, g_buffer.size());
    g_buffer.bind();
    scene.bind_lights(program_);
    program_.set("with_emission", output == LightingOutput::direct_and_emission);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, g_buffer.size());
    return radiance_;
}

}  // namespace conebook
