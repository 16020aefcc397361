// 13_ground_truth: a path tracer beside the cones: is it right, and if not, where and by how much?
//
// Random paths have the rendering equation's solution as their mean, whatever the scene, and say how uncertain they are:
//
//     L = 1/N sum_i f L_i cos / p  +-  s / sqrt(N)
//
// Page: docs/13_ground_truth.md
#include <algorithm>
#include <thread>

#include "01_first_light/first_light.hpp"
#include "12_second_bounce/camera_light.hpp"
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
    SceneLightParams scene_params;
    CameraLightParams camera_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(reference_params, scene_params, camera_params, display_params);

    App app(argc, argv, {"13_ground_truth", reference_views(), parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    SceneLight scene_light(app.shaders(), app.scene(), scene, scene_params);
    CameraLight camera_light(app.shaders(), scene_light, app.size(), camera_params);
    const bool headless = app.options().headless;
    BackgroundTracer path_tracer(app.scene(), tracer_threads(headless));
    SideBySide side_by_side(app.shaders());
    ToneMapPass tone_map(app.shaders());
    const SceneTraits traits = traits_of(app.scene());
    const auto make_plan = [&] {
        return plan_light(traits, scene_params.voxels.shading, scene_params.bounces, camera_params.shadows);
    };

    app.each_frame([&] {
        const Show show = what_to_show(app.view(), reference_params, headless);

        // The path tracer's picture of the same light: headless so many samples a frame; in a window a thread refines
        // it, and the frame takes what is there.
        const gl::Texture* reference = nullptr;
        if (show != Show::picture)
            app.pass("path tracer", [&] {
                const TraceJob job{app.scene_camera(), app.size(), *part_of(app.view()), scene_params.bounces.bounces,
                                   camera_params.cones.sky};
                path_tracer.follow(job, headless ? reference_params.spp * (app.frame() + 1) : kEndless);
                if (headless) path_tracer.wait();
                reference = &side_by_side.upload(path_tracer.newest(), app.size());
            });

        // The frame of chapter 12; what it is made of is made in the first frame, even when cones are not shown yet.
        const gl::Texture* picture = nullptr;
        if (show != Show::reference || app.frame() == 0) {
            const LightPlan plan = make_plan();
            scene_light.run(app, scene, camera_params.cones, plan);
            camera_light.see(app, scene);
            camera_light.gather(app, plan);
            picture = &camera_light.sum(app);
        }

        // The tracer goes on.
        if (reference != nullptr && !headless) app.expect_more();

        // One of them, or both as one picture.
        SideBySideResult result;
        app.pass("side by side", [&] {
            result = side_by_side.run(show, picture, reference, app.view().encoding, reference_params.difference_range);
        });

        // Exposure, tone curve, sRGB.
        app.show(*result.linear, tone_map.run(*result.shown, result.encoding, display_params,
                                              data_scale(app.view(), scene.bounds())));
    });

    std::vector<Count> counts = scene_light.counts();
    if (const auto traced = path_tracer.newest()) {
        const glm::dvec3 error = traced->mean.standard_error;
        counts.push_back({"samples per pixel", double(traced->samples), ""});
        counts.push_back({"mean standard error of a pixel", traced->pixel_error, "W/(sr m^2)"});
        counts.push_back({"standard error of the mean", std::max({error.x, error.y, error.z}), "W/(sr m^2)"});
    }
    app.statistics().set_counts(counts);
    for (const auto& part :
         {scene.resources(), scene_light.resources(), camera_light.resources(), side_by_side.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs :
         {scene_light.needs(app.scene(), scene), camera_light.needs(app.scene()), make_plan().decisions()})
        app.statistics().add_needs(needs);
    app.statistics().add_needs({{"path tracer", path_tracer.newest() != nullptr,
                                 "view " + app.view().name + ", show=" + show_name(reference_params.show)}});
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
