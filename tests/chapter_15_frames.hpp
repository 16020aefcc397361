// The frames of chapter 15, one at a time, for tests that change something between them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "12_second_bounce/camera_light.hpp"
#include "15_dynamic_scenes/dynamic_voxels.hpp"
#include "15_dynamic_scenes/moving_scene.hpp"
#include "program.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"

namespace conebook {

struct MovingParams {
    SceneLightParams scene;
    CameraLightParams camera;
    DynamicVoxelParams dynamic;
    float time = 0.0f;
};

// Chapter 15's main(), with a hand on everything that can change between two frames. One at a time: its context is
// current.
class MovingFrames {
public:
    using Prepare = std::function<void(Scene&)>;
    explicit MovingFrames(const std::filesystem::path& scene_file, const MovingParams& start,
                          const Prepare& prepare = hold_all_poses)
        : params(start),
          app_(app_of(scene_file, params, prepare)),
          scene(app_->scene()),
          moving(app_->shaders(), app_->scene()),
          light(app_->shaders(), app_->scene(), scene, params.scene),
          dynamic(app_->shaders()),
          camera_light(app_->shaders(), light, app_->size(), params.camera)
    {
    }

    static MovingParams small(int voxels = 24)
    {
        MovingParams params;
        params.scene.voxels.grid.voxels = voxels;
        params.scene.bounces.warm_start = true;
        params.camera.accumulation.accumulate = false;
        return params;
    }

    // What does not depend on the camera, at params.time.
    void light_frame()
    {
        EXPECT_TRUE(app_->next_frame());
        app_->pass("pose", Scope::scene, [&] { return moving.run(scene, double(params.time)); });
        light.run(*app_, scene, params.camera.cones, plan(),
                  [&] { return dynamic.run(*app_, app_->scene(), scene, light.voxels(), params.dynamic); });
    }
    // Draws one more; how often each pass ran in it.
    std::map<std::string, int> draw()
    {
        light_frame();
        camera_light.see(*app_, scene);
        camera_light.gather(*app_, plan());
        picture = &camera_light.sum(*app_);
        app_->show(*picture, *picture);
        app_->statistics().write_json(folder_ / "stats.json");
        std::map<std::string, int> runs;
        const nlohmann::json stats = read_statistics(folder_ / "stats.json");
        for (const auto& pass : stats.at("passes")) {
            const std::string name = pass.at("name");
            const int all = pass.at("frames");
            if (all > before_[name]) runs[name] = all - before_[name];
            before_[name] = all;
        }
        return runs;
    }
    std::map<std::string, int> draw_at(float time_s)
    {
        params.time = time_s;
        return draw();
    }
    std::vector<float> pixels() const { return gl::read_floats(*picture, 0, 4); }
    App& app() { return *app_; }
    // The window moves it; here a test does.
    Camera& camera() { return const_cast<Camera&>(app_->scene_camera()); }
    // Of all that is kept from frame to frame.
    std::size_t bytes() const
    {
        std::size_t sum = 0;
        for (const auto& part :
             {scene.resources(), moving.resources(), light.resources(), dynamic.resources(), camera_light.resources()})
            for (const gl::Resource& resource : part) sum += resource.bytes;
        return sum;
    }

    MovingParams params;

private:
    LightPlan plan() const
    {
        return plan_light(traits_of(app_->scene()), params.scene.voxels.shading, params.scene.bounces,
                          params.camera.shadows);
    }
    static std::unique_ptr<App> app_of(const std::filesystem::path& scene_file, MovingParams& params,
                                       const Prepare& prepare)
    {
        std::vector<std::string> words = {"test",     "--headless", "--size",  "24x24",
                                          "--frames", "1000",       "--scene", scene_file.string()};
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        return std::make_unique<App>(
            int(argv.size()), argv.data(),
            ProgramInfo{"test", light_views(), parameters_of(params.scene, params.camera, params.dynamic), prepare});
    }
    TemporaryFolder folder_;
    std::map<std::string, int> before_;
    std::unique_ptr<App> app_;

public:
    GpuScene scene;
    MovingScene moving;
    SceneLight light;
    DynamicVoxels dynamic;
    CameraLight camera_light;
    const gl::Texture* picture = nullptr;
};

}  // namespace conebook
