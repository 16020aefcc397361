#include "15_dynamic_scenes/changes.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, ChangeParams& params)
{
    table.add("change", params.change, {"nothing", "time", "light", "camera", "pixels"},
              "what changes from frame to frame, for measuring");
}

void make_change(const ChangeParams& params, App& app, GpuScene& scene, MotionParams& motion, CameraLightParams& camera)
{
    if (app.frame() == 0) return;
    const float there = app.frame() % 2 == 1 ? 1.0f : -1.0f, step_m = there * 1e-3f * scene.bounds().longest_side();
    switch (params.change) {
        case Change::nothing:
            break;
        case Change::time:
            motion.time += 1.0f / 30.0f;
            break;
        case Change::light: {
            std::vector<Light> lights = scene.lights();
            if (lights.empty()) break;
            lights[0].position.x += step_m;
            lights[0].direction = glm::normalize(lights[0].direction + glm::vec3(there * 1e-3f, 0.0f, 0.0f));
            scene.set_lights(lights);
            break;
        }
        case Change::camera: {
            Camera moved = app.scene_camera();
            moved.world_from_camera[3].x += step_m;
            app.move_camera(moved.world_from_camera);
            break;
        }
        case Change::pixels:
            camera.cones.ao_falloff += there * 0.01f;
            break;
    }
}

}  // namespace conebook
