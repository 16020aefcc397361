#include "01_first_light/tone_map.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, DisplayParams& params)
{
    table.add("exposure", params.exposure, 0.0, 1.0e6, "", "factor on radiance before the tone curve (.png, window)");
    table.add("white", params.white, 0.1, 1.0e6, "", "exposed luminance that is shown as white");
    table.add("tone_curve", params.tone_curve, {"reinhard", "clamp"}, "how radiance above 1 is brought into 0..1");
    table.add("srgb", params.srgb, "encode for the display; off: linear values, too dark");
}

float data_scale(const View& view, const Bounds& bounds)
{
    return view.name == "depth" && bounds.longest_side() > 0.0f ? 0.5f / bounds.longest_side() : 1.0f;
}

ToneMapPass::ToneMapPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "01_first_light/tone_map.frag"}))
{
}

const gl::Texture& ToneMapPass::run(const gl::Texture& linear, Encoding encoding, const DisplayParams& params,
                                    float data_scale)
{
    gl::fit_to_pixels(display_, framebuffer_, "display", GL_RGBA8, linear.size_2d());
    linear.bind(0);
    program_.set("encoding", int(encoding));
    program_.set("tone_curve", int(params.tone_curve));
    program_.set("exposure", params.exposure);
    program_.set("white", params.white);
    program_.set("srgb", params.srgb);
    program_.set("data_scale", data_scale);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, linear.size_2d());
    return display_;
}

}  // namespace conebook
