// 12_second_bounce: the voxels light each other, and the whole renderer stands: two bounces, and on to convergence.
//
// Every occupied face gathers by cones what the pixels gather, and the pyramids are made again:
//
//     L(k) = L(0) + rho * sum_i W_i L_i(k - 1),     L(0) = Le + (rho / pi) E_direct
//
// Page: docs/12_second_bounce.md
#include "01_first_light/tone_map.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "09_specular_cones/specular_cones.hpp"
#include "10_soft_shadows/soft_shadows.hpp"
#include "12_second_bounce/second_bounce.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_map_params;
    SoftShadowParams shadow_params;
    ConeParams cone_params;
    DiffuseConeParams diffuse_params;
    SpecularConeParams specular_params;
    BounceParams bounce_params;
    CompositeParams composite_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(voxel_params, bounce_params, cone_params, diffuse_params,
                                              specular_params, shadow_params, shadow_map_params, composite_params,
                                              display_params);

    App app(argc, argv,
            {"12_second_bounce",
             joined({{"final", Encoding::radiance, "all light"},
                     {"direct", Encoding::radiance, "direct light alone"},
                     {"indirect_diffuse", Encoding::radiance, "indirect light through the diffuse lobe"},
                     {"indirect_specular", Encoding::radiance, "indirect light through the specular lobe"},
                     {"ambient_occlusion", Encoding::data, "share of the hemisphere that is open"},
                     {"voxels", Encoding::radiance, "radiance of the voxels after the last bounce"}},
                    surface_views()),
             parameters});

    const GpuScene scene(app.scene());
    ShadowMaps shadow_maps(app.shaders(), scene, shadow_map_params);
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    SecondBounce second_bounce(app.shaders());
    GBuffer g_buffer(app.shaders(), app.size());
    SoftShadowLighting direct_lighting(app.shaders(), voxels.grid(), ShadowMethod(shadow_params.shadows));
    const DiffuseConeUniforms cones(cone_params);
    DiffuseCones diffuse_cones(app.shaders(), voxels.grid(), diffuse_params);
    SpecularCones specular_cones(app.shaders());
    CompositePass composite(app.shaders());
    PyramidViewPass pyramid_view(app.shaders());
    GBufferViewPass g_buffer_view(app.shaders());
    ToneMapPass tone_map(app.shaders());

    while (app.next_frame()) {
        // What the lights see.
        app.pass("shadow maps", [&] { shadow_maps.draw(scene); });

        // Triangles -> voxels -> radiance -> six pyramids.
        voxels.run(app, scene, shadow_maps);

        // Voxels light voxels; the pyramids again, once for each further bounce.
        app.pass("further bounces", [&] { second_bounce.run(voxels, cones, cone_params, bounce_params); });

        // What the camera sees.
        g_buffer.resize(app.size());
        app.pass("g-buffer", [&] { g_buffer.draw(scene, app.camera()); });

        // Light straight from the lights.
        const gl::Texture* direct = nullptr;
        app.pass("direct light", [&] {
            direct = &direct_lighting.run(g_buffer, scene, voxels, shadow_maps, cone_params, shadow_params, false);
        });

        // Light by way of other surfaces: wide cones for the diffuse lobe, one narrow cone for the specular one.
        const gl::Texture *gathered = nullptr, *specular = nullptr;
        if (bounce_params.bounces != 0) {
            app.pass("diffuse cones", [&] {
                gathered = &diffuse_cones.run(g_buffer, voxels.grid(), voxels.pyramid(), cones, cone_params);
            });
            app.pass("specular cones", [&] {
                specular = &specular_cones.run(g_buffer, voxels.grid(), voxels.pyramid(), cone_params, specular_params);
            });
        }

        // Sum, or one of the intermediate results.
        const gl::Texture* linear = nullptr;
        app.pass("composite", [&] {
            const gl::Buffer camera("camera", std::vector{app.camera()});
            if (app.shows("voxels"))
                linear = &pyramid_view.run(voxels.grid(), voxels.voxelizer().occupancy(), voxels.pyramid(), 0,
                                           PyramidViewParams{}, false, camera, app.size());
            else if (linear = g_buffer_view.run(g_buffer, app.view().name); linear == nullptr)
                linear = &composite.run(g_buffer, direct, gathered, specular, parts_of_view(app.view().name),
                                        composite_params, cone_params.sky);
        });
        app.show(*linear, tone_map.run(*linear, app.view().encoding, display_params,
                                       data_scale(app.view(), scene.bounds())));
    }

    std::vector<Count> counts = voxels.counts();
    counts.push_back({"gatherings from voxel to voxel", double(second_bounce.gatherings()), ""});
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources(), second_bounce.resources(),
                             g_buffer.resources(), direct_lighting.resources()})
        app.statistics().add_resources(part);
    if (bounce_params.bounces != 0) {
        app.statistics().add_resources(diffuse_cones.resources());
        app.statistics().add_resources(specular_cones.resources());
    }
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
