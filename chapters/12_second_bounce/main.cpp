// 12_second_bounce: the voxels light each other, and the whole renderer stands: two bounces, and on to convergence.
//
// Every occupied face gathers by cones what the pixels gather, and the pyramids are made again:
//
//     L(k) = L(0) + rho * sum_i W_i L_i(k - 1),     L(0) = Le + (rho / pi) E_direct
//
// Page: docs/12_second_bounce.md
#include "01_first_light/tone_map.hpp"
#include "12_second_bounce/lit_pixels.hpp"
#include "12_second_bounce/second_bounce.hpp"
#include "app/needs.hpp"

using namespace conebook;

int main(int argc, char** argv)
try {
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_map_params;
    BounceParams bounce_params;
    EmitterParams emitter_params;
    LitPixelParams pixel_params;
    DisplayParams display_params;
    ParameterTable parameters =
        parameters_of(voxel_params, bounce_params, emitter_params, pixel_params, shadow_map_params, display_params);

    App app(argc, argv, {"12_second_bounce", light_views(), parameters});

    const GpuScene scene(app.scene());
    ShadowMaps shadow_maps(app.shaders(), scene, shadow_map_params);
    const bool asks_maps = ask_shadow_maps(pixel_params.shadows, voxel_params.shading);
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    Emitters emitters(app.shaders(), app.scene(), voxels.grid(), voxels.voxelizer(), emitter_params);
    SecondBounce second_bounce(app.shaders(), emitters.are_apart());
    LitPixels pixels(app.shaders(), voxels.grid(), emitters, app.size(), pixel_params);
    ToneMapPass tone_map(app.shaders());

    while (app.next_frame()) {
        // What the lights see, if pixels or voxels ask.
        if (asks_maps) app.pass("shadow maps", [&] { shadow_maps.draw(scene); });

        // Triangles -> voxels -> radiance -> six pyramids.
        voxels.run(app, scene, shadow_maps, emitters.part_of_voxels());

        // What shines -> pyramids of its own, and parts to aim at.
        if (voxels.are_new())
            app.pass("emitters", [&] { emitters.run(voxels.grid(), voxels.faces(), voxels.shading()); });

        // Voxels light voxels; the pyramids again, once for each further bounce.
        app.pass("further bounces",
                 [&] { second_bounce.run(voxels, emitters, pixels.cones(), pixel_params.cones, bounce_params); });

        // What the camera sees: g-buffer -> direct light -> diffuse and specular cones -> their sum.
        const gl::Texture& linear = pixels.run(app, scene, voxels, shadow_maps, bounce_params.bounces != 0);

        // Exposure, tone curve, sRGB.
        app.show(linear, tone_map.run(linear, app.view().encoding, display_params,
                                      data_scale(app.view(), scene.bounds())));
    }

    std::vector<Count> counts = voxels.counts();
    counts.push_back({"gatherings from voxel to voxel", double(second_bounce.gatherings()), ""});
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources(), emitters.resources(),
                             second_bounce.resources(), pixels.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), voxel_material_needs(scene), shadow_maps.needs(scene),
                              pixels.needs(app.scene(), bounce_params.bounces != 0)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene()),
                                emitters.need(),
                                {"further bounces", second_bounce.gatherings() > 0,
                                 "bounces=" + std::to_string(bounce_params.bounces)}});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
