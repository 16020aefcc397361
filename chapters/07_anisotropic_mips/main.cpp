// 07_anisotropic_mips: the light of the voxels, seen from six sides, at every size.
//
// For each direction, two voxels behind each other and four columns beside each other:
//
//     C = 1/4 sum_columns (C_front + s C_back),   s = min((1 - A_front) / A_back, 1)
//
// C: radiance times coverage, A: covered share of the cross-section; A is filtered as C is.
// Page: docs/07_anisotropic_mips.md
#include "01_first_light/first_light.hpp"
#include "07_anisotropic_mips/lit_voxels.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_params;
    VoxelViewParams level_params;
    PyramidViewParams direction_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(voxel_params, shadow_params, level_params, direction_params,
                                              display_params);

    App app(argc, argv,
            {"07_anisotropic_mips",
             {{"final", Encoding::radiance, "radiance of one level (level=) in one direction (direction=)"},
              {"voxels", Encoding::radiance, "the same"},
              {"coverage", Encoding::data, "covered share of the voxels' cross-section"}},
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    ShadowMaps shadow_maps(app.shaders());
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    PyramidViewPass pyramid_view(app.shaders());
    ToneMapPass tone_map(app.shaders());

    app.each_frame([&] {
        // snippet: frame
        // What the lights see, for the voxels.
        if (voxel_params.shading.voxel_shadows == VoxelShadows::map)
            app.pass("shadow maps", Scope::light, [&] { return shadow_maps.draw(scene, shadow_params); });

        // Triangles -> voxels -> radiance -> six pyramids.
        voxels.voxelize(app, scene);
        voxels.shade(app, scene, shadow_maps);
        voxels.filter(app);
        // end snippet

        // One level and direction -> picture.
        const gl::Buffer camera("camera", std::vector{app.camera()});
        const gl::Texture* linear = nullptr;
        app.pass("pyramid view", [&] {
            linear = &pyramid_view.run(voxels.grid(), voxels.voxelizer().occupancy(), voxels.pyramid(),
                                       level_params.level, direction_params, app.shows("coverage"), camera, app.size());
        });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params));
    });

    app.statistics().set_counts(voxels.counts());
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {voxel_material_needs(scene), shadow_maps.needs(scene)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene())});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
