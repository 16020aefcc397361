// What changes from frame to frame, so that --stats tells what runs then, without a window.
#pragma once

#include "12_second_bounce/camera_light.hpp"
#include "15_dynamic_scenes/moving_scene.hpp"

namespace conebook {

enum class Change : int { nothing = 0, time = 1, light = 2, camera = 3, pixels = 4 };

struct ChangeParams {
    Change change = Change::nothing;
};
void add_parameters(ParameterTable& table, ChangeParams& params);

// From the second frame on: time goes on by 1/30 s; the first light moves by a thousandth of the scene, or the
// camera does, to and fro; or a setting that only pixels look at changes.
void make_change(const ChangeParams& params, App& app, GpuScene& scene, MotionParams& motion,
                 CameraLightParams& camera);

}  // namespace conebook
