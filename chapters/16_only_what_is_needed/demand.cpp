#include "16_only_what_is_needed/demand.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

namespace conebook {

void add_parameters(ParameterTable& table, DemandParams& params)
{
    table.add("error", params.error, 0.0, 2.0, "", "SMAPE at most; settings are chosen for it; 0: any");
    table.add("memory", params.memory, 0.0, 1e6, "MB", "at most; settings are chosen for it; 0: any");
    table.add("time_budget", params.time_budget, 0.0, 1e6, "ms", "a frame at most; settings are chosen for it; 0: any");
}

namespace {

// Of the passes over pixels a part is not for each pixel: the cornell box at 1280 x 720 takes 5.6 times as long as at
// 256 x 256, with 14 times the pixels (docs/data/report.json).
constexpr double kPixelPower = 0.65;

// Values of every field: what was measured, or what the reader has set.
std::vector<Choice> candidates(const DemandInputs& inputs)
{
    const Choice asked = choice_of(inputs.settings.scene, inputs.settings.camera), defaults{};
    std::vector<Choice> all = {asked};
    for (const ChoiceField& field : choice_fields()) {
        if (asked.*field.value != defaults.*field.value) continue;
        std::vector<int> values = {inputs.measured.baseline.choice.*field.value};
        for (const Measured& row : inputs.measured.alone)
            if (row.choice.*field.value != values.front()) values.push_back(row.choice.*field.value);
        std::vector<Choice> more;
        for (const Choice& choice : all)
            for (const int value : values) {
                more.push_back(choice);
                more.back().*field.value = value;
            }
        all = std::move(more);
    }
    return all;
}

// How far beyond what is asked, as a factor; 1 or less: not at all.
double excess(const DemandParams& demand, const Expectation& e)
{
    double most = 0.0;
    if (demand.error > 0.0f) most = std::max(most, e.error / double(demand.error));
    if (demand.memory > 0.0f) most = std::max(most, e.memory_mb / double(demand.memory));
    if (demand.time_budget > 0.0f) most = std::max(most, e.time_ms / double(demand.time_budget));
    return most;
}

std::string asked_text(const DemandParams& demand)
{
    std::string out;
    for (const auto& [name, value] : {std::pair("error", demand.error), std::pair("memory", demand.memory),
                                      std::pair("time_budget", demand.time_budget)})
        if (value > 0.0f) {
            char text[48];
            std::snprintf(text, sizeof text, "%s%s=%g", out.empty() ? "" : " ", name, double(value));
            out += text;
        }
    return out;
}

}  // namespace

Expectation expect(const Choice& choice, const DemandInputs& inputs)
{
    SceneLightParams scene = inputs.settings.scene;
    CameraLightParams camera = inputs.settings.camera;
    apply(choice, scene, camera);
    const FrameSettings settings{scene, camera, inputs.settings.view};
    const LightPlan plan = plan_frame(inputs.traits, settings, inputs.needs);
    const Choice measured = nearest_measured(inputs.measured, choice);
    const ExpectedTimes times = expected_times(inputs.measured, measured);
    const double pixels =
        double(inputs.size.x) * inputs.size.y / (double(inputs.measured_size.x) * inputs.measured_size.y);
    const double each_frame = times.camera_ms * std::pow(pixels, kPixelPower) +
                              (scene.voxels.update == Update::always ? times.light_ms + times.scene_ms : 0.0);
    return {choice, expected_error(inputs.measured, measured),
            expected_bytes(inputs.scene, settings, plan, inputs.size) * 1e-6, each_frame * inputs.machine};
}

Expectation choose(const DemandParams& demand, const DemandInputs& inputs)
{
    std::optional<Expectation> best, nearest;
    for (const Choice& choice : candidates(inputs)) {
        const Expectation e = expect(choice, inputs);
        if (!nearest || excess(demand, e) < excess(demand, *nearest)) nearest = e;
        if (excess(demand, e) > 1.0) continue;
        // snippet: better
        const bool better = !best ? true
                            : demand.error > 0.0f
                                ? std::pair(e.time_ms, e.memory_mb) < std::pair(best->time_ms, best->memory_mb)
                                : std::pair(e.error, e.time_ms) < std::pair(best->error, best->time_ms);
        // end snippet
        if (better) best = e;
    }
    if (best) return *best;
    char text[320];
    std::snprintf(
        text, sizeof text,
        "%s: no setting is expected to keep to that; the nearest has error %.3g, %.3g MB, %.3g ms a frame (%s)",
        asked_text(demand).c_str(), nearest->error, nearest->memory_mb, nearest->time_ms,
        text_of(nearest->choice).c_str());
    throw std::runtime_error(text);
}

}  // namespace conebook
