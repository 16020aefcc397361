#include "16_only_what_is_needed/chosen_settings.hpp"

namespace conebook {

ChosenSettings::ChosenSettings(std::filesystem::path measured, std::string scene_name, const GpuScene& scene,
                               const SceneTraits& traits)
    : file_(std::move(measured)),
      scene_name_(std::move(scene_name)),
      traits_(traits),
      scene_size_(size_of(scene, traits))
{
}

// What the last frame's passes took, over what was expected.
void ChosenSettings::measure_machine(const Statistics& statistics)
{
    const bool always = scene_params_.voxels.update == Update::always;
    double taken_ms = 0.0;
    for (const PassTime& pass : statistics.last_times())
        if (always || pass.scope == Scope::camera) taken_ms += pass.milliseconds;
    if (taken_ms > 0.0 && expectation_->time_ms > 0.0) machine_ *= taken_ms / expectation_->time_ms;
}

void ChosenSettings::update(const DemandParams& demand, const FrameSettings& asked, const NeedParams& needs,
                            glm::ivec2 size, const ParameterValues& asked_values, const Statistics& statistics)
{
    constexpr int kWarm = 2;  // frames
    const bool changed = made_from_.differs(demand, asked_values, size, asked.view);
    const bool measures = expectation_ && ++frames_ == kWarm && !changed;
    if (!changed && !measures) {
        camera_params_.accumulation.accumulate = asked.camera.accumulation.accumulate;
        return;
    }
    if (measures) measure_machine(statistics);
    scene_params_ = asked.scene;
    camera_params_ = asked.camera;
    if (!demand.asks()) {
        expectation_.reset();
        return;
    }
    if (!measured_) {
        measured_ = read_measured_settings(file_);
        measured_scene_ = &measured_->like(scene_name_, traits_);
    }
    const DemandInputs inputs{*measured_scene_, measured_->size, scene_size_, traits_, asked, needs, size, machine_};
    const std::optional<Expectation> before = std::move(expectation_);
    expectation_ = choose(demand, inputs);
    apply(expectation_->choice, scene_params_, camera_params_);
    if (changed) frames_ = 0;
    // Pictures of other settings have no part in the mean of frames.
    if (before && before->choice != expectation_->choice) camera_params_.accumulation.accumulate = false;
}

std::vector<Count> ChosenSettings::counts() const
{
    if (!expectation_) return {};
    return {{"expected error", expectation_->error, ""},
            {"expected memory", expectation_->memory_mb, "MB"},
            {"expected time of a frame", expectation_->time_ms, "ms"},
            {"this machine over the one that was measured", machine_, ""}};
}

}  // namespace conebook
