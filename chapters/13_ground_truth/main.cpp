// 13_ground_truth: a path tracer beside the cones: is it right, and if not, where and by how much?
//
// Random paths have the rendering equation's solution as their mean, whatever the scene, and say how uncertain they are:
//
//     L = 1/N sum_i f L_i cos / p  +-  s / sqrt(N)
//
// Page: docs/13_ground_truth.md
#include <algorithm>
#include <thread>

#include "01_first_light/tone_map.hpp"
#include "12_second_bounce/lit_pixels.hpp"
#include "12_second_bounce/second_bounce.hpp"
#include "13_ground_truth/background_tracer.hpp"
#include "13_ground_truth/side_by_side.hpp"
#include "app/needs.hpp"

using namespace conebook;

namespace {

constexpr int kEndless = 1 << 20;  // samples after which nobody sees a difference

// In a window one core is left to the frames.
int tracer_threads(bool headless)
{
    return headless ? 0 : std::max(1, int(std::thread::hardware_concurrency()) - 1);
}

}  // namespace

int main(int argc, char** argv)
try {
    ReferenceParams reference_params;
    LitVoxelParams voxel_params;
    ShadowMapParams shadow_map_params;
    BounceParams bounce_params;
    EmitterParams emitter_params;
    LitPixelParams pixel_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(reference_params, voxel_params, bounce_params, emitter_params, pixel_params,
                                              shadow_map_params, display_params);

    App app(argc, argv, {"13_ground_truth", reference_views(), parameters});

    const GpuScene scene(app.scene());
    ShadowMaps shadow_maps(app.shaders(), scene, shadow_map_params);
    const bool asks_maps = ask_shadow_maps(pixel_params.shadows, voxel_params.shading);
    LitVoxels voxels(app.shaders(), scene, voxel_params);
    Emitters emitters(app.shaders(), app.scene(), voxels.grid(), voxels.voxelizer(), emitter_params);
    SecondBounce second_bounce(app.shaders(), emitters.are_apart());
    LitPixels pixels(app.shaders(), voxels.grid(), emitters, app.size(), pixel_params);
    const bool headless = app.options().headless;
    BackgroundTracer path_tracer(app.scene(), tracer_threads(headless));
    SideBySide side_by_side(app.shaders());
    ToneMapPass tone_map(app.shaders());

    while (app.next_frame()) {
        const Show show = what_to_show(app.view(), reference_params, headless);

        // The path tracer's picture of the same light: headless so many samples a frame; in a window a thread refines
        // it, and the frame takes what is there.
        const gl::Texture* reference = nullptr;
        if (show != Show::picture)
            app.pass("path tracer", [&] {
                const TraceJob job{app.scene_camera(), app.size(), *part_of(app.view()), bounce_params.bounces,
                                   pixel_params.cones.sky};
                path_tracer.follow(job, headless ? reference_params.spp * (app.frame() + 1) : kEndless);
                if (headless) path_tracer.wait();
                reference = &side_by_side.upload(path_tracer.newest(), app.size());
            });

        // The frame of chapter 12; its voxels are made in the first frame, even when cones are not shown yet.
        const gl::Texture* picture = nullptr;
        if (show != Show::reference || app.frame() == 0) {
            if (asks_maps) app.pass("shadow maps", [&] { shadow_maps.draw(scene); });
            voxels.run(app, scene, shadow_maps, emitters.part_of_voxels());
            if (voxels.are_new())
                app.pass("emitters", [&] { emitters.run(voxels.grid(), voxels.faces(), voxels.shading()); });
            app.pass("further bounces",
                     [&] { second_bounce.run(voxels, emitters, pixels.cones(), pixel_params.cones, bounce_params); });
            picture = &pixels.run(app, scene, voxels, shadow_maps, bounce_params.bounces != 0);
        }

        // One of them, or both as one picture.
        SideBySideResult result;
        app.pass("side by side", [&] {
            result = side_by_side.run(show, picture, reference, app.view().encoding, reference_params.difference_range);
        });

        // Exposure, tone curve, sRGB.
        app.show(*result.linear, tone_map.run(*result.shown, result.encoding, display_params,
                                              data_scale(app.view(), scene.bounds())));
    }

    std::vector<Count> counts = voxels.counts();
    counts.push_back({"gatherings from voxel to voxel", double(second_bounce.gatherings()), ""});
    if (const auto traced = path_tracer.newest()) {
        const glm::dvec3 error = traced->mean.standard_error;
        counts.push_back({"samples per pixel", double(traced->samples), ""});
        counts.push_back({"mean standard error of a pixel", traced->pixel_error, "W/(sr m^2)"});
        counts.push_back({"standard error of the mean", std::max({error.x, error.y, error.z}), "W/(sr m^2)"});
    }
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), shadow_maps.resources(), voxels.resources(), emitters.resources(), second_bounce.resources(),
                             pixels.resources(), side_by_side.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {surface_needs(app.scene()), voxel_material_needs(scene), shadow_maps.needs(scene),
                              pixels.needs(app.scene(), bounce_params.bounces != 0)})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({light_need(app.scene()), emitters.need(),
                                {"further bounces", second_bounce.gatherings() > 0,
                                 "bounces=" + std::to_string(bounce_params.bounces)},
                                {"path tracer", path_tracer.newest() != nullptr,
                                 "view " + app.view().name + ", show=" + show_name(Show(reference_params.show))}});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
