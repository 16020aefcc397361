// 09_specular_cones: glossy reflection by a few cones a pixel, from mirror to matte.
//
// N cones share the GGX lobe: their directions mirror the eye's at normals that it sees, and together they are as wide as
// the share p of the lobe. Their weighted mean is multiplied by the lobe's directional albedo, which a table holds:
//
//     L_o = (F0 x + F90 y) * sum_i w_i L_i / sum_i w_i,     w = F(v.h) G2 / G1
//     tan(theta_h) = alpha sqrt(p / (1 - p)),     half angle of a cone = 2 theta_h / sqrt(N)
//
// Page: docs/09_specular_cones.md
#include "01_first_light/first_light.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "07_anisotropic_mips/lit_voxels.hpp"
#include "08_diffuse_cones/composite.hpp"
#include "09_specular_cones/specular_cones.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_params;
    ConeParams cone_params;
    DiffuseConeParams diffuse_params;
    SpecularConeParams specular_params;
    CompositeParams composite_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(specular_params, voxel_params, shadow_params, cone_params,
                                              diffuse_params, composite_params, display_params);

    App app(argc, argv,
            {"09_specular_cones",
             {{"final", Encoding::radiance, "direct, indirect diffuse and indirect specular light, emission"},
              {"direct", Encoding::radiance, "direct light alone"},
              {"indirect_diffuse", Encoding::radiance, "indirect light through the diffuse lobe"},
              {"indirect_specular", Encoding::radiance, "indirect light through the specular lobe"},
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
    const ConeVolumes volumes{voxels.grid(), voxels.pyramid(), walk_volume};
    ConeDirections directions;
    DiffuseCones diffuse_cones(app.shaders());
    SpecularCones specular_cones(app.shaders());
    const bool reflective = has_specular_surfaces(app.scene());
    CompositePass composite(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // What the lights see.
        app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, shadow_params); });

        // Triangles -> voxels -> radiance -> six pyramids, and where rays may leap.
        voxels.voxelize(app, scene);
        voxels.shade(app, scene, shadow_maps);
        voxels.filter(app);
        app.pass("walk volume", Scope::scene, [&] { return walk_volume.run(voxels.grid(), voxels.faces()); });

        // What the camera sees, and what of it the lights reach.
        const gl::Texture* direct = nullptr;
        g_buffer.resize(app.size());
        app.pass("g-buffer", [&] { g_buffer.draw(scene, app.camera()); });
        app.pass("direct light", [&] {
            shadow_maps.bind(direct_lighting.program());
            direct = &direct_lighting.run(g_buffer, scene, LightingOutput::direct);
        });

        // Wide cones for the diffuse lobe.
        const gl::Texture *gathered = nullptr, *specular = nullptr;
        app.pass("diffuse cones", [&] {
            directions.update(cone_params, 0);
            gathered = &diffuse_cones.run(g_buffer, volumes, directions, cone_params, diffuse_params);
        });

        // One cone along the mirror direction for the specular lobe, if any surface has one.
        if (reflective)
            app.pass("specular cones", [&] {
                specular = &specular_cones.run(g_buffer, volumes, cone_params, specular_params);
            });

        // Sum.
        const gl::Texture* linear = nullptr;
        app.pass("composite", [&] {
            linear = &composite.run(g_buffer, direct, gathered, specular, parts_of_view(app.view().name),
                                    composite_params, cone_params.sky);
        });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params));
    });

    app.statistics().set_counts(voxels.counts());
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources(), g_buffer.resources(),
                             direct_lighting.resources(), diffuse_cones.resources(), specular_cones.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), voxel_material_needs(scene), shadow_maps.needs(scene)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs(
        {light_need(app.scene()), sky_need(cone_params.sky), specular_cone_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
