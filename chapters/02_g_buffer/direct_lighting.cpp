#include "02_g_buffer/direct_lighting.hpp"

namespace conebook {

DirectLightingPass::DirectLightingPass(gl::Shaders& shaders, Shadows shadows)
    : program_(shaders.load({"common/fullscreen.vert", "02_g_buffer/direct_light.frag"},
                            {{"SHADOWS", shadows == Shadows::maps ? "1" : "0"}}))
{
}

const gl::Texture& DirectLightingPass::run(const GBuffer& g_buffer, const GpuScene& scene, LightingOutput output)
{
    if (radiance_.size_2d() != g_buffer.size()) {
        radiance_ = gl::texture_2d("direct light", GL_RGBA32F, g_buffer.size());
        framebuffer_ = gl::Framebuffer("direct light", {&radiance_});
    }
    framebuffer_.bind(radiance_.size_2d());
    g_buffer.bind();
    scene.bind_lights(program_);
    program_.set("with_emission", output == LightingOutput::direct_and_emission);
    program_.use();
    gl::draw_fullscreen_triangle(empty_);
    return radiance_;
}

}  // namespace conebook
