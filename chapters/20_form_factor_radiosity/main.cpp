// 20_form_factor_radiosity: patches, and the share of its light that each sends to every other, once for all light
//
// The scene is cut into patches. Form factors say what each of them sees of the others, directly and in mirrors;
// light is then the solution of a linear system, with irradiance H as unknown:
//
//     H_i = sum_j F^_ij (E_j + rho_j H_j),      B_i = E_i + rho_i H_i
//
// E: emission and what punctual lights cause directly. Nothing of it depends on the camera. Page:
// docs/20_form_factor_radiosity.md
#include "01_first_light/first_light.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "03_shadow_map/shadow_maps.hpp"
#include "08_diffuse_cones/composite.hpp"
#include "20_form_factor_radiosity/patch_pictures.hpp"
#include "app/needs.hpp"

using namespace conebook;

namespace {

std::vector<View> light_and_patch_views()
{
    return joined({{"final", Encoding::radiance, "all light, W/(sr m^2)"},
                   {"direct", Encoding::radiance, "direct light of punctual lights"},
                   {"indirect_diffuse", Encoding::radiance, "light that patches sent, reflected diffusely"},
                   {"indirect_specular", Encoding::radiance, "the same in mirrors and rough lobes"}},
                  joined(surface_views(), patch_views()));
}

}  // namespace

int main(int argc, char** argv)
try {
    RadiosityParams params;
    PatchPickParams pick_params;
    PixelParams pixel_params;
    ShadowMapParams shadow_map_params;
    CompositeParams composite_params;
    DisplayParams display_params;
    ParameterTable parameters =
        parameters_of(params, pick_params, pixel_params, shadow_map_params, composite_params, display_params);

    App app(argc, argv, {"20_form_factor_radiosity", light_and_patch_views(), parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    Radiosity radiosity(app.shaders(), app.scene());
    ShadowMaps shadow_maps(app.shaders());
    GBuffer g_buffer(app.shaders(), app.size());
    GBufferViewPass g_buffer_view(app.shaders());
    DirectLightingPass direct_lighting(app.shaders(), Shadows::maps);
    PatchValuePass patch_values(app.shaders());
    CompositePass composite(app.shaders());
    BoxFilterPass box_filter(app.shaders());
    ToneMapPass tone_map(app.shaders());
    UploadedPicture specular, unfolded;
    Revision shown = 0;

    app.each_frame([&] {
        const LightParts parts = parts_of_view(app.view().name);

        // Triangles to patches, finer where light changes.
        app.pass("patches", params.patches.adaptive ? Scope::light : Scope::scene,
                 [&] { return radiosity.make_patches(params, scene); });

        // What every patch sees, the one thing that takes long. Light may change without it.
        app.pass("form factors", Scope::scene, [&] { return radiosity.find_form_factors(params); });

        // What punctual lights give to patches, as exact as the rays that look for shadows.
        app.pass("direct light of patches", Scope::light, [&] { return radiosity.light_patches(scene); });

        // Sweeps over all rows until nothing changes, or a sweep a bounce.
        app.pass("solve", Scope::light, [&] { return radiosity.solve(params); });

        // One value a patch to values at corners.
        app.pass("corners", Scope::light, [&] { return radiosity.fit_corners(params); });

        // What the camera sees, with several samples a pixel where the picture is of light; and its direct light.
        const int side = app.view().encoding == Encoding::radiance ? pixel_params.pixel_samples : 1;
        const glm::ivec2 samples = side * app.size();
        g_buffer.resize(samples);
        app.pass("g-buffer", [&] { g_buffer.draw(scene, camera_data(app.scene_camera(), samples, scene.bounds())); });
        app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, shadow_map_params); });
        const gl::Texture* direct = nullptr;
        if (parts.direct > 0.0f)
            app.pass("direct light", [&] {
                shadow_maps.bind(direct_lighting.program());
                direct = &direct_lighting.run(g_buffer, scene, LightingOutput::direct);
            });

        // E / pi at every pixel: the rasterizer interpolates between corners.
        const gl::Texture* gathered = nullptr;
        app.pass("irradiance", [&] {
            gathered = &patch_values.run(g_buffer, radiosity.patches(), radiosity.corners(), 1.0f / kPi,
                                         {&radiosity, radiosity.corners_revision()});
        });

        // Mirrors and rougher lobes: rays from each pixel to surfaces and their light.
        const gl::Texture* reflected = nullptr;
        if (parts.specular > 0.0f && has_specular_surfaces(app.scene()))
            app.pass("specular light", [&] {
                reflected = &specular.set(specular_picture(radiosity, params, pixel_params.lobe_rays, scene.lights(),
                                                           app.scene_camera(), samples));
            });

        // The sum of the parts, or another view.
        const gl::Texture* linear = nullptr;
        app.pass("composite", [&] {
            linear = &composite.run(g_buffer, direct, gathered, reflected, parts, composite_params, 0.0f);
        });
        app.pass("view", [&] {
            if (const gl::Texture* surface = g_buffer_view.run(g_buffer, app.view().name)) linear = surface;
            const std::uint32_t picked = picked_patch(radiosity.patches(), pick_params, app.scene_camera(), app.size());
            if (const auto values = patch_view_values(app.view().name, radiosity, picked))
                linear = &patch_values.run(g_buffer, radiosity.patches(), *values, 1.0f, {&shown, ++shown});
            if (app.shows("hemicube")) linear = &unfolded.set(hemicube_picture(radiosity, params, picked, app.size()));
        });

        // Samples to pixels, then exposure, tone curve, sRGB.
        app.pass("box filter", [&] { linear = &box_filter.run(*linear, side); });
        app.show(*linear,
                 tone_map.run(*linear, app.view().encoding, display_params, data_scale(app.view(), scene.bounds())));
    });

    app.statistics().set_counts(radiosity.counts());
    for (const auto& part : {scene.resources(), radiosity.resources(), shadow_maps.resources(), g_buffer.resources(),
                             patch_values.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), radiosity.needs(params), shadow_maps.needs(scene)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
