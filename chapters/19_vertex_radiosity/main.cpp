// 19_vertex_radiosity: every vertex is a patch, and the patches that a light sees most of become lights themselves.
//
//     E_i = sum_lights I cos / d^2 V  +  sum_c Phi_c cos_i cos_c V / (pi r^2 + A_c),     L = rho / pi E + Le
//
// A texture holds the irradiance E of all patches; drawing the scene, each vertex looks up its own.
// Page: docs/19_vertex_radiosity.md
#include "01_first_light/first_light.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "19_vertex_radiosity/radiosity_view.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    VertexRadiosityParams radiosity_params;
    RadiosityViewParams view_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(radiosity_params, view_params, display_params);

    App app(argc, argv,
            {"19_vertex_radiosity",
             joined({{"final", Encoding::radiance, "all light"},
                     {"direct", Encoding::radiance, "direct light of the patches"},
                     {"indirect_diffuse", Encoding::radiance, "light from patch to patch"},
                     {"radiosity_map", Encoding::radiance, "irradiance of all patches, W/m^2, as it lies in the map"},
                     {"ray_map", Encoding::radiance, "what a light sees: a colour for each patch (layer=)"},
                     {"reduction", Encoding::radiance, "the same, halved until there is one patch a cell"},
                     {"lights", Encoding::radiance,
                      "arrows: red the scene's lights, green and blue those of steps 2 and 3"}},
                    surface_views()),
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    VertexRadiosity radiosity(app.shaders(), app.scene(), radiosity_params);
    RadiosityView radiosity_view(app.shaders());
    GBuffer g_buffer(app.shaders(), app.size());
    GBufferViewPass g_buffer_view(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // What has changed of: patches -> their direct light -> patches that become lights -> their light.
        radiosity.run(app, scene);

        // The scene with this light; or a map of it.
        const gl::Texture* linear = nullptr;
        app.pass("picture", [&] {
            const std::string& view = app.view().name;
            if (view == "radiosity_map")
                linear = &radiosity_view.draw_map(radiosity, app.size());
            else if (view == "ray_map" || view == "reduction")
                linear =
                    &radiosity_view.draw_light_view(radiosity, scene, view_params, view == "reduction", app.size());
            else if (view == "lights")
                linear = &radiosity_view.draw_lights(radiosity, scene, app.camera(), app.size());
            else if (view == "final" || view == "direct" || view == "indirect_diffuse" || view == "emission")
                linear = &radiosity_view.draw(radiosity, scene, app.camera(), app.size(), parts_of_view(view));
        });

        // Or what the surfaces are made of.
        if (linear == nullptr)
            app.pass("g-buffer", [&] {
                g_buffer.resize(app.size());
                g_buffer.draw(scene, app.camera());
                linear = g_buffer_view.run(g_buffer, app.view().name);
            });
        app.show(*linear,
                 tone_map.run(*linear, app.view().encoding, display_params, data_scale(app.view(), scene.bounds())));
    });

    app.statistics().set_counts(radiosity.counts());
    for (const auto& part : {scene.resources(), radiosity.resources()}) app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), radiosity.needs()}) app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
