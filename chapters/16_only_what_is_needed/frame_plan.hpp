// Which passes this picture of this scene takes, and why: decided on the CPU before any of them runs.
#pragma once

#include "12_second_bounce/camera_light.hpp"

namespace conebook {

struct NeedParams {
    // off: everything that the book has is made, as if nothing were known of the scene; the picture is the same.
    bool needs = true;
};
void add_parameters(ParameterTable& table, NeedParams& params);

// What of the frame's settings decides about passes.
struct FrameSettings {
    const SceneLightParams& scene;
    const CameraLightParams& camera;
    std::string view;
};

// Chapter 12's plan without what this view of this scene has no use for; with needs=off all of it.
LightPlan plan_frame(const SceneTraits& scene, const FrameSettings& settings, const NeedParams& params);

}  // namespace conebook
