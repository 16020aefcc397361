// The frames of chapter 12, one at a time, for tests that change something between them.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "01_first_light/tone_map.hpp"
#include "12_second_bounce/camera_light.hpp"
#include "program.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"

namespace conebook {

struct FrameParams {
    SceneLightParams scene;
    CameraLightParams camera;
    DisplayParams display;
};

// Chapter 12's main(), with a hand on everything that can change between two frames. One at a time: its context is current.
class Frames {
public:
    explicit Frames(const std::filesystem::path& scene_file, const FrameParams& start = small())
        : params(start), app_(app_of(scene_file, params)), scene(app_->scene())
    {
        renew();
    }

    // Passes that have never drawn anything.
    void renew()
    {
        camera_light.reset();
        scene_light = std::make_unique<SceneLight>(app_->shaders(), app_->scene(), scene, params.scene);
        camera_light = std::make_unique<CameraLight>(app_->shaders(), *scene_light, app_->size(), params.camera);
    }

    static FrameParams small()
    {
        FrameParams params;
        params.scene.voxels.grid.voxels = 24;
        return params;
    }

    // Draws one more; how often each pass ran in it.
    std::map<std::string, int> draw()
    {
        EXPECT_TRUE(app_->next_frame());
        const LightPlan plan = make_plan(traits_of(app_->scene()), params);
        scene_light->run(*app_, scene, params.camera.cones, plan);
        camera_light->see(*app_, scene, plan);
        camera_light->gather(*app_, plan);
        picture = &camera_light->sum(*app_);
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
    std::vector<float> pixels() const { return gl::read_floats(*picture, 0, 4); }
    App& app() { return *app_; }
    // The window moves it; here a test does.
    Camera& camera() { return const_cast<Camera&>(app_->scene_camera()); }

    FrameParams params;
    // Chapter 12's, where a test has no other.
    std::function<LightPlan(const SceneTraits&, const FrameParams&)> make_plan = [](const SceneTraits& traits,
                                                                                  const FrameParams& p) {
        return plan_light(traits, p.scene.voxels.shading, p.scene.bounces, p.camera.shadows);
    };

private:
    static std::unique_ptr<App> app_of(const std::filesystem::path& scene_file, FrameParams& params)
    {
        std::vector<std::string> words = {"test",     "--headless", "--size",  "24x24",
                                          "--frames", "1000",       "--scene", scene_file.string()};
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        return std::make_unique<App>(
            int(argv.size()), argv.data(),
            ProgramInfo{"test", light_views(), parameters_of(params.scene, params.camera, params.display)});
    }
    TemporaryFolder folder_;
    std::map<std::string, int> before_;
    std::unique_ptr<App> app_;

public:
    GpuScene scene;
    std::unique_ptr<SceneLight> scene_light;
    std::unique_ptr<CameraLight> camera_light;
    const gl::Texture* picture = nullptr;
};

}  // namespace conebook
