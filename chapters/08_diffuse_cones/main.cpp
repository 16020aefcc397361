// 08_diffuse_cones: indirect diffuse light, one bounce, by many narrow cones that leap over empty space.
//
// The hemisphere above a surface is divided among cones k with weights W_k that sum to 1:
//
//     L_o = rho * sum_k W_k L_k,     L_k: the light where the coverage on the way passes the threshold of cone k, or the sky
//
// Page: docs/08_diffuse_cones.md
#include "01_first_light/first_light.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "07_anisotropic_mips/lit_voxels.hpp"
#include "08_diffuse_cones/composite.hpp"
#include "08_diffuse_cones/diffuse_cones.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_params;
    ConeParams cone_params;
    DiffuseConeParams diffuse_params;
    CompositeParams composite_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(voxel_params, shadow_params, cone_params, diffuse_params,
                                              composite_params, display_params);

    App app(argc, argv,
            {"08_diffuse_cones",
             {{"final", Encoding::radiance, "direct and indirect diffuse light and emission"},
              {"direct", Encoding::radiance, "direct light alone"},
              {"indirect_diffuse", Encoding::radiance, "indirect diffuse light alone"},
              {"ambient_occlusion", Encoding::data, "share of the hemisphere that is open"},
              {"emission", Encoding::radiance, "emitted radiance"}},
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    ShadowMaps shadow_maps(app.shaders());
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    GBuffer g_buffer(app.shaders(), app.size());
    DirectLightingPass direct_lighting(app.shaders(), Shadows::maps);
    WalkVolume walk_volume(app.shaders());
    ConeDirections directions;
    DiffuseCones diffuse_cones(app.shaders());
    CompositePass composite(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // What the lights see.
        app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, shadow_params); });

        // Triangles -> voxels -> radiance -> six pyramids.
        voxels.voxelize(app, scene);
        voxels.shade(app, scene, shadow_maps);
        voxels.filter(app);

        // Where rays may leap, and what they meet.
        app.pass("walk volume", Scope::scene, [&] { return walk_volume.run(voxels.grid(), voxels.faces()); });

        // What the camera sees.
        g_buffer.resize(app.size());
        app.pass("g-buffer", [&] { g_buffer.draw(scene, app.camera()); });

        // Light straight from the lights.
        const gl::Texture* direct = nullptr;
        app.pass("direct light", [&] {
            shadow_maps.bind(direct_lighting.program());
            direct = &direct_lighting.run(g_buffer, scene, LightingOutput::direct);
        });

        // Light by way of one other surface: cones through the pyramids.
        const gl::Texture* gathered = nullptr;
        app.pass("diffuse cones", [&] {
            directions.update(cone_params, 0);
            gathered = &diffuse_cones.run(g_buffer, {voxels.grid(), voxels.pyramid(), walk_volume}, directions, cone_params,
                                          diffuse_params);
        });

        // Sum.
        const gl::Texture* linear = nullptr;
        app.pass("composite", [&] {
            linear = &composite.run(g_buffer, direct, gathered, nullptr, parts_of_view(app.view().name),
                                    composite_params, cone_params.sky);
        });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params));
    });

    app.statistics().set_counts(voxels.counts());
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources(), g_buffer.resources(), direct_lighting.resources(), diffuse_cones.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), voxel_material_needs(scene), shadow_maps.needs(scene)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene()), sky_need(cone_params.sky)});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
