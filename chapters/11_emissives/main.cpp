// 11_emissives: surfaces that shine light the room: exactly where nothing is in the way, and rays say what arrives.
//
//     E = sum_triangles Le / 2 sum_edges angle (n . normal of the edge's plane)  x  arriving / unshadowed of shared rays
//
// Page: docs/11_emissives.md
#include "01_first_light/first_light.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "08_diffuse_cones/composite.hpp"
#include "11_emissives/emitter_light.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_params;
    ConeParams cone_params;
    DiffuseConeParams diffuse_params;
    SpecularConeParams specular_params;
    EmitterParams emitter_params;
    CompositeParams composite_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(voxel_params, shadow_params, cone_params, diffuse_params, specular_params,
                                              emitter_params, composite_params, display_params);

    App app(argc, argv,
            {"11_emissives",
             {{"final", Encoding::radiance, "all light of one bounce"},
              {"direct", Encoding::radiance, "light straight from the lamps"},
              {"indirect_diffuse", Encoding::radiance, "indirect light through the diffuse lobe"},
              {"indirect_specular", Encoding::radiance, "indirect light through the specular lobe"},
              {"from_emitters", Encoding::radiance, "diffuse and specular light of emitting surfaces alone"},
              {"ambient_occlusion", Encoding::data, "share of the hemisphere that is open"},
              {"emission", Encoding::radiance, "emitted radiance"}},
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    ShadowMaps shadow_maps(app.shaders());
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    Emitters emitters(app.shaders(), app.scene());
    WalkVolume walk_volume(app.shaders());
    const ConeVolumes volumes{voxels.grid(), voxels.pyramid(), walk_volume};
    GBuffer g_buffer(app.shaders(), app.size());
    DirectLightingPass direct_lighting(app.shaders(), Shadows::maps);
    ConeDirections directions;
    DiffuseCones diffuse_cones(app.shaders());
    EmitterLight emitter_light(app.shaders());
    SpecularCones specular_cones(app.shaders());
    const bool reflective = has_specular_surfaces(app.scene());
    CompositePass composite(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // What the lights see.
        app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, shadow_params); });

        // snippet: emission_apart
        // Triangles -> voxels -> what they emit -> six pyramids, and the parts of it to aim at.
        voxels.voxelize(app, scene);
        voxels.shade(app, scene, shadow_maps);
        app.pass("emitters", Scope::scene, [&] {
            return emitters.run(scene, voxels.grid(), voxels.faces(), voxels.shading(), emitter_params);
        });

        // What they reflect -> six more. On request nothing that they reflect.
        voxels.filter(app, !app.shows("from_emitters") ? emitters.part_of_voxels()
                           : emitters.are_apart()      ? LightPart::none
                                                       : LightPart::emitted);
        app.pass("walk volume", Scope::scene, [&] { return walk_volume.run(voxels.grid(), voxels.faces()); });
        // end snippet

        // What the camera sees, and what of it the lamps reach.
        const gl::Texture* direct = nullptr;
        g_buffer.resize(app.size());
        app.pass("g-buffer", [&] { g_buffer.draw(scene, app.camera()); });
        app.pass("direct light", [&] {
            shadow_maps.bind(direct_lighting.program());
            direct = &direct_lighting.run(g_buffer, scene, LightingOutput::direct);
        });

        // Light of other surfaces, shining or lit.
        const gl::Texture *gathered = nullptr, *specular = nullptr;
        app.pass("diffuse cones", [&] {
            directions.update(cone_params, 0);
            gathered = &diffuse_cones.run(g_buffer, volumes, directions, cone_params, diffuse_params);
        });
        app.pass("emitters' light", [&] {
            gathered = &emitter_light.run(g_buffer, volumes, emitters, diffuse_cones, *gathered, cone_params);
            return emitters.are_apart();
        });
        if (reflective)
            app.pass("specular cones", [&] {
                emitters.bind_emission();
                specular = &specular_cones.run(g_buffer, volumes, cone_params, specular_params, 0,
                                               emitters.specular_folder());
            });

        // Sum.
        LightParts parts = parts_of_view(app.view().name);
        if (app.shows("from_emitters")) parts = {0, 1, 1, 0, false};
        const gl::Texture* linear = nullptr;
        app.pass("composite", [&] {
            linear = &composite.run(g_buffer, direct, gathered, specular, parts, composite_params, cone_params.sky);
        });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params));
    });

    std::vector<Count> counts = voxels.counts();
    const glm::dvec3 power_w = emitted_power_w(voxels.faces(), voxels.grid());
    for (int channel = 0; channel < 3; ++channel)
        counts.push_back({std::string("emitted power, ") + "rgb"[channel], power_w[channel], "W"});
    app.statistics().set_counts(counts);
    for (const auto& part :
         {scene.resources(), shadow_maps.resources(), voxels.resources(), emitters.resources(), g_buffer.resources(),
          direct_lighting.resources(), diffuse_cones.resources(), specular_cones.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), voxel_material_needs(scene), shadow_maps.needs(scene)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs(
        {light_need(app.scene()), emitters.need(), sky_need(cone_params.sky), specular_cone_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
