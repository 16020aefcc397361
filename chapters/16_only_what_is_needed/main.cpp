// 16_only_what_is_needed: volumes, passes and cones that this picture of this scene needs, no others.
//
// A part x of the frame is made when something that is shown is made from it:
//
//     used(x) = shown(x) or used(y) for some y that reads x,     and x is not zero in this scene
//
// Page: docs/16_only_what_is_needed.md
#include <iostream>

#include "01_first_light/first_light.hpp"
#include "16_only_what_is_needed/brick_storage.hpp"
#include "16_only_what_is_needed/chosen_settings.hpp"
#include "16_only_what_is_needed/plan_lines.hpp"

using namespace conebook;

namespace {

struct PrintParams {
    bool print_plan = false;  // after the last frame, to the standard output
};

void add_parameters(ParameterTable& table, PrintParams& params)
{
    table.add("print_plan", params.print_plan, "print what the last frame took, and why");
}

}  // namespace

int main(int argc, char** argv)
try {
    SceneLightParams asked_of_scene;
    CameraLightParams asked_of_camera;
    DisplayParams display_params;
    NeedParams need_params;
    DemandParams demand;
    PrintParams print_params;
    ParameterTable parameters =
        parameters_of(demand, need_params, print_params, asked_of_scene, asked_of_camera, display_params);
    add_storage_parameter(parameters, asked_of_scene);

    App app(argc, argv, {"16_only_what_is_needed", light_views(), parameters});

    const GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    const SceneTraits traits = traits_of(app.scene());
    ChosenSettings chosen(app.options().root / "assets" / "plan.json", app.options().scene.stem().string(), scene,
                          traits);
    const SceneLightParams& scene_params = chosen.scene();
    const CameraLightParams& camera_params = chosen.camera();
    BrickStorage bricks(app.shaders(), scene_params);
    SceneLight scene_light(app.shaders(), app.scene(), scene, scene_params, bricks.storages());
    CameraLight camera_light(app.shaders(), scene_light, app.size(), camera_params);
    ToneMapPass tone_map(app.shaders());
    LightPlan plan;

    app.each_frame([&] {
        // The reader's settings, or those that keep to an error, to memory, to a time.
        chosen.update(demand, {asked_of_scene, asked_of_camera, app.view().name}, need_params, app.size(),
                      parameters.values(), app.statistics());

        // What of all that follows this picture of this scene needs.
        plan = plan_frame(traits, {scene_params, camera_params, app.view().name}, need_params);

        // What has changed of: shadow maps -> voxels -> their direct light -> all bounces -> six pyramids.
        scene_light.run(app, scene, camera_params.cones, plan);

        // What the camera sees, and what of it the lights reach.
        camera_light.see(app, scene, plan);

        // What other surfaces send: diffuse and specular cones through the pyramids.
        camera_light.gather(app, plan);

        // Their sum; the mean of many frames while nothing changes.
        const gl::Texture& linear = camera_light.sum(app);

        // Exposure, tone curve, sRGB.
        app.show(linear,
                 tone_map.run(linear, app.view().encoding, display_params, data_scale(app.view(), scene.bounds())));
    });

    std::vector<PlanLine> lines = demand_lines(chosen);
    for (const PlanLine& line : plan_lines(plan, scene_light, camera_light, scene_params, camera_params, app))
        lines.push_back(line);
    if (const PlanLine line = brick_line(bricks.resources()); line.bytes > 0) lines.push_back(line);
    if (print_params.print_plan) std::cout << plan_text(lines);
    app.statistics().set_plan(lines);
    std::vector<Count> counts = scene_light.counts();
    for (const Count& count : chosen.counts()) counts.push_back(count);
    for (const Count& count : plan_counts(lines, app)) counts.push_back(count);
    const double draws = double(scene.draw_count()), maps = double(scene_light.shadow_maps().layers());
    counts.push_back({"draws of the scene", draws, ""});
    counts.push_back({"draws for the camera", double(camera_light.g_buffer().drawn()), ""});
    counts.push_back({"draws for the shadow maps", double(scene_light.shadow_maps().draws()), ""});
    counts.push_back({"draws for the shadow maps, of all objects", draws * maps, ""});
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), bricks.resources(), scene_light.resources(), camera_light.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs : {scene_light.needs(app.scene(), scene), camera_light.needs(app.scene()), plan.decisions()})
        app.statistics().add_needs(needs);
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
