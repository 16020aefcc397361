// Cameras and lights: both take a position and a direction from their node, and neither its scale.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "scene/parts.hpp"

namespace conebook {
namespace gltf {
namespace {

bool is_finite(glm::dvec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Rotation and translation of a node, its scale and mirroring taken out; empty when nothing is left of the axes.
std::optional<glm::dmat4> rigid(const glm::dmat4& matrix)
{
    const auto unit = [](glm::dvec3 v) {
        const double length = glm::length(v);
        return length > 0.0 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
    };
    const glm::dvec3 z = unit(glm::dvec3(matrix[2]));
    const glm::dvec3 up = unit(glm::dvec3(matrix[1]));
    const glm::dvec3 y = unit(up - z * glm::dot(z, up));
    if (z == glm::dvec3(0.0) || y == glm::dvec3(0.0) || !is_finite(matrix[3])) return std::nullopt;
    return glm::dmat4(glm::dvec4(glm::cross(y, z), 0.0), glm::dvec4(y, 0.0), glm::dvec4(z, 0.0), matrix[3]);
}

glm::dmat4 relative_to(glm::dmat4 matrix, glm::dvec3 origin_ws)
{
    matrix[3] -= glm::dvec4(origin_ws, 0.0);
    return matrix;
}

Camera read_lens(const tinygltf::Camera& source, const std::string& where, Warnings& warnings)
{
    Camera camera;
    camera.name = source.name;
    double z_far = 0.0, z_near = 0.0;
    if (source.type == "orthographic") {
        const auto& lens = source.orthographic;
        camera.orthographic = true;
        camera.x_mag = to_float(std::abs(lens.xmag), where + ".xmag");
        camera.y_mag = to_float(std::abs(lens.ymag), where + ".ymag");
        if (!(camera.x_mag > 0.0f && camera.y_mag > 0.0f)) fail(where + " has a zero xmag or ymag");
        z_near = lens.znear;
        z_far = lens.zfar;
        if (z_near < 0.0) fail(where + " has a negative znear");
    } else {
        const auto& lens = source.perspective;
        camera.y_fov = to_float(lens.yfov, where + ".yfov");
        if (!(lens.yfov > 0.0 && lens.yfov < std::numbers::pi)) fail(where + ".yfov is outside 0 to pi");
        z_near = lens.znear;
        z_far = lens.zfar;
        if (!(z_near > 0.0)) fail(where + ".znear is not positive");
    }
    camera.z_near = to_float(z_near, where + ".znear");
    camera.z_far = to_float(z_far, where + ".zfar");
    if (camera.z_far != 0.0f && !(camera.z_far > camera.z_near)) {
        warn(warnings, where + ".zfar is not beyond znear; it is read as infinite");
        camera.z_far = 0.0f;
    }
    return camera;
}

Light read_light_type(const tinygltf::Light& source, const std::string& where, Warnings& warnings)
{
    Light light;
    light.name = source.name;
    if (source.type == "directional") {
        light.type = LightType::directional;
    } else if (source.type == "point") {
        light.type = LightType::point;
    } else if (source.type == "spot") {
        light.type = LightType::spot;
    } else {
        fail(where + " has the unknown type '" + source.type + "'");
    }
    for (int c = 0; c < 3; ++c) {
        const double color = source.color.size() == 3 ? source.color[static_cast<std::size_t>(c)] : 1.0;
        if (color < 0.0 || source.intensity < 0.0) fail(where + " has a negative colour or intensity");
        light.intensity[c] = to_float(color * source.intensity, where + ": its intensity");
    }
    if (source.range < 0.0) warn(warnings, where + " has a negative range; it is read as infinite");
    if (light.type != LightType::directional) light.range = to_float(std::max(source.range, 0.0), where + ".range");
    // KHR_lights_punctual: 0 <= inner < outer <= pi/2.
    const double outer = std::clamp(source.spot.outerConeAngle, 1e-4, std::numbers::pi / 2);
    const double inner = std::clamp(source.spot.innerConeAngle, 0.0, outer);
    if (light.type == LightType::spot && (outer != source.spot.outerConeAngle || inner != source.spot.innerConeAngle)) {
        warn(warnings, where + " has cone angles outside 0 <= inner < outer <= pi/2, which are clamped");
    }
    light.outer_cone_angle = static_cast<float>(outer);
    light.inner_cone_angle = static_cast<float>(inner);
    return light;
}

}  // namespace

bool place(Camera& camera, const glm::dmat4& world_from_node, glm::dvec3 origin_ws)
{
    const auto world_from_camera = rigid(world_from_node);
    if (world_from_camera) camera.world_from_camera = glm::mat4(relative_to(*world_from_camera, origin_ws));
    return world_from_camera.has_value();
}

bool place(Light& light, const glm::dmat4& world_from_node, glm::dvec3 origin_ws)
{
    const glm::dvec3 position = glm::dvec3(world_from_node[3]) - origin_ws;
    const glm::dvec3 axis = -glm::dvec3(world_from_node[2]);  // it shines along the node's -z
    const double length = glm::length(axis);
    if (!is_finite(position) || !std::isfinite(length) || (length == 0.0 && light.type != LightType::point)) return false;
    light.position = glm::vec3(position);
    if (length > 0.0) light.direction = glm::vec3(axis / length);
    return true;
}

std::vector<Camera> read_cameras(const Document& document, std::vector<Node>& nodes, glm::dvec3 origin_ws,
                                 Warnings& warnings)
{
    std::vector<Node*> ordered;
    for (Node& node : nodes) ordered.push_back(&node);
    std::sort(ordered.begin(), ordered.end(),
              [](const Node* a, const Node* b) { return a->file_index < b->file_index; });
    std::vector<Camera> cameras;
    for (Node* carrier : ordered) {
        const auto& node = document.model.nodes[static_cast<std::size_t>(carrier->file_index)];
        if (node.camera < 0) continue;
        const std::string where = "cameras[" + std::to_string(node.camera) + "]";
        Camera camera = read_lens(document.model.cameras.at(static_cast<std::size_t>(node.camera)), where, warnings);
        if (!place(camera, carrier->world_from_node, origin_ws)) {
            warn(warnings, where + " is on a node without extent and is left out");
            continue;
        }
        if (!is_finite(glm::dvec3(camera.world_from_camera[3]))) fail(where + " is placed beyond what a float holds");
        if (camera.name.empty()) camera.name = node.name;
        carrier->camera = static_cast<int>(cameras.size());
        cameras.push_back(std::move(camera));
    }
    return cameras;
}

std::vector<Light> read_lights(const Document& document, std::vector<Node>& nodes, glm::dvec3 origin_ws,
                               Warnings& warnings)
{
    std::vector<Light> lights;
    for (Node& carrier : nodes) {
        const auto& node = document.model.nodes[static_cast<std::size_t>(carrier.file_index)];
        const auto extension = node.extensions.find("KHR_lights_punctual");
        if (extension == node.extensions.end()) continue;
        const int index = extension->second.Get("light").GetNumberAsInt();
        const std::string where = "lights[" + std::to_string(index) + "]";
        Light light = read_light_type(document.model.lights.at(static_cast<std::size_t>(index)), where, warnings);
        if (!place(light, carrier.world_from_node, origin_ws)) {
            warn(warnings, where + " is on a node without extent and is left out");
            continue;
        }
        if (!is_finite(glm::dvec3(light.position))) fail(where + " is placed beyond what a float holds");
        if (light.name.empty()) light.name = node.name;
        carrier.light = static_cast<int>(lights.size());
        lights.push_back(std::move(light));
    }
    return lights;
}

Light default_light(const Scene& scene)
{
    // Over the viewer's left shoulder, 35 degrees down: what is in front of the camera is lit, and has shape.
    const glm::mat4 camera = choose_camera(scene, std::nullopt).world_from_camera;
    Light light;
    light.type = LightType::directional;
    light.name = "default";
    light.direction = glm::normalize(glm::mat3(camera) * glm::vec3(0.5f, -0.7f, -0.85f));
    // An irradiance of pi W/m^2: a white diffuse surface that faces the light has a radiance of 1.
    light.intensity = glm::vec3(std::numbers::pi_v<float>);
    return light;
}

}  // namespace gltf

Camera choose_camera(const Scene& scene, std::optional<int> index)
{
    const int count = static_cast<int>(scene.cameras.size());
    if (index && (*index < 0 || *index >= count)) {
        throw std::runtime_error((scene.name.empty() ? "the scene" : scene.name) + ": there is no camera " +
                                 std::to_string(*index) + ", the scene has " + std::to_string(count));
    }
    if (count > 0) return scene.cameras[static_cast<std::size_t>(index.value_or(0))];

    // From the front, a little to the right and above; the bounding sphere fits a square picture with 5 % to spare.
    Camera camera;
    camera.name = "framing";
    camera.y_fov = std::numbers::pi_v<float> / 4.0f;
    const float radius = std::max(0.5f * glm::length(scene.bounds.extent()), 1e-6f);
    const glm::vec3 z = glm::normalize(glm::vec3(0.35f, 0.3f, 1.0f));  // towards the camera
    const glm::vec3 x = glm::normalize(glm::cross(glm::vec3(0.0f, 1.0f, 0.0f), z));
    const float distance = 1.05f * radius / std::sin(0.5f * camera.y_fov);
    camera.world_from_camera = glm::mat4(glm::vec4(x, 0.0f), glm::vec4(glm::cross(z, x), 0.0f), glm::vec4(z, 0.0f),
                                         glm::vec4(scene.bounds.center() + distance * z, 1.0f));
    camera.z_near = 0.02f * distance;
    return camera;
}

DepthRange visible_depths(const Camera& camera, const Bounds& bounds)
{
    const glm::dvec3 eye(camera.world_from_camera[3]), forward(-camera.world_from_camera[2]);
    double nearest = INFINITY, farthest = -INFINITY;
    for (int i = 0; i < 8; ++i) {
        const double depth = glm::dot(glm::dvec3(bounds.corner(i)) - eye, forward);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
    // Room for the rounding of vertices to float, and of these sums to double.
    const double room = 1e-5 * glm::length(glm::dvec3(bounds.extent())) + 1e-12 * glm::length(eye) + 1e-30;
    const double near = camera.z_near, far = camera.z_far > camera.z_near ? double(camera.z_far) : INFINITY;
    const DepthRange range{std::max(near, nearest - room), std::min(far, farthest + room)};
    if (range.near < range.far) return range;
    return {near, far < INFINITY ? far : 2.0 * near + 1.0};  // the scene is behind the camera or beyond its far plane
}

}  // namespace conebook
