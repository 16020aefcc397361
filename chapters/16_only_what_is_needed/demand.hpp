// What the reader asks for - so much error, memory, time at most - and the settings that are expected to keep to it.
#pragma once

#include "16_only_what_is_needed/frame_bytes.hpp"
#include "16_only_what_is_needed/measured_settings.hpp"

namespace conebook {

// 0: does not matter.
struct DemandParams {
    float error = 0.0f;        // SMAPE of the picture against the path tracer, 0 .. 2; 0.02 is hard to see
    float memory = 0.0f;       // MB, of everything that the program keeps in GPU memory
    float time_budget = 0.0f;  // ms, of the passes that every frame runs: the camera's, and with update=always all
    bool asks() const { return error > 0.0f || memory > 0.0f || time_budget > 0.0f; }
    bool operator==(const DemandParams&) const = default;
};
void add_parameters(ParameterTable& table, DemandParams& params);

struct Expectation {
    Choice choice;
    double error = 0.0, memory_mb = 0.0, time_ms = 0.0;
};

// What is known of the scene, of this machine and of the other parameters.
struct DemandInputs {
    const MeasuredScene& measured;
    glm::ivec2 measured_size;
    const SceneSize& scene;
    const SceneTraits& traits;
    const FrameSettings& settings;
    const NeedParams& needs;
    glm::ivec2 size;       // of the picture
    double machine = 1.0;  // time here over time where the settings were measured
};

// Of one choice.
Expectation expect(const Choice& choice, const DemandInputs& inputs);

// Of all settings that were measured: with `error` the fastest that keeps to all that is asked, without it the one with the
// least error. Parameters that are not at their defaults stay as they are. Throws std::runtime_error, one line that names
// what is asked and the nearest that is expected, where nothing keeps to it.
Expectation choose(const DemandParams& demand, const DemandInputs& inputs);

}  // namespace conebook
