// 02_g_buffer: deferred shading
//
// The frame is cut in two: triangles write what they are made of into a g-buffer, and a second pass over the pixels
// computes the light. Every later chapter starts from this buffer: cones begin at its positions, with its normals.
//
//     position = (scene_from_clip * (2 x / w - 1, 2 y / h - 1, depth, 1)).xyz / .w
//
// Same picture as chapter 01. Page: docs/02_g_buffer.md
#include "01_first_light/tone_map.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "02_g_buffer/g_buffer.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "app/app.hpp"
#include "app/needs.hpp"

using namespace conebook;

namespace {

struct Params {
    DisplayParams display;
    // Bits of a fixed point depth, 0..24; 0: the 32 bit float that is stored. Fewer show why it is one.
    int depth_bits = 0;
};

ProgramInfo program_info(Params& params)
{
    ProgramInfo info;
    info.name = "02_g_buffer";
    info.views = {{"final", Encoding::radiance, "direct light and emission, W/(sr m^2)"},
                  {"direct", Encoding::radiance, "reflected light of all lights, W/(sr m^2)"}};
    for (const std::vector<View>& views : {surface_views(), attachment_views()})
        info.views.insert(info.views.end(), views.begin(), views.end());
    add_parameters(info.parameters, params.display);
    info.parameters.add("depth_bits", params.depth_bits, 0, 24, "bits",
                        "read depth as fixed point; 0: as the float it is");
    return info;
}

}  // namespace

int main(int argc, char** argv)
try {
    Params params;
    App app(argc, argv, program_info(params));
    const GpuScene scene(app.scene());
    GBuffer g_buffer(app.shaders(), app.size());
    DirectLightingPass direct_lighting(app.shaders(), Shadows::none);
    GBufferViewPass g_buffer_view(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        for (const gl::Program& program : {direct_lighting.program(), g_buffer_view.program()})
            program.set("g_depth_bits", params.depth_bits);
        const gl::Texture* linear = nullptr;
        const gl::Texture* picture = nullptr;

        // snippet: frame
        // Triangles to surfaces: position, normals, material of what each pixel sees.
        app.pass("g-buffer", [&] {
            g_buffer.resize(app.size());
            g_buffer.draw(scene, app.camera());
        });

        // Surfaces to radiance: every light at every pixel.
        app.pass("direct light", [&] {
            linear = &direct_lighting.run(
                g_buffer, scene, app.shows("direct") ? LightingOutput::direct : LightingOutput::direct_and_emission);
        });
        // end snippet

        // Another view, if one was asked for.
        app.pass("view", [&] {
            if (const gl::Texture* attachment = g_buffer_view.run(g_buffer, app.view().name)) linear = attachment;
        });

        // Radiance to the display.
        app.pass("tone map", [&] {
            picture =
                &tone_map.run(*linear, app.view().encoding, params.display, data_scale(app.view(), scene.bounds()));
        });
        app.show(*linear, *picture);
    });

    for (const auto& part :
         {scene.resources(), g_buffer.resources(), direct_lighting.resources(), tone_map.resources()})
        app.statistics().add_resources(part);
    app.statistics().set_counts(
        {{"triangles", double(scene.triangle_count()), ""}, {"lights", double(scene.lights().size()), ""}});
    app.statistics().add_needs(surface_needs(app.scene()));
    app.statistics().add_needs({light_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
