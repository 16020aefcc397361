// 15_dynamic_scenes: things and lights move, and only what depends on them is done again.
//
// A face's mean is a quotient of integer sums, and those of what stands still and of what moves add up to the last bit:
//
//     sum(face) = S + D,     S once, D of every pose
//
// Page: docs/15_dynamic_scenes.md
#include <chrono>
#include <cmath>
#include <optional>

#include "01_first_light/first_light.hpp"
#include "12_second_bounce/camera_light.hpp"
#include "15_dynamic_scenes/changes.hpp"
#include "15_dynamic_scenes/dynamic_voxels.hpp"
#include "15_dynamic_scenes/moving_scene.hpp"
#include "15_dynamic_scenes/scene_objects.hpp"

using namespace conebook;

namespace {

// Time that goes on from where the parameter was last set.
class Clock {
public:
    // `time`: the parameter, which shows what time it is.
    void advance(float& time, double duration_s)
    {
        const auto now = std::chrono::steady_clock::now();
        if (last_shown_ == time)
            time = float(std::fmod(double(time) + std::chrono::duration<double>(now - last_).count(), duration_s));
        last_ = now;
        last_shown_ = time;
    }

private:
    std::chrono::steady_clock::time_point last_{};
    float last_shown_ = -1.0f;
};

}  // namespace

int main(int argc, char** argv)
try {
    SceneLightParams scene_params;
    scene_params.bounces.warm_start = true;
    CameraLightParams camera_params;
    MotionParams motion_params;
    DynamicVoxelParams dynamic_params;
    ChangeParams change_params;
    ObjectParams object_params;
    DisplayParams display_params;
    ParameterTable parameters = parameters_of(scene_params, camera_params, motion_params, dynamic_params, change_params,
                                              object_params, display_params);
    add_warm_start(parameters, scene_params.bounces);

    SceneObjects objects(object_params);
    App app(argc, argv, {"15_dynamic_scenes", light_views(), parameters, [&](Scene& loaded) {
                             objects.place_first(loaded);
                             hold_all_poses(loaded);
                         }});
    const bool in_window = !app.options().headless;

    GpuScene scene(app.scene());
    app.show_meanwhile(first_light(app, scene, display_params));
    objects.follow_reader(app);
    std::optional<MovingScene> moving(std::in_place, app.shaders(), app.scene());
    SceneLight scene_light(app.shaders(), app.scene(), scene, scene_params);
    DynamicVoxels dynamic_voxels(app.shaders());
    CameraLight camera_light(app.shaders(), scene_light, app.size(), camera_params);
    ToneMapPass tone_map(app.shaders());
    SceneTraits traits = traits_of(app.scene());
    const auto make_plan = [&] {
        return plan_light(traits, scene_params.voxels.shading, scene_params.bounces, camera_params.shadows);
    };
    Clock clock;
    MadeFrom<float> followed;  // by the camera: time

    app.each_frame([&] {
        // Objects that the reader has put into the scene, moved, or given a material.
        const ObjectChanges changes = objects.update(app, scene);
        if (changes.others) moving.emplace(app.shaders(), app.scene());
        if (changes.others || !changes.materials.empty()) traits = traits_of(app.scene());

        // What time it is, and where everything is then.
        if (in_window && motion_params.play && moving->moves()) {
            clock.advance(motion_params.time, moving->duration_s());
            app.expect_more();
        }
        make_change(change_params, app, scene, motion_params, camera_params);
        app.pass("pose", Scope::scene, [&] { return moving->run(scene, double(motion_params.time)); });
        if (followed.differs(motion_params.time)) app.follow(moving->cameras());

        // Which passes this takes.
        const LightPlan plan = make_plan();

        // What has changed of: shadow maps -> voxels, of what moves alone -> their direct light -> all bounces ->
        // pyramids.
        scene_light.run(app, scene, camera_params.cones, plan, [&] {
            return dynamic_voxels.run(app, app.scene(), scene, scene_light.voxels(), dynamic_params);
        });

        if (!scene_light.bounces().is_settled()) app.expect_more();

        // What the camera sees, what other surfaces send to it, and the sum.
        camera_light.see(app, scene);
        camera_light.gather(app, plan);
        const gl::Texture& linear = camera_light.sum(app);
        app.show(linear,
                 tone_map.run(linear, app.view().encoding, display_params, data_scale(app.view(), scene.bounds())));
    });

    std::vector<Count> counts = scene_light.counts();
    for (const Count& count : dynamic_voxels.counts()) counts.push_back(count);
    app.statistics().set_counts(counts);
    for (const auto& part : {scene.resources(), moving->resources(), scene_light.resources(),
                             dynamic_voxels.resources(), camera_light.resources()})
        app.statistics().add_resources(part);
    for (const auto& needs :
         {scene_light.needs(app.scene(), scene), camera_light.needs(app.scene()), make_plan().decisions()})
        app.statistics().add_needs(needs);
    return app.finish();
} catch (const std::exception& error) {
    return conebook::report_failure(error);
}
