// The plan of a frame as a list: every volume, pass and choice with what it took and why it is there, or why not.
#pragma once

#include "16_only_what_is_needed/chosen_settings.hpp"

namespace conebook {

// After a frame. Bytes and ms of what was left out are 0.
std::vector<PlanLine> plan_lines(const LightPlan& plan, const SceneLight& scene_light, const CameraLight& camera_light,
                                 const SceneLightParams& scene_params, const CameraLightParams& camera_params,
                                 App& app);
// What was chosen for the reader's demand, and what is expected of it; empty where nothing is demanded.
std::vector<PlanLine> demand_lines(const ChosenSettings& chosen);
// What all volumes share with storage=bricks.
PlanLine brick_line(const std::vector<gl::Resource>& resources);
// How many passes ran and programs were made, and the memory of all lines.
std::vector<Count> plan_counts(const std::vector<PlanLine>& lines, App& app);
// A line each, in columns.
std::string plan_text(const std::vector<PlanLine>& lines);

}  // namespace conebook
