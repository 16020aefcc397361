// The reader's half of SceneObjects: mouse, keys and panel.
#include <cmath>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <glm/gtc/type_ptr.hpp>

#include "15_dynamic_scenes/scene_objects.hpp"
#include "scene/shapes.hpp"

namespace conebook {

namespace {

// Places that the reader chooses are whole millimetres, so that their text stays short.
glm::dvec3 to_millimetres(const glm::dvec3& place) { return glm::round(place * 1000.0) / 1000.0; }

// Steps of the keys: about a fiftieth of the scene, a round number.
double key_step_m(const Scene& scene)
{
    const double wanted = 0.02 * double(scene.bounds.longest_side());
    return std::pow(10.0, std::round(std::log10(wanted)));
}

bool drag_three(const char* label, glm::dvec3& value, double step, double min, double max)
{
    glm::dvec3 changed = value;
    const bool done = ImGui::DragScalarN(label, ImGuiDataType_Double, glm::value_ptr(changed), 3, float(step), &min,
                                         &max, "%.4g", ImGuiSliderFlags_AlwaysClamp);
    if (done) value = glm::clamp(glm::round(changed * 1e4) * 1e-4, min, max);
    return done;
}

// The material's fields; `material` is the file's own until one of them is changed.
bool edit_material(std::optional<ObjectMaterial>& material)
{
    ObjectMaterial edited = material.value_or(ObjectMaterial{});
    bool changed = ImGui::ColorEdit3("color", glm::value_ptr(edited.color), ImGuiColorEditFlags_Float);
    changed = ImGui::SliderFloat("metallic", &edited.metallic, 0.0f, 1.0f, "%.3g") || changed;
    changed = ImGui::SliderFloat("roughness", &edited.roughness, 0.0f, 1.0f, "%.3g") || changed;
    changed = ImGui::SliderFloat("specular", &edited.specular, 0.0f, 1.0f, "%.3g") || changed;
    changed = ImGui::DragFloat3("emission", glm::value_ptr(edited.emission), 0.1f, 0.0f, 65504.0f, "%.3g",
                                ImGuiSliderFlags_AlwaysClamp) ||
              changed;
    if (changed) material = edited;
    return changed;
}

bool edit_object(Object& object, double step_m)
{
    bool changed = drag_three("at", object.at, 0.2 * step_m, -1e6, 1e6);
    changed = drag_three("turn", object.turn_degrees, 1.0, -360.0, 360.0) || changed;
    changed = drag_three("scale", object.scale, 0.2 * step_m, 1e-3, 1e3) || changed;
    changed = edit_material(object.material) || changed;
    return ImGui::Checkbox("dynamic", &object.dynamic) || changed;
}

}  // namespace

void SceneObjects::add(App& app, const std::string& source)
{
    if (wanted_.size() >= kMostObjects) return;
    const Scene& scene = app.scene();
    Object object;
    object.source = source;
    object.at = to_millimetres(scene.origin_ws + glm::dvec3(scene.bounds.center()));
    object.scale = glm::dvec3(10.0 * key_step_m(scene));
    object.dynamic = true;
    wanted_.push_back(object);
    selected_ = int(wanted_.size()) - 1;
}

void SceneObjects::remove(int object)
{
    wanted_.erase(wanted_.begin() + object);
    selected_ = -1;
    drag_.reset();
}

bool SceneObjects::draw_panel(App& app)
{
    bool changed = false;
    for (int i = 0; i < int(wanted_.size()); ++i) {
        const Object& object = wanted_[std::size_t(i)];
        const std::string name = std::to_string(i + 1) + " " + object.source + (object.dynamic ? ", dynamic" : "");
        if (ImGui::Selectable(name.c_str(), i == selected_)) selected_ = i;
    }
    if (selected_ >= 0) {
        changed = edit_object(wanted_[std::size_t(selected_)], key_step_m(app.scene()));
        if (ImGui::Button("remove")) {
            remove(selected_);
            changed = true;
        }
    }
    const auto name_of = [](void* names, int i, const char** text) {
        *text = (*static_cast<const std::vector<std::string>*>(names))[std::size_t(i)].c_str();
        return true;
    };
    std::vector<std::string> shapes = shape_names();
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    ImGui::Combo("##shape", &shape_, name_of, &shapes, int(shapes.size()));
    ImGui::SameLine();
    if (ImGui::Button("add")) {
        add(app, shapes[std::size_t(shape_)]);
        changed = true;
    }
    const int lights = int(app.scene().lights.size());
    if (lights > 1) ImGui::SliderInt("light of key C", &light_, 0, lights - 1, "%d", ImGuiSliderFlags_AlwaysClamp);
    ImGui::TextDisabled(
        "Left button: pick, drag. Arrows, Page Up, Down: move.\n"
        "M: dynamic or static. Insert, Delete. C: light to camera.");
    return changed;
}

bool SceneObjects::take(App& app, const InputEvent& event)
{
    if (event.kind == InputEvent::Kind::key) return take_key(app, event.key);
    if (event.kind == InputEvent::Kind::release) {
        drag_.reset();
        return false;
    }
    const Camera& camera = app.scene_camera();
    const PickRay ray = ray_through(camera, event.at, event.aspect);
    const double along = glm::dot(ray.direction, -glm::dvec3(camera.world_from_camera[2]));
    if (event.kind == InputEvent::Kind::press) {
        const std::optional<Picked> picked = pick(app.scene(), ray);
        selected_ = picked && picked->object < int(wanted_.size()) ? picked->object : -1;
        drag_.reset();
        if (selected_ < 0) return false;
        drag_ = Drag{ray.origin + picked->distance_m * ray.direction, wanted_[std::size_t(selected_)].at,
                     picked->distance_m * along};
        return false;
    }
    if (!drag_ || selected_ < 0) return false;
    // In the plane through where it was grabbed, parallel to the picture.
    const glm::dvec3 now = ray.origin + drag_->depth_m / along * ray.direction;
    const glm::dvec3 at = to_millimetres(drag_->at + (now - drag_->grabbed));
    if (at == wanted_[std::size_t(selected_)].at) return false;
    wanted_[std::size_t(selected_)].at = at;
    return true;
}

bool SceneObjects::take_key(App& app, int key)
{
    if (key == GLFW_KEY_INSERT) {
        add(app, shape_names()[std::size_t(shape_)]);
        return true;
    }
    if (key == GLFW_KEY_C && light_ < int(app.scene().lights.size())) {
        const glm::dmat4 world_from_camera(app.scene_camera().world_from_camera);
        LightChoice choice{light_, {}, {}, {}};
        choice.position = to_millimetres(app.scene().origin_ws + glm::dvec3(world_from_camera[3]));
        choice.direction = -glm::dvec3(world_from_camera[2]);
        light_wanted_ = choice;
        return true;
    }
    if (selected_ < 0) return false;
    Object& object = wanted_[std::size_t(selected_)];
    const double step = key_step_m(app.scene());
    glm::dvec3 move(0.0);
    switch (key) {
        case GLFW_KEY_LEFT:
            move.x = -step;
            break;
        case GLFW_KEY_RIGHT:
            move.x = step;
            break;
        case GLFW_KEY_UP:
            move.z = -step;
            break;
        case GLFW_KEY_DOWN:
            move.z = step;
            break;
        case GLFW_KEY_PAGE_UP:
            move.y = step;
            break;
        case GLFW_KEY_PAGE_DOWN:
            move.y = -step;
            break;
        case GLFW_KEY_M:
            object.dynamic = !object.dynamic;
            return true;
        case GLFW_KEY_DELETE:
            remove(selected_);
            return true;
        default:
            return false;
    }
    object.at = to_millimetres(object.at + move);
    return true;
}

}  // namespace conebook
