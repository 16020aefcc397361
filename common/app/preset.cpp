#include "app/preset.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <type_traits>

#include <nlohmann/json.hpp>

#include "image/write_file.hpp"

namespace conebook {

namespace {

using Json = nlohmann::ordered_json;

// An entry of the file, with the way to it for messages: "parameters.voxels".
struct Entry {
    const std::filesystem::path& file;
    std::string path;
    const Json& value;

    [[noreturn]] void refuse(const std::string& fault) const
    {
        throw std::runtime_error(file.string() + ": " + path + (path.empty() ? "" : ": ") + fault);
    }
    std::string parent() const { return path.substr(0, path.rfind('.')); }
    // Calls `read` for every entry of an object.
    template <typename Read>
    void for_each(Read read) const
    {
        if (!value.is_object()) refuse("must be an object, {...}");
        for (const auto& [name, inner] : value.items())
            read(Entry{file, path.empty() ? name : path + "." + name, inner}, name);
    }
    double number(double min, double max) const
    {
        if (!value.is_number()) refuse("must be a number");
        const double number = value.get<double>();
        if (!(number >= min && number <= max)) refuse("out of range");
        return number;
    }
    int index() const
    {
        if (!value.is_number_integer()) refuse("must be a number in the scene, 0 or more");
        return int(number(0.0, 1e9));
    }
    glm::dvec3 vector() const
    {
        const auto [x, y, z] = numbers<3>();
        return {x, y, z};
    }
    template <std::size_t N>
    std::array<double, N> numbers() const
    {
        constexpr double kLargest = std::numeric_limits<float>::max();
        if (!value.is_array() || value.size() != N) refuse("must be a list of " + std::to_string(N) + " numbers");
        std::array<double, N> all;
        for (std::size_t i = 0; i < N; ++i)
            all[i] = Entry{file, path + "[" + std::to_string(i) + "]", value[i]}.number(-kLargest, kLargest);
        return all;
    }
};

void read_parameter(const Entry& entry, const std::string& name, ParameterTable& parameters)
{
    const Json& value = entry.value;
    if (!value.is_number() && !value.is_boolean() && !value.is_string())
        entry.refuse("must be a number, true, false, or the name of a choice");
    try {
        parameters.set(name, value.is_string() ? value.get<std::string>() : value.dump());
    } catch (const std::runtime_error& error) {
        throw std::runtime_error(entry.file.string() + ": " + entry.parent() + "." + error.what());
    }
}

void read_parameters(const Entry& entry, ParameterTable& parameters)
{
    entry.for_each([&](const Entry& inner, const std::string& name) { read_parameter(inner, name, parameters); });
}

void read_parameters_if_present(const Entry& entry, ParameterTable& parameters)
{
    const std::vector<Parameter>& all = parameters.all();
    entry.for_each([&](const Entry& inner, const std::string& name) {
        if (std::any_of(all.begin(), all.end(), [&](const Parameter& p) { return p.name == name; }))
            read_parameter(inner, name, parameters);
    });
}

std::vector<LightChoice> read_lights(const Entry& entry)
{
    if (!entry.value.is_array()) entry.refuse("must be a list of lights, [{...}, ...]");
    std::vector<LightChoice> lights;
    for (std::size_t i = 0; i < entry.value.size(); ++i) {
        const Entry one{entry.file, entry.path + "[" + std::to_string(i) + "]", entry.value[i]};
        LightChoice choice{-1, {}, {}, {}};
        one.for_each([&](const Entry& inner, const std::string& name) {
            if (name == "index") {
                choice.index = inner.index();
            } else if (name == "intensity") {
                choice.intensity = glm::vec3(inner.vector());
                if (glm::any(glm::lessThan(*choice.intensity, glm::vec3(0.0f)))) inner.refuse("must not be negative");
            } else if (name == "position") {
                choice.position = inner.vector();
            } else if (name == "direction") {
                choice.direction = inner.vector();
                if (std::abs(glm::length(*choice.direction) - 1.0) > 1e-3) inner.refuse("must be a unit vector");
            } else {
                inner.refuse("unknown entry");
            }
        });
        if (choice.index < 0) one.refuse("has no index");
        lights.push_back(choice);
    }
    return lights;
}

CameraChoice read_camera(const Entry& entry)
{
    CameraChoice choice;
    if (!entry.value.is_object()) {
        choice.index = entry.index();
        return choice;
    }
    entry.for_each([&](const Entry& inner, const std::string& name) {
        if (name == "index") {
            choice.index = inner.index();
        } else if (name == "position") {
            choice.position = inner.vector();
        } else if (name == "orientation") {
            const auto [x, y, z, w] = inner.numbers<4>();
            const glm::dquat orientation(w, x, y, z);
            if (std::abs(glm::length(orientation) - 1.0) > 1e-3)
                inner.refuse("must be a unit quaternion, [x, y, z, w]");
            choice.orientation = glm::normalize(orientation);
        } else if (name == "y_fov") {
            choice.y_fov = float(inner.number(1e-3, std::numbers::pi - 1e-3));
        } else {
            inner.refuse("unknown entry");
        }
    });
    return choice;
}

// The shortest number that is read back as the same float.
double shortest(float value)
{
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    return std::stod(std::string(text, end));
}

// Three numbers as they are read back.
template <typename Vector>
Json json_of_vector(const Vector& v)
{
    if constexpr (std::is_same_v<Vector, glm::vec3>)
        return Json::array({shortest(v.x), shortest(v.y), shortest(v.z)});
    else
        return Json::array({v.x, v.y, v.z});
}

Json json_of(const Parameter& parameter)
{
    const double value = parameter.value();
    if (parameter.as_text != nullptr) return *parameter.as_text;
    if (!parameter.choices.empty()) return parameter.value_text(value);
    if (parameter.as_bool != nullptr) return value != 0.0;
    return parameter.as_int != nullptr ? Json(*parameter.as_int) : Json(shortest(*parameter.as_float));
}

Json json_of(const CameraChoice& camera)
{
    if (!camera.position && !camera.orientation && !camera.y_fov) return *camera.index;
    Json json = Json::object();
    if (camera.index) json["index"] = *camera.index;
    if (camera.position) json["position"] = json_of_vector(*camera.position);
    if (camera.orientation)
        json["orientation"] = {camera.orientation->x, camera.orientation->y, camera.orientation->z,
                               camera.orientation->w};
    if (camera.y_fov) json["y_fov"] = shortest(*camera.y_fov);
    return json;
}

Json json_of(const LightChoice& light)
{
    Json json = Json::object();
    json["index"] = light.index;
    if (light.intensity) json["intensity"] = json_of_vector(*light.intensity);
    if (light.position) json["position"] = json_of_vector(*light.position);
    if (light.direction) json["direction"] = json_of_vector(*light.direction);
    return json;
}

}  // namespace

Preset read_preset(const std::filesystem::path& file, ParameterTable& parameters)
{
    std::error_code error;
    std::ifstream in(file, std::ios::binary);
    if (!in || std::filesystem::is_directory(file, error))
        throw std::runtime_error(file.string() + ": preset cannot be read");
    Json json;
    try {
        json = Json::parse(in);
    } catch (const Json::exception& fault) {
        throw std::runtime_error(file.string() + ": is no JSON: " + fault.what());
    }
    Preset preset;
    Entry{file, "", json}.for_each([&](const Entry& entry, const std::string& name) {
        if (name == "parameters") {
            read_parameters(entry, parameters);
        } else if (name == "parameters_if_present") {
            read_parameters_if_present(entry, parameters);
        } else if (name == "view") {
            if (!entry.value.is_string()) entry.refuse("must be the name of a view");
            preset.view = entry.value.get<std::string>();
        } else if (name == "camera") {
            preset.camera = read_camera(entry);
        } else if (name == "lights") {
            preset.lights = read_lights(entry);
        } else {
            entry.refuse("unknown entry; a preset has parameters, parameters_if_present, view, camera and lights");
        }
    });
    return preset;
}

void write_preset(const std::filesystem::path& file, const ParameterTable& parameters, const Preset& preset)
{
    Json json = Json::object();
    json["parameters"] = Json::object();
    for (const Parameter& parameter : parameters.all()) json["parameters"][parameter.name] = json_of(parameter);
    json["view"] = preset.view;
    const CameraChoice& camera = preset.camera;
    if (camera.index || camera.position || camera.orientation || camera.y_fov) json["camera"] = json_of(camera);
    for (const LightChoice& light : preset.lights) json["lights"].push_back(json_of(light));
    write_file(file, json.dump(2) + "\n");
}

Camera place_camera(const Scene& scene, const CameraChoice& choice)
{
    Camera camera = choose_camera(scene, choice.index);
    const glm::vec4 place = camera.world_from_camera[3];
    if (choice.orientation) camera.world_from_camera = glm::mat4(glm::mat4_cast(*choice.orientation));
    camera.world_from_camera[3] = choice.position ? glm::vec4(*choice.position - scene.origin_ws, 1.0) : place;
    if (choice.y_fov && camera.orthographic)
        throw std::runtime_error("camera.y_fov: the camera is orthographic and has none");
    camera.y_fov = choice.y_fov.value_or(camera.y_fov);
    return camera;
}

void place_lights(Scene& scene, const std::vector<LightChoice>& choices)
{
    for (const LightChoice& choice : choices) {
        if (std::size_t(choice.index) >= scene.lights.size())
            throw std::runtime_error("lights: index " + std::to_string(choice.index) + ": the scene has " +
                                     std::to_string(scene.lights.size()) + " lights");
        Light& light = scene.lights[std::size_t(choice.index)];
        light.intensity = choice.intensity.value_or(light.intensity);
        if (choice.position) light.position = glm::vec3(*choice.position - scene.origin_ws);
        if (choice.direction) light.direction = glm::vec3(glm::normalize(*choice.direction));
    }
}

CameraChoice choice_of(const Scene& scene, std::optional<int> index, const Camera& camera)
{
    const Camera start = choose_camera(scene, index);
    CameraChoice choice{index, {}, {}, {}};
    if (camera.world_from_camera != start.world_from_camera) {
        choice.position = scene.origin_ws + glm::dvec3(camera.world_from_camera[3]);
        choice.orientation = glm::normalize(glm::quat_cast(glm::dmat3(glm::dmat4(camera.world_from_camera))));
    }
    if (!camera.orthographic && camera.y_fov != start.y_fov) choice.y_fov = camera.y_fov;
    return choice;
}

}  // namespace conebook
