// The plan of a frame as a list: every volume, pass and choice with what it took and why it is there, or why not.
#pragma once

#include "16_only_what_is_needed/frame_plan.hpp"

namespace conebook {

// After a frame. Bytes and ms of what was left out are 0.
std::vector<PlanLine> plan_lines(const LightPlan& plan, const SceneLight& scene_light, const CameraLight& camera_light,
                                 const SceneLightParams& scene_params, const CameraLightParams& camera_params,
                                 App& app);
// A line each, in columns.
std::string plan_text(const std::vector<PlanLine>& lines);

}  // namespace conebook
