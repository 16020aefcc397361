// The settings of the frames: those of the reader, or those that a plan chooses for what the reader demands.
#pragma once

#include <optional>

#include "16_only_what_is_needed/demand.hpp"

namespace conebook {

class ChosenSettings {
public:
    // `measured`: what tools/plan_data.py wrote; read when something is demanded for the first time. `scene_name`: of the
    // scene's file, without folder and extension.
    ChosenSettings(std::filesystem::path measured, std::string scene_name, const GpuScene& scene,
                   const SceneTraits& traits);

    // Once a frame, before its passes: `scene` and `camera` become what is `asked` for, with what the demand decides. Chosen
    // anew when one of these has changed, and once when two frames have told how fast this machine is (in the first one
    // programs are made). Throws as choose() and read_measured_settings() do.
    void update(const DemandParams& demand, const FrameSettings& asked, const NeedParams& needs, glm::ivec2 size,
                const ParameterValues& asked_values, const Statistics& statistics);

    const SceneLightParams& scene() const { return scene_params_; }
    const CameraLightParams& camera() const { return camera_params_; }
    // What the demanded settings are expected to do; none where nothing is demanded.
    const std::optional<Expectation>& expectation() const { return expectation_; }
    std::string measured_scene() const { return measured_scene_ == nullptr ? "" : measured_scene_->name; }
    std::vector<Count> counts() const;

private:
    void measure_machine(const Statistics& statistics);
    std::filesystem::path file_;
    std::string scene_name_;
    SceneTraits traits_;
    SceneSize scene_size_;
    std::optional<MeasuredSettings> measured_;
    const MeasuredScene* measured_scene_ = nullptr;
    SceneLightParams scene_params_;
    CameraLightParams camera_params_;
    std::optional<Expectation> expectation_;
    MadeFrom<DemandParams, ParameterValues, glm::ivec2, std::string> made_from_;
    double machine_ = 1.0;
    int frames_ = 0;  // with what is chosen now
};

}  // namespace conebook
