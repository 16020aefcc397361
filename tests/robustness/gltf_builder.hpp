// Small glTF files made in code, so that every test knows exactly what is in them.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include "image/codecs.hpp"
#include "scene/scene.hpp"
#include "temporary_folder.hpp"

namespace conebook::test {

using nlohmann::json;

inline std::filesystem::path write_file(const std::filesystem::path& file, const std::string& bytes)
{
    std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return file;
}

enum Component { s8 = 5120, u8 = 5121, s16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

// A glTF file: `root` may be edited at will, `binary` is its first buffer.
struct GltfBuilder {
    nlohmann::json root = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    std::string binary;
    nlohmann::json other_buffers = nlohmann::json::array();

    int append(const char* list, nlohmann::json element)
    {
        root[list].push_back(std::move(element));
        return static_cast<int>(root[list].size()) - 1;
    }
    int add_view(const std::string& bytes, int stride = 0)
    {
        while (binary.size() % 4 != 0) binary += '\0';
        nlohmann::json view = {{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes.size()}};
        if (stride != 0) view["byteStride"] = stride;
        binary += bytes;
        return append("bufferViews", view);
    }
    template <class T>
    static std::string bytes_of(const std::vector<T>& values)
    {
        return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
    }
    template <class T>
    int add_accessor(const std::vector<T>& values, Component component, const std::string& type,
                     bool normalized = false)
    {
        const std::size_t components = type == "SCALAR" ? 1
                                       : type == "MAT4" ? 16
                                                        : static_cast<std::size_t>(type.back() - '0');
        nlohmann::json accessor = {{"bufferView", add_view(bytes_of(values))},
                                   {"componentType", component},
                                   {"count", values.size() / components},
                                   {"type", type}};
        if (normalized) accessor["normalized"] = true;
        return append("accessors", accessor);
    }
    int add_floats(const std::vector<float>& values, int components)
    {
        return add_accessor(values, f32, components == 1 ? "SCALAR" : "VEC" + std::to_string(components));
    }
    int add_mesh(nlohmann::json primitive) { return append("meshes", {{"primitives", {std::move(primitive)}}}); }
    int add_node(nlohmann::json node) { return append("nodes", std::move(node)); }
    static std::string png(const std::vector<std::uint8_t>& rgba, int width, int height)
    {
        const std::vector<std::uint8_t> bytes = encode_png({width, height, rgba});
        return {bytes.begin(), bytes.end()};
    }
    // A texture with its own PNG image in the buffer. RGBA, width x height.
    int add_texture(const std::vector<std::uint8_t>& rgba, int width, int height)
    {
        const int image =
            append("images", {{"bufferView", add_view(png(rgba, width, height))}, {"mimeType", "image/png"}});
        return append("textures", {{"source", image}});
    }

    std::string glb() const
    {
        nlohmann::json with_buffer = root;
        if (!binary.empty()) with_buffer["buffers"] = {{{"byteLength", binary.size()}}};
        for (const nlohmann::json& buffer : other_buffers) with_buffer["buffers"].push_back(buffer);
        std::string text = with_buffer.dump(), data = binary;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        data.resize((data.size() + 3) / 4 * 4, '\0');
        const auto u32_bytes = [](std::size_t value) {
            const auto small = static_cast<std::uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&small), 4);
        };
        std::string file = "glTF" + u32_bytes(2) + u32_bytes(0) + u32_bytes(text.size()) + "JSON" + text;
        if (!data.empty()) file += u32_bytes(data.size()) + std::string("BIN\0", 4) + data;
        return file.replace(8, 4, u32_bytes(file.size()));
    }
    Scene load() const
    {
        const TemporaryFolder folder;
        return load_scene(write_file(folder.path() / "test.glb", glb()));
    }
};

// Scene 0 with node 0 with mesh 0: one triangle (0,0,0), (1,0,0), (0,1,0), facing +z, without normals.
inline GltfBuilder one_triangle()
{
    GltfBuilder gltf;
    const int position = gltf.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    gltf.add_mesh({{"attributes", {{"POSITION", position}}}});
    gltf.add_node({{"mesh", 0}});
    return gltf;
}

inline json& primitive(GltfBuilder& gltf) { return gltf.root["meshes"][0]["primitives"][0]; }

// Where corner `i` of the triangle list is, in world space.
inline glm::dvec3 corner_ws(const Scene& scene, std::size_t i)
{
    return glm::dvec3(scene.vertices.at(scene.indices.at(i)).position) + scene.origin_ws;
}

inline glm::vec3 face_normal(const Scene& scene, std::size_t triangle)
{
    const glm::dvec3 a = corner_ws(scene, 3 * triangle);
    return glm::normalize(glm::cross(corner_ws(scene, 3 * triangle + 1) - a, corner_ws(scene, 3 * triangle + 2) - a));
}

inline bool has_warning(const Scene& scene, const std::string& part)
{
    for (const std::string& line : scene.warnings) {
        if (line.find(part) != std::string::npos) return true;
    }
    return false;
}

// What load_scene says against the file; "" when it loads.
inline std::string refusal(const std::filesystem::path& file)
{
    try {
        load_scene(file);
        return "";
    } catch (const std::runtime_error& e) {
        return e.what();
    }
}

inline std::string refusal(const GltfBuilder& gltf)
{
    const TemporaryFolder folder;
    return refusal(write_file(folder.path() / "test.glb", gltf.glb()));
}

// Empty, or what is wrong with the nodes of a loaded scene and with what moves them.
inline std::string motion_fault(const Scene& scene)
{
    const auto is_node = [&](int i) { return i >= 0 && i < static_cast<int>(scene.nodes.size()); };
    std::uint32_t vertices = 0, indices = 0, draws = 0;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        if (node.parent >= static_cast<int>(i)) return "a node stands before its parent";
        if (node.skin >= static_cast<int>(scene.skins.size())) return "no such skin";
        if (node.draws.count == 0) continue;
        if (node.vertices.first != vertices || node.indices.first != indices || node.draws.first != draws) {
            return "what the nodes placed does not follow each other";
        }
        vertices = node.vertices.end();
        indices = node.indices.end();
        draws = node.draws.end();
        for (std::uint32_t v = node.indices.first; v < indices; ++v) {
            if (scene.indices[v] < node.vertices.first || scene.indices[v] >= vertices) return "a vertex is shared";
        }
    }
    if (vertices != scene.vertices.size() || indices != scene.indices.size() || draws != scene.draws.size()) {
        return "the nodes did not place everything";
    }
    for (const Skin& skin : scene.skins) {
        if (skin.joints.empty() || skin.joints.size() != skin.inverse_bind.size()) return "a skin without joints";
        for (const int joint : skin.joints) {
            if (!is_node(joint)) return "no such joint";
        }
    }
    for (const Animation& animation : scene.animations) {
        for (const AnimationChannel& channel : animation.channels) {
            if (!is_node(channel.node)) return "a channel moves no node";
            const AnimationSampler& curve = animation.samplers.at(static_cast<std::size_t>(channel.sampler));
            const std::size_t width = channel.path == AnimationPath::weights
                                          ? scene.nodes[static_cast<std::size_t>(channel.node)].weights.size()
                                      : channel.path == AnimationPath::rotation ? 4
                                                                                : 3;
            if (curve.times.empty() || curve.width() != width) return "a curve has the wrong width";
        }
    }
    return "";
}

// Empty, or what is wrong with a loaded scene: everything finite and in range, whatever was in the file.
inline std::string scene_fault(const Scene& scene)
{
    const auto finite = [](auto v) {
        for (int i = 0; i < v.length(); ++i) {
            if (!std::isfinite(v[i])) return false;
        }
        return true;
    };
    if (scene.indices.empty() || scene.indices.size() % 3 != 0) return "no triangle list";
    for (const std::uint32_t index : scene.indices) {
        if (index >= scene.vertices.size()) return "index out of range";
    }
    for (const Vertex& v : scene.vertices) {
        if (!finite(v.position) || !finite(v.uv0) || !finite(v.uv1)) return "a vertex is not finite";
        if (!(std::abs(glm::length(v.normal) - 1.0f) < 1e-4f)) return "a normal is not of unit length";
        if (!(std::abs(glm::length(glm::vec3(v.tangent)) - 1.0f) < 1e-4f)) return "a tangent is not of unit length";
        if (!(std::abs(glm::dot(v.normal, glm::vec3(v.tangent))) < 1e-3f)) return "a tangent leans";
        if (std::abs(v.tangent.w) != 1.0f) return "a tangent has no side";
        for (int c = 0; c < 4; ++c) {
            if (!(v.color[c] >= 0.0f && v.color[c] <= 1.0f)) return "a colour is outside 0..1";
        }
        for (int c = 0; c < 3; ++c) {
            const float slack = 1e-5f * (scene.bounds.longest_side() + 1e-30f);
            if (v.position[c] < scene.bounds.min[c] - slack || v.position[c] > scene.bounds.max[c] + slack) {
                return "a vertex is outside the bounds";
            }
        }
    }
    std::size_t covered = 0;
    for (const Draw& draw : scene.draws) {
        if (draw.first_index != covered || draw.index_count % 3 != 0) return "draws do not follow each other";
        covered += draw.index_count;
        if (draw.material < 0 || draw.material >= static_cast<int>(scene.materials.size())) return "no such material";
    }
    if (covered != scene.indices.size()) return "the draws do not cover the triangles";
    for (const Material& m : scene.materials) {
        for (int c = 0; c < 4; ++c) {
            if (!(m.base_color[c] >= 0.0f && m.base_color[c] <= 1.0f)) return "a base colour is outside 0..1";
        }
        if (!finite(m.emission) || !(glm::min(m.emission.x, glm::min(m.emission.y, m.emission.z)) >= 0.0f)) {
            return "an emission is negative or not finite";
        }
        if (!(m.roughness >= 0.0f && m.roughness <= 1.0f && m.metallic >= 0.0f && m.metallic <= 1.0f)) {
            return "roughness or metallic is outside 0..1";
        }
        for (const TextureSlot* slot : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                                        &m.emission_texture, &m.specular_texture, &m.specular_color_texture}) {
            if (slot->image >= static_cast<int>(scene.images.size())) return "no such image";
            if (slot->uv_set != 0 && slot->uv_set != 1) return "no such UV set";
            for (int c = 0; c < 3; ++c) {
                if (!finite(slot->uv_transform[c])) return "a UV transform is not finite";
            }
        }
    }
    for (const Image& image : scene.images) {
        const auto size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4;
        if (image.width < 1 || image.height < 1 || image.rgba.size() != size) return "an image has the wrong size";
    }
    for (const Light& light : scene.lights) {
        if (!finite(light.intensity) || !finite(light.position)) return "a light is not finite";
        if (!(std::abs(glm::length(light.direction) - 1.0f) < 1e-4f)) return "a light's direction is not a unit vector";
    }
    for (const Camera& camera : scene.cameras) {
        for (int c = 0; c < 4; ++c) {
            if (!finite(camera.world_from_camera[c])) return "a camera is not finite";
        }
    }
    return motion_fault(scene);
}

}  // namespace conebook::test
