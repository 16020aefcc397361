#include "15_dynamic_scenes/scene_objects.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>

namespace conebook {

namespace {

// The ray's way to a triangle from either side, m (Moeller and Trumbore 1997); infinity where it misses.
double distance_to(const PickRay& ray, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    constexpr double kMisses = std::numeric_limits<double>::infinity();
    const glm::dvec3 e1 = b - a, e2 = c - a, p = glm::cross(ray.direction, e2);
    const double determinant = glm::dot(e1, p);
    if (determinant == 0.0) return kMisses;
    const glm::dvec3 s = ray.origin - a, q = glm::cross(s, e1);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(ray.direction, q) / determinant;
    const double t = glm::dot(e2, q) / determinant;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 ? t : kMisses;
}

}  // namespace

void add_parameters(ParameterTable& table, ObjectParams& params)
{
    table.add(
        "objects", params.objects, [](const std::string& text) { parse_objects(text); }, objects_help());
}

PickRay ray_through(const Camera& camera, glm::dvec2 at, double aspect)
{
    const glm::dmat4 scene_from_camera(camera.world_from_camera);
    const glm::dvec2 clip(2.0 * at.x - 1.0, 1.0 - 2.0 * at.y);
    glm::dvec3 origin(0.0), direction(0.0, 0.0, -1.0);  // camera space
    if (camera.orthographic) {
        origin = {clip.x * double(camera.x_mag), clip.y * double(camera.y_mag), 0.0};
    } else {
        const double half_height = std::tan(0.5 * double(camera.y_fov));
        direction = {clip.x * half_height * aspect, clip.y * half_height, -1.0};
    }
    return {glm::dvec3(scene_from_camera * glm::dvec4(origin, 1.0)),
            glm::normalize(glm::dmat3(scene_from_camera) * direction)};
}

std::optional<Picked> pick(const Scene& scene, const PickRay& ray)
{
    Picked nearest{-1, std::numeric_limits<double>::infinity()};
    for (const Node& node : scene.nodes) {
        for (std::uint32_t i = node.indices.first; i < node.indices.end(); i += 3) {
            const auto corner = [&](std::uint32_t k) {
                return glm::dvec3(scene.vertices[scene.indices[i + k]].position);
            };
            const double distance = distance_to(ray, corner(0), corner(1), corner(2));
            if (distance < nearest.distance_m) nearest = {node.object, distance};
        }
    }
    if (nearest.object < 0) return {};
    return nearest;
}

void SceneObjects::place_first(Scene& scene)
{
    wanted_ = parse_objects(params_.objects);
    placed_.emplace(scene);
    for (const std::string& note : placed_->set(scene, wanted_).notes) std::cerr << note << "\n";
    scene.bounds = bounds_with_objects(scene);
    text_ = params_.objects;
}

void SceneObjects::follow_reader(App& app)
{
    app.add_panel_section({"objects", [this, &app] { return draw_panel(app); }});
    app.on_input([this, &app](const InputEvent& event) { return take(app, event); });
}

ObjectChanges SceneObjects::update(App& app, GpuScene& gpu_scene)
{
    Scene& scene = app.scene();
    if (light_wanted_) {
        app.place_light(*light_wanted_);
        std::vector<Light> lights = gpu_scene.lights();
        lights[std::size_t(light_wanted_->index)] = scene.lights[std::size_t(light_wanted_->index)];
        gpu_scene.set_lights(lights);
        light_wanted_.reset();
    }
    const std::vector<Object> asked = params_.objects != text_ ? parse_objects(params_.objects) : wanted_;
    wanted_ = placed_->objects();  // if this fails
    const auto may_move = [&](std::size_t node) { return scene.nodes[node].dynamic; };
    ObjectChanges changes = placed_->set(scene, asked);
    wanted_ = asked;
    if (params_.objects == text_ && changes.any()) params_.objects = text_of(asked);
    text_ = params_.objects;
    if (selected_ >= int(wanted_.size())) selected_ = -1;
    if (!changes.any()) return changes;

    for (const std::string& note : changes.notes) std::cerr << note << "\n";
    bool still_ones = changes.others || !changes.switched.empty();
    if (changes.others) gpu_scene.set_triangles(scene, placed_->file_images());
    for (const std::size_t node : changes.moved) {
        gpu_scene.move(scene, node);
        still_ones = still_ones || !may_move(node);
    }
    for (const std::size_t material : changes.materials) gpu_scene.set_material(scene, material);
    // Materials belong to what the voxels of still and moving things were made from alike.
    still_ones = still_ones || !changes.materials.empty();
    gpu_scene.find_dynamic(scene);
    if (still_ones)
        gpu_scene.mark_changed();
    else
        gpu_scene.mark_moved();
    return changes;
}

}  // namespace conebook
