// 14_speed_against_error: chapter 12's frame under the stopwatch, with every texture fetch of its cones counted.
//
// A setting is worth its time when no other one is both faster and nearer to the truth:
//
//     Pareto front = { s : there is no s' with t(s') <= t(s), e(s') <= e(s), and one of them smaller }
//
// t: ms a frame, e: error against the path tracer. ./run report measures both for many settings.
// Page: docs/14_speed_against_error.md
#include "01_first_light/first_light.hpp"
#include "12_second_bounce/camera_light.hpp"
#include "14_speed_against_error/fetch_counter.hpp"
#include "14_speed_against_error/part_pictures.hpp"
#include "app/needs.hpp"

using namespace conebook;

namespace {

struct MeasureParams {
    // Count the fetches of the last frame's cones, after it has been timed.
    bool count_fetches = false;
    // Write all parts of the light of the last frame, see part_pictures.hpp.
    bool write_parts = false;
};

void add_parameters(ParameterTable& table, MeasureParams& params)
{
    table.add("count_fetches", params.count_fetches, "count what the cones fetch, for --stats; not in any pass's time");
    table.add("write_parts", params.write_parts, "with --output X.exr: also X_final.exr, X_direct.exr, ...");
}

}  // namespace

int main(int argc, char** argv)
try {
    SceneLightParams scene_params;
    CameraLightParams camera_params;
    DisplayParams display_params;
    MeasureParams measure_params;
    ParameterTable parameters = parameters_of(scene_params, camera_params, display_params, measure_params);

    App app(argc, argv,
            {"14_speed_against_error",
             joined(light_views(),
                    {{"fetches", Encoding::data, "texture fetches of a pixel's cones; .exr: diffuse, specular, both"}}),
             parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    SceneLight scene_light(app.shaders(), app.scene(), scene, scene_params);
    CameraLight camera_light(app.shaders(), scene_light, app.size(), camera_params);
    FetchCounter fetch_counter(app.shaders());
    ToneMapPass tone_map(app.shaders());
    const SceneTraits traits = traits_of(app.scene());
    const auto make_plan = [&] {
        return plan_light(traits, scene_params.voxels.shading, scene_params.bounces, camera_params.shadows);
    };
    FetchCounts fetches;

    app.each_frame([&] {
        // Chapter 12's frame: light in the voxels, surfaces, cones, sum.
        const LightPlan plan = make_plan();
        scene_light.run(app, scene, camera_params.cones, plan);
        camera_light.see(app, scene);
        camera_light.gather(app, plan);
        const gl::Texture& linear = camera_light.sum(app);

        // The same cones once more, to count: outside of every pass, so that no time holds it.
        const bool last = app.frame() + 1 == app.options().frames;
        if (app.shows("fetches") || (measure_params.count_fetches && last && plan.diffuse_cones.used)) {
            fetch_counter.run(scene_light, camera_light, camera_params, plan.specular_cones.used);
            fetches = fetch_counter.counts(camera_light.g_buffer());
        }
        if (app.shows("fetches"))
            app.show(fetch_counter.show(camera_light.g_buffer()),
                     fetch_counter.heat_map(camera_light.g_buffer(), fetches.largest));
        else
            app.show(linear,
                     tone_map.run(linear, app.view().encoding, display_params, data_scale(app.view(), scene.bounds())));
    });
    if (measure_params.write_parts && !app.options().output.empty()) {
        write_part_pictures(app.options().output, camera_light);
        camera_light.composite(app.view().name);  // where the parts were is what finish() writes
    }

    std::vector<Count> counts = scene_light.counts();
    if (measure_params.count_fetches || app.shows("fetches")) {
        counts.push_back({"points that gather, per pixel", fetches.points_per_pixel, ""});
        counts.push_back({"walk steps per point, diffuse", fetches.diffuse_steps, ""});
        counts.push_back({"fetches per point, diffuse", fetches.diffuse, ""});
        counts.push_back({"walk steps per pixel, specular", fetches.specular_steps, ""});
        counts.push_back({"fetches per pixel, specular", fetches.specular, ""});
        counts.push_back({"look-ups of the worst point", fetches.largest, ""});
    }
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), scene_light.resources(), camera_light.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs :
         {scene_light.needs(app.scene(), scene), camera_light.needs(app.scene()), make_plan().decisions()})
        app.statistics().add_needs(needs);
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
