// The scene as every part of the book sees it: flat arrays of triangles, materials, lights and cameras.
// The loader has already walked the node hierarchy, so positions are final. The nodes are kept beside them (motion.hpp),
// for those who move them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "scene/motion.hpp"

namespace conebook {

// A vertex in scene space: world space minus Scene::origin_ws, in metres.
struct Vertex {
    glm::vec3 position;  // m
    glm::vec3 normal;    // unit; faces the side from which the triangle winds counter-clockwise
    glm::vec4 tangent;   // xyz unit, w = +-1: bitangent = w * cross(normal, tangent) (glTF 2.0, 3.7.2.1)
    glm::vec2 uv0;       // the two UV sets that the primitive's material uses (see TextureSlot::uv_set)
    glm::vec2 uv1;
    glm::vec4 color;     // linear RGBA, 1 when the file has none
};

// One image, 8 bit RGBA, as stored in the file (base colour and emission are sRGB encoded, the others linear).
struct Image {
    std::string name;
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // height * width * 4, first row is v = 0 (glTF's top row)
};

enum class Wrap { repeat, clamp_to_edge, mirrored_repeat };
enum class Filter { nearest, linear };

// A texture as a material uses it. uv' = uv_transform * vec3(uv, 1) (KHR_texture_transform).
struct TextureSlot {
    int image = -1;   // index into Scene::images, -1: none
    int uv_set = 0;   // 0: Vertex::uv0, 1: Vertex::uv1
    Wrap wrap_s = Wrap::repeat, wrap_t = Wrap::repeat;
    Filter mag_filter = Filter::linear;
    Filter min_filter = Filter::linear;
    bool mipmapped = true;
    glm::mat3 uv_transform{1.0f};
    bool present() const { return image >= 0; }
};

// The book has no transparency. alphaMode BLEND is read as mask with cutoff 0.5, and a warning, where texture, factor
// or vertex colour are indeed translucent (leaves keep their shape, clear glass vanishes), and else as opaque.
enum class AlphaMode { opaque, mask };

struct Material {
    std::string name;
    glm::vec4 base_color{1.0f};   // linear RGBA factor, each channel clamped to 0..1
    float metallic = 1.0f;        // 0..1
    float roughness = 1.0f;       // perceptual, 0..1; GGX alpha = roughness^2
    glm::vec3 emission{0.0f};     // radiance factor, W/(sr m^2): emissiveFactor * emissiveStrength
    float normal_scale = 1.0f;
    float specular = 1.0f;        // KHR_materials_specular specularFactor; 0 = pure Lambert (dielectric part)
    glm::vec3 specular_color{1.0f};
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unlit = false;           // KHR_materials_unlit: base colour is shown as radiance, reflects nothing
    TextureSlot base_color_texture;          // sRGB, A = alpha
    TextureSlot metallic_roughness_texture;  // G = roughness, B = metallic
    TextureSlot normal_texture;              // tangent space
    TextureSlot emission_texture;            // sRGB
    TextureSlot specular_texture;            // A scales `specular`
    TextureSlot specular_color_texture;      // sRGB
    bool shines() const { return unlit || emission != glm::vec3(0.0f); }
    std::string extras;                      // JSON, "" where the file has none
};

// A run of triangles with one material: indices [first_index, first_index + index_count) of Scene::indices.
struct Draw {
    std::uint32_t first_index = 0, index_count = 0;
    int material = 0;
    std::string name;
    Range vertices{};           // of Scene::vertices, those of the triangles
    bool flat_normals = false;  // the file has no normals: three vertices of its own for each triangle, with its face normal
};

enum class LightType : int { directional = 0, point = 1, spot = 2 };

// KHR_lights_punctual. Intensity includes colour: W/m^2 (directional, irradiance) or W/sr (point, spot).
struct Light {
    LightType type = LightType::point;
    glm::vec3 intensity{1.0f};
    glm::vec3 position{0.0f};              // scene space
    glm::vec3 direction{0.0f, 0.0f, -1.0f}; // unit, the way the light travels
    float range = 0.0f;                    // m; 0: infinite
    float inner_cone_angle = 0.0f;         // rad, half angle
    float outer_cone_angle = 0.7853982f;   // rad, half angle
    std::string name;
};

struct Camera {
    std::string name;
    glm::mat4 world_from_camera{1.0f};     // camera looks along its -z, y up; rigid (no scale)
    bool orthographic = false;
    float y_fov = 0.8f;                    // rad, perspective
    float x_mag = 1.0f, y_mag = 1.0f;      // half width / height, orthographic
    float z_near = 0.01f;
    float z_far = 0.0f;                    // 0: infinite
};

struct Scene {
    std::string name;
    // World space position of scene space (0,0,0): the middle of the bounding box. Positions are transformed in
    // double precision and made relative to it, so that a scene far from its origin keeps its precision.
    glm::dvec3 origin_ws{0.0};
    Bounds bounds;                         // of all triangles, scene space
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;    // triangle list
    std::vector<Draw> draws;
    std::vector<Material> materials;       // at least one
    std::vector<Image> images;
    std::vector<Light> lights;
    std::vector<Camera> cameras;           // only those in the file, in the order of their nodes' indices
    std::vector<Node> nodes;               // of the file's scene, depth first; what each of them placed
    std::vector<Animation> animations;     // pose.hpp plays them
    std::vector<Skin> skins;
    std::vector<ModelledVertex> modelled;  // of what moves, see Node::modelled
    std::vector<MorphDelta> deltas;        // see Node::first_delta
    std::string extras;                    // of the file's scene: JSON, "" where it has none
    // The file had neither a light nor an emissive surface, and `lights` holds one that the loader added: directional,
    // white, irradiance pi W/m^2 (a white diffuse surface facing it has radiance 1), from over the left shoulder of
    // the camera that choose_camera gives.
    bool has_default_light = false;
    std::vector<std::string> warnings;     // what was read differently from how the file says it, one line each
    std::size_t triangle_count() const { return indices.size() / 3; }
};

// Read a .gltf or .glb (glTF 2.0), its default scene (the first one when none is named, all root nodes when there is
// none). Textures are PNG or JPEG. Supported extensions: KHR_lights_punctual, KHR_materials_emissive_strength,
// KHR_materials_specular, KHR_materials_unlit, KHR_texture_transform; any other is refused by name when the file
// requires it and ignored with a warning when it does not. Flat normals where the file has none; tangents where it has
// none. Mirrored nodes keep their front faces. Images wider or higher than 16384 are shrunk, with a warning. Not read, with
// a warning: points and lines, a material's third UV set, a vertex's fifth joint. Animations and skins that are not sound
// are left out, with a warning. Throws std::runtime_error with one line, "<file>: <fault>",
// for anything damaged, for a scene without triangles, and for sizes beyond the limits in document.hpp.
Scene load_scene(const std::filesystem::path& file);

// The camera to render with: the Nth of the file, or (index empty) the first of the file, or, when the file has
// none, one that frames the bounds. Throws std::runtime_error when the file has no Nth camera.
Camera choose_camera(const Scene& scene, std::optional<int> index);

// Distances along the camera's axis, m: near > 0 for a perspective, far > near.
struct DepthRange {
    double near, far;
};
// What lies in `bounds` and between the camera's near and far planes lies between these two, which are as close together
// as that allows: depth and rays that begin there do not lose their digits to the empty way to a scene far away.
DepthRange visible_depths(const Camera& camera, const Bounds& bounds);

}  // namespace conebook
