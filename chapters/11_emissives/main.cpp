// 11_emissives: surfaces that shine light the room; nothing but their radiance in the voxels is needed.
//
//     L = Le + (rho / pi) E  in every face, so a cone that meets an emitter gathers Le; a disc of radius R at height h
//     above a plane gives E = pi Le R^2 / (R^2 + h^2)
//
// Page: docs/11_emissives.md
#include "01_first_light/tone_map.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "09_specular_cones/specular_cones.hpp"
#include "11_emissives/emissive_light.hpp"

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
    cone_params.cones = 3;  // 16: emitters are small and bright, a cone meets them or not
    ParameterTable parameters = parameters_of(voxel_params, shadow_params, cone_params, diffuse_params,
                                              specular_params, composite_params, display_params);

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
    ShadowMaps shadow_maps(app.shaders(), scene, shadow_params);
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    EmissiveLight emissive_light(app.shaders());
    GBuffer g_buffer(app.shaders(), app.size());
    DirectLightingPass direct_lighting(app.shaders(), Shadows::maps);
    const DiffuseConeUniforms cones(cone_params);
    DiffuseCones diffuse_cones(app.shaders(), voxels.grid(), diffuse_params);
    SpecularCones specular_cones(app.shaders());
    CompositePass composite(app.shaders());
    ToneMapPass tone_map(app.shaders());

    while (app.next_frame()) {
        // What the lights see.
        app.pass("shadow maps", [&] { shadow_maps.draw(scene); });

        // Triangles -> voxels -> radiance -> six pyramids.
        voxels.run(app, scene, shadow_maps);

        // snippet: emitters_alone
        // On request keep of the faces' light only what they emit, and make the pyramids from that.
        if (app.shows("from_emitters"))
            app.pass("emitters alone",
                     [&] { voxels.pyramid().run(voxels.grid(), voxels.faces(), emissive_light.run(voxels.faces())); });
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
        app.pass("diffuse cones",
                 [&] { gathered = &diffuse_cones.run(g_buffer, voxels.grid(), voxels.pyramid(), cones, cone_params); });
        app.pass("specular cones", [&] {
            specular = &specular_cones.run(g_buffer, voxels.grid(), voxels.pyramid(), cone_params, specular_params);
        });

        // Sum.
        LightParts parts = parts_of_view(app.view().name);
        if (app.shows("from_emitters")) parts = {0, 1, 1, 0, false};
        const gl::Texture* linear = nullptr;
        app.pass("composite", [&] {
            linear = &composite.run(g_buffer, direct, gathered, specular, parts, composite_params, cone_params.sky);
        });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params));
    }

    std::vector<Count> counts = voxels.counts();
    const glm::dvec3 power_w = emitted_power_w(voxels.faces(), voxels.grid());
    for (int channel = 0; channel < 3; ++channel)
        counts.push_back({std::string("emitted power, ") + "rgb"[channel], power_w[channel], "W"});
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources(), g_buffer.resources(),
                             direct_lighting.resources(), diffuse_cones.resources(), specular_cones.resources()})
        app.statistics().add_resources(part);
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
