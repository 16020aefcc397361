// A glTF 2.0 scene as plain values, and its writer to a binary .glb file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "image.hpp"
#include "mesh.hpp"

namespace conebook::generator {

struct Material {
    std::string name;
    glm::dvec3 base_color{0.8};   // linear; Lambert reflectance rho when `specular` and `metallic` are 0
    double metallic = 0.0;
    double roughness = 1.0;
    double specular = 1.0;        // KHR_materials_specular; 0: no dielectric reflection
    glm::dvec3 emission{0.0};     // radiance, W/(sr m^2), also above 1 (KHR_materials_emissive_strength)
    bool double_sided = false;
    bool alpha_mask = false;      // alpha of the base colour texture against 0.5
    int base_color_texture = -1, metallic_roughness_texture = -1, normal_texture = -1, emission_texture = -1;
};

// Pure Lambert of reflectance rho (linear RGB), with emitted radiance.
Material lambert(std::string name, glm::dvec3 rho, glm::dvec3 emission = glm::dvec3(0.0));

struct Object {
    std::string name;
    int mesh = 0, material = 0;   // mesh -1: a node that shows nothing, a joint
    glm::dvec3 translation{0.0};  // m
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
    int parent = -1;              // an object before this one, in whose space it stands
    bool skinned = false;         // the asset's skin moves its mesh
};

enum class Path { translation, rotation, scale, weights };
enum class Interpolation { step, linear, cubic_spline };

// What an object does over time. Rotations are quaternions x y z w. A key is one row of `values`; of a cubic spline three:
// tangent in, value, tangent out, tangents a second.
struct Track {
    int object = 0;
    Path path = Path::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times_s;
    std::vector<std::vector<double>> values;
};

enum class LightKind { directional, point, spot };

struct Light {
    std::string name;
    LightKind kind = LightKind::point;
    glm::dvec3 color{1.0};
    double intensity = 1.0;                // W/sr; directional: W/m^2
    glm::dvec3 position{0.0};              // m
    glm::dvec3 direction{0.0, -1.0, 0.0};  // the way the light travels
    double inner_degrees = 0.0, outer_degrees = 45.0;  // spot, half angles
    int parent = -1;                       // the object that carries it: position and direction are in its space
};

struct Camera {
    std::string name;
    glm::dvec3 eye{0.0}, target{0.0, 0.0, -1.0};  // m
    double y_fov_degrees = 45.0;
    glm::dvec3 up{0.0, 1.0, 0.0};
};

struct Asset {
    std::string name;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<Picture> textures;
    std::vector<Object> objects;
    std::vector<Light> lights;
    std::vector<Camera> cameras;
    std::vector<Track> tracks;  // one animation
    std::vector<int> joints;    // objects: the joints of the skin

    // Appends a mesh with its material and one object that shows it; returns the object's index.
    int add(std::string object_name, Mesh mesh, Material material);
    // Appends an object that shows nothing; returns its index.
    int add_joint(std::string object_name, int parent, glm::dvec3 translation);
};

// Writes `asset` as glTF 2.0 binary (12-byte header, JSON chunk, BIN chunk). Throws std::runtime_error that names
// the file.
void write_glb(const Asset& asset, const std::filesystem::path& file);

}  // namespace conebook::generator
