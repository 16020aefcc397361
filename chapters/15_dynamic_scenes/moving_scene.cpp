#include "15_dynamic_scenes/moving_scene.hpp"

#include <algorithm>

namespace conebook {

void add_parameters(ParameterTable& table, MotionParams& params)
{
    table.add("time", params.time, 0.0, 86400.0, "s", "the pose of everything that moves");
    table.add("play", params.play, "in a window time goes on by itself");
}

void hold_all_poses(Scene& scene) { scene.bounds = swept_bounds(scene); }

MovingScene::MovingScene(gl::Shaders& shaders, Scene& scene)
    : scene_(scene), pose_(shaders, scene), duration_s_(duration(scene)), nodes_(rest_pose(scene))
{
}

bool MovingScene::run(GpuScene& gpu_scene, double time_s)
{
    if (!made_from_.differs(time_s) || !moves()) return false;
    nodes_ = pose_nodes(scene_, time_s);
    const bool moved = pose_.run(gpu_scene, nodes_);
    if (moved && gpu_scene.has_emission())
        for (const std::size_t node : pose_.moved()) {
            const std::vector<Vertex> vertices = posed_vertices(scene_, nodes_, node);
            std::copy(vertices.begin(), vertices.end(), scene_.vertices.begin() + scene_.nodes[node].vertices.first);
        }
    return move_lights(gpu_scene) || moved;
}

// Lights of nodes that stand still stay where a preset has put them.
bool MovingScene::move_lights(GpuScene& gpu_scene) const
{
    const std::vector<Light> posed = posed_lights(scene_, nodes_);
    std::vector<Light> lights = gpu_scene.lights();
    bool moved = false;
    for (const Node& node : scene_.nodes) {
        if (node.light < 0 || !node.dynamic) continue;
        Light& light = lights[std::size_t(node.light)];
        const Light& now = posed[std::size_t(node.light)];
        moved = moved || light.position != now.position || light.direction != now.direction;
        light.position = now.position;
        light.direction = now.direction;
    }
    if (moved) gpu_scene.set_lights(lights);
    return moved;
}

}  // namespace conebook
