// 10_soft_shadows: a cone to every light, as wide as the light looks, and the shadow's edge is as soft as it should be.
//
//     V = mean over thin cones of 1 - coverage that they meet,     sin(half angle) = light radius / distance
//
// beside the shadow maps of chapter 03 and the visibility that the voxels of chapter 06 keep.
// Page: docs/10_soft_shadows.md
#include "01_first_light/first_light.hpp"
#include "10_soft_shadows/soft_shadows.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_map_params;
    SoftShadowParams shadow_params;
    ConeParams cone_params;
    CompositeParams composite_params;
    DisplayParams display_params;
    shadow_params.shadows = ShadowMethod::cone;
    ParameterTable parameters =
        parameters_of(shadow_params, voxel_params, shadow_map_params, cone_params, composite_params, display_params);

    App app(argc, argv,
            {"10_soft_shadows",
             {{"final", Encoding::radiance, "direct light with the shadows chosen by shadows=, and emission"},
              {"direct", Encoding::radiance, "direct light alone"},
              {"visibility", Encoding::data, "mean visible share of the lights"},
              {"emission", Encoding::radiance, "emitted radiance"}},
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    ShadowMaps shadow_maps(app.shaders());
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    WalkVolume walk_volume(app.shaders());
    GBuffer g_buffer(app.shaders(), app.size());
    SoftShadowLighting lighting(app.shaders());
    CompositePass composite(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // What the lights see, if pixels or voxels ask.
        if (asks_shadow_maps(shadow_params) || voxel_params.shading.voxel_shadows == VoxelShadows::map)
            app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, shadow_map_params); });

        // Triangles -> voxels -> radiance -> six pyramids.
        voxels.voxelize(app, scene);
        voxels.shade(app, scene, shadow_maps);
        voxels.filter(app);

        // Where rays may leap.
        app.pass("walk volume", Scope::scene, [&] { return walk_volume.run(voxels.grid(), voxels.faces()); });

        // What the camera sees.
        g_buffer.resize(app.size());
        app.pass("g-buffer", [&] { g_buffer.draw(scene, app.camera()); });

        // Cones to the lights.
        const gl::Texture* direct = nullptr;
        app.pass("direct light", [&] {
            direct = &lighting.run(g_buffer, scene, {voxels.grid(), voxels.pyramid(), walk_volume}, voxels.faces(),
                                   voxels.shading(), shadow_maps, cone_params, shadow_params, app.shows("visibility"));
        });

        // Sum; the visibility is shown as it is.
        const gl::Texture* linear = direct;
        if (!app.shows("visibility"))
            app.pass("composite", [&] {
                linear = &composite.run(g_buffer, direct, nullptr, nullptr, parts_of_view(app.view().name),
                                        composite_params, cone_params.sky);
            });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params));
    });

    app.statistics().set_counts(voxels.counts());
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources(), walk_volume.resources(),
                             g_buffer.resources(), lighting.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), voxel_material_needs(scene), shadow_maps.needs(scene),
                              soft_shadow_needs(shadow_params, !app.scene().lights.empty())})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene()), sky_need(cone_params.sky)});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
