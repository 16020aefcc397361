// 03_shadow_map: every light draws the scene too, and what it does not see lies in shadow.
//
//     V = mean over texels of [ the receiver's plane at the texel is not behind what the light saw there ]
//
// for directional lights (one orthographic map), spots (one perspective map) and points (six of them).
// Page: docs/03_shadow_map.md
#include "01_first_light/first_light.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "03_shadow_map/layer_view.hpp"
#include "03_shadow_map/shadow_maps.hpp"
#include "app/app.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    ShadowMapParams shadow_params;
    LayerViewParams layer_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(shadow_params, layer_params, display_params);

    App app(argc, argv,
            {"03_shadow_map",
             joined({{"final", Encoding::radiance, "direct light with shadows, and emission"},
                     {"direct", Encoding::radiance, "direct light with shadows"},
                     {"shadow_map", Encoding::data, "what a light saw: distance in one map, 1 near .. 0 far (layer=)"}},
                    surface_views()),
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    ShadowMaps shadow_maps(app.shaders());
    LayerViewPass layer_view(app.shaders());
    GBuffer g_buffer(app.shaders(), app.size());
    GBufferViewPass g_buffer_view(app.shaders());
    DirectLightingPass direct_lighting(app.shaders(), Shadows::maps);
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // snippet: frame
        // What the lights see.
        app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, shadow_params); });

        // What the camera sees.
        g_buffer.resize(app.size());
        app.pass("g-buffer", [&] { g_buffer.draw(scene, app.camera()); });

        // Light of the lights that see the pixel's surface.
        const gl::Texture* linear = nullptr;
        app.pass("direct light", [&] {
            shadow_maps.bind(direct_lighting.program());
            linear = &direct_lighting.run(
                g_buffer, scene, app.shows("direct") ? LightingOutput::direct : LightingOutput::direct_and_emission);
        });
        // end snippet

        // Another view, if one was asked for.
        if (const gl::Texture* attachment = g_buffer_view.run(g_buffer, app.view().name)) linear = attachment;
        if (app.shows("shadow_map")) linear = &layer_view.run(shadow_maps, layer_params, app.size());
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params,
                                       data_scale(app.view(), scene.bounds())));
    });

    for (const auto& part : {scene.resources(), shadow_maps.resources(), g_buffer.resources(),
                             direct_lighting.resources()})
        app.statistics().add_resources(part);
    app.statistics().set_counts({{"lights", double(scene.lights().size()), ""},
                                 {"shadow maps", double(shadow_maps.layers()), ""},
                                 {"shadow map side", double(shadow_maps.size()), "texels"}});
    for (const auto& needs : {surface_needs(app.scene()), shadow_maps.needs(scene)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
