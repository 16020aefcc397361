// 01_first_light: a glTF scene, punctual lights, a picture
//
// The first frame of the book: every triangle is drawn once, every pixel adds up what it emits and what it reflects
// of each light, and the result is turned into something that a display can show.
//
//     L_o = L_e + sum over lights of (rho/pi + F D V) E cos(theta)            W/(sr m^2)
//
// E is I/d^2 for point and spot lights (I in W/sr) and given for directional ones (W/m^2); no shadows yet, those come
// in chapter 03. Page: docs/01_first_light.md
#include "01_first_light/forward_pass.hpp"
#include "01_first_light/tone_map.hpp"
#include "app/app.hpp"
#include "app/needs.hpp"

using namespace conebook;

namespace {

ProgramInfo program_info(DisplayParams& display)
{
    ProgramInfo info;
    info.name = "01_first_light";
    info.views = {
        {"final", Encoding::radiance, "direct light and emission, W/(sr m^2)"},
        {"direct", Encoding::radiance, "reflected light of all lights, W/(sr m^2)"},
        {"emission", Encoding::radiance, "emitted light, W/(sr m^2)"},
        {"base_color", Encoding::color, "base colour, linear in .exr"},
        {"normal", Encoding::data, "shading normal in scene space, * 0.5 + 0.5"},
        {"depth", Encoding::data, "distance along the camera's axis, m in .exr, scaled in .png"},
    };
    add_parameters(info.parameters, display);
    return info;
}

}  // namespace

int main(int argc, char** argv)
try {
    DisplayParams display;
    App app(argc, argv, program_info(display));
    const GpuScene scene(app.scene());
    ForwardPass forward(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        const gl::Texture* linear = nullptr;
        const gl::Texture* picture = nullptr;

        // snippet: frame
        // Triangles to radiance: draw the scene, light each pixel.
        app.pass("forward", [&] {
            linear = &forward.run(scene, app.camera(), app.size(), *forward_output(app.view().name));
        });

        // Radiance to the display: exposure, tone curve, sRGB, once and last.
        app.pass("tone map", [&] {
            picture = &tone_map.run(*linear, app.view().encoding, display, data_scale(app.view(), scene.bounds()));
        });
        app.show(*linear, *picture);
        // end snippet
    });

    for (const auto& part : {scene.resources(), forward.resources(), tone_map.resources()})
        app.statistics().add_resources(part);
    app.statistics().set_counts({{"triangles", double(scene.triangle_count()), ""},
                                 {"lights", double(scene.lights().size()), ""}});
    app.statistics().add_needs(surface_needs(app.scene()));
    app.statistics().add_needs({light_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
