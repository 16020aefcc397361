// What a run was set to, as a JSON file that makes another run the same (--preset, --save-preset):
//
//     {"parameters": {"voxels": 128, "cones": 6, "srgb": true}, "view": "final", "camera": 0}
//
// Every entry may be left out. A camera that was flown has a pose instead of a number:
//
//     "camera": {"index": 0, "position": [x, y, z], "orientation": [x, y, z, w], "y_fov": 0.8}
//
// position in m and orientation (a unit quaternion) in the file's world, as glTF's nodes have them; y_fov in rad.
// Lights, by their place among the scene's, may have another intensity (W/sr; directional ones W/m^2), place and
// direction:
//
//     "lights": [{"index": 0, "intensity": [r, g, b], "position": [x, y, z], "direction": [x, y, z]}]
//
// A preset that several chapters share names apart what some of them lack, and go without:
//
//     "parameters_if_present": {"aimed_rays": 0, "bounces": 2}
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "app/parameters.hpp"
#include "scene/scene.hpp"

namespace conebook {

// Which camera of the scene (choose_camera), and where it stands instead when it was moved.
struct CameraChoice {
    std::optional<int> index;
    std::optional<glm::dvec3> position;  // m, world space (not Scene's, which is relative to the middle of its bounds)
    std::optional<glm::dquat> orientation;
    std::optional<float> y_fov;  // rad, perspective cameras alone
};

// What is another way than in the scene's file about one of its lights.
struct LightChoice {
    int index = 0;                        // of Scene::lights
    std::optional<glm::vec3> intensity;   // W/sr, directional: W/m^2
    std::optional<glm::dvec3> position;   // m, world space
    std::optional<glm::dvec3> direction;  // unit, world space
};

// What a preset holds besides the parameters, which go to their fields.
struct Preset {
    std::string view;  // empty: not in the file
    CameraChoice camera;
    std::vector<LightChoice> lights{};
};

// Throws std::runtime_error that names the file and the entry: no JSON, an unknown name, a value that does not go
// there. What the file does not hold keeps its value.
Preset read_preset(const std::filesystem::path& file, ParameterTable& parameters);

// Throws std::runtime_error when the file cannot be written; nothing is left half-written.
void write_preset(const std::filesystem::path& file, const ParameterTable& parameters, const Preset& preset);

// The camera that the choice means. Throws as choose_camera does, and when an orthographic camera is to have a y_fov.
Camera place_camera(const Scene& scene, const CameraChoice& choice);

// Throws std::runtime_error for an index that the scene has no light for.
void place_lights(Scene& scene, const std::vector<LightChoice>& choices);

// `index` alone where `camera` is still the scene's, its pose besides where it was moved.
CameraChoice choice_of(const Scene& scene, std::optional<int> index, const Camera& camera);

}  // namespace conebook
