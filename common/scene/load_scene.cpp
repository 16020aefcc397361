// load_scene: glTF file -> Scene. Two walks over the instances: the first finds the bounding box in double precision,
// the second writes vertices relative to its middle.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <new>

#include "scene/parts.hpp"

namespace conebook {
namespace gltf {
namespace {

// A position beyond this would overflow squared lengths in float (1e18^2 = 1e36).
constexpr double largest_extent = 1e18;

struct PlacedMesh {
    const LocalMesh* mesh = nullptr;
    Instance instance;
    std::string name;
};

// Every primitive that the scene uses, read once however often it is placed.
class MeshLibrary {
public:
    MeshLibrary(const Document& document, const Materials& materials, Warnings& warnings)
        : document_(document), materials_(materials), warnings_(warnings)
    {
    }

    const std::vector<LocalMesh>& get(int mesh)
    {
        const auto [entry, is_new] = meshes_.try_emplace(mesh);
        if (!is_new) return entry->second;
        const auto& primitives = document_.model.meshes.at(static_cast<std::size_t>(mesh)).primitives;
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const int none = static_cast<int>(materials_.materials.size()) - 1;
            const int material = primitives[i].material < 0 ? none : primitives[i].material;
            entry->second.push_back(read_primitive(document_, mesh, i, material, materials_, warnings_));
        }
        return entry->second;
    }

private:
    const Document& document_;
    const Materials& materials_;
    Warnings& warnings_;
    std::map<int, std::vector<LocalMesh>> meshes_;
};

// Refuse a scene that is too large by what its accessors claim, before anything is read.
void check_size(const Document& document, const std::vector<Instance>& nodes)
{
    const auto element_count = [&](int accessor) {
        return static_cast<std::uint64_t>(document.model.accessors.at(static_cast<std::size_t>(accessor)).count);
    };
    std::uint64_t triangles = 0, vertices = 0;
    for (const Instance& instance : nodes) {
        const int mesh = document.model.nodes[static_cast<std::size_t>(instance.node)].mesh;
        if (mesh < 0) continue;
        for (const auto& primitive : document.model.meshes[static_cast<std::size_t>(mesh)].primitives) {
            const auto position = primitive.attributes.find("POSITION");
            if (primitive.mode < TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end()) continue;
            const std::uint64_t positions = element_count(position->second);
            const std::uint64_t corners = primitive.indices < 0 ? positions : element_count(primitive.indices);
            triangles += primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners;
            // Flat normals give every corner its own vertex.
            vertices += primitive.attributes.contains("NORMAL") ? std::min(corners, positions) : corners;
            if (triangles > max_triangles || vertices > max_vertices) {
                fail("the scene has more than 100 million triangles or 50 million vertices after instancing");
            }
        }
    }
}

std::vector<PlacedMesh> place_meshes(const Document& document, const std::vector<Instance>& nodes, MeshLibrary& library,
                                     Warnings& warnings)
{
    std::vector<PlacedMesh> placed;
    for (const Instance& instance : nodes) {
        const auto& node = document.model.nodes[static_cast<std::size_t>(instance.node)];
        if (node.mesh < 0) continue;
        if (node.skin >= 0) warn(warnings, "skins are ignored: meshes are shown as modelled, at their node");
        const auto& mesh = document.model.meshes[static_cast<std::size_t>(node.mesh)];
        for (const LocalMesh& local : library.get(node.mesh)) {
            if (local.indices.empty()) continue;
            placed.push_back({&local, instance, node.name.empty() ? mesh.name : node.name});
        }
    }
    if (placed.empty()) fail("the scene has no triangles");
    return placed;
}

struct BoxWs {
    glm::dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
};

BoxWs bounding_box_ws(const std::vector<PlacedMesh>& placed)
{
    BoxWs box;
    for (const PlacedMesh& place : placed) {
        for (const Vertex& vertex : place.mesh->vertices) {
            const glm::dvec3 position(place.instance.world_from_node * glm::dvec4(vertex.position, 1.0));
            if (!std::isfinite(position.x + position.y + position.z)) {
                fail("nodes[" + std::to_string(place.instance.node) + "] moves a vertex to infinity");
            }
            box.min = glm::min(box.min, position);
            box.max = glm::max(box.max, position);
        }
    }
    const glm::dvec3 extent = box.max - box.min;
    if (!(std::max({extent.x, extent.y, extent.z}) < largest_extent)) fail("the scene is larger than 1e18 m");
    return box;
}

// Append one placed mesh: positions by the matrix, normals by its inverse transpose, tangents by the matrix.
void append(Scene& scene, const PlacedMesh& place)
{
    const glm::dmat4& world_from_node = place.instance.world_from_node;
    const glm::dmat3 linear(world_from_node);
    // The matrix of cofactors is det * inverse transpose, and exists for flattened nodes (scale 0) too.
    const glm::dmat3 cofactors(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                               glm::cross(linear[0], linear[1]));
    const double determinant = glm::dot(linear[0], cofactors[0]);
    const bool mirrored = determinant < 0.0;
    const double sign = mirrored ? -1.0 : 1.0;

    std::vector<Vertex> vertices = place.mesh->vertices;
    std::vector<std::uint32_t> indices = place.mesh->indices;
    if (mirrored) {
        for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
    }
    const auto unit = [](glm::dvec3 v) {
        const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        return largest > 0.0 && std::isfinite(largest) ? glm::normalize(v / largest) : glm::dvec3(0.0);
    };
    for (Vertex& vertex : vertices) {
        const glm::dvec3 position_ws(world_from_node * glm::dvec4(vertex.position, 1.0));
        vertex.position = glm::vec3(position_ws - scene.origin_ws);
        vertex.normal = glm::vec3(unit(cofactors * glm::dvec3(vertex.normal)) * sign);
    }
    repair_normals(vertices, indices);  // a node scaled to nothing leaves normals without a direction
    for (Vertex& vertex : vertices) {
        const glm::dvec3 normal = vertex.normal;
        const glm::dvec3 tangent = linear * glm::dvec3(vertex.tangent);
        const glm::dvec3 flat = unit(unit(tangent) - normal * glm::dot(normal, unit(tangent)));
        vertex.tangent = glm::vec4(flat == glm::dvec3(0.0) ? perpendicular(vertex.normal) : glm::vec3(flat),
                                   vertex.tangent.w * (mirrored ? -1.0f : 1.0f));
    }

    const auto first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
    Draw draw;
    draw.first_index = static_cast<std::uint32_t>(scene.indices.size());
    draw.index_count = static_cast<std::uint32_t>(indices.size());
    draw.material = place.mesh->material;
    draw.name = place.name;
    scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
    for (const std::uint32_t index : indices) scene.indices.push_back(first_vertex + index);
    scene.draws.push_back(std::move(draw));
}

// alphaMode BLEND: see Material::alpha_mode. Only where something is indeed translucent.
void settle_blending(Scene& scene, const Materials& materials)
{
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        Material& material = scene.materials[m];
        if (!materials.readings[m].blend) continue;
        bool translucent = material.base_color.a < 1.0f;
        if (material.base_color_texture.present()) {
            const auto& rgba = scene.images[static_cast<std::size_t>(material.base_color_texture.image)].rgba;
            for (std::size_t i = 3; i < rgba.size() && !translucent; i += 4) translucent = rgba[i] < 255;
        }
        for (const Draw& draw : scene.draws) {
            if (translucent || draw.material != static_cast<int>(m)) continue;
            for (std::uint32_t i = 0; i < draw.index_count; ++i) {
                translucent = translucent || scene.vertices[scene.indices[draw.first_index + i]].color.a < 1.0f;
            }
        }
        if (!translucent) continue;
        material.alpha_mode = AlphaMode::mask;
        material.alpha_cutoff = 0.5f;
        warn(scene.warnings, "materials[" + std::to_string(m) + "] '" + material.name +
                                 "' blends, which is read as a mask at alpha 0.5");
    }
}

bool emits(const Material& material, const std::vector<Image>& images)
{
    if (material.emission == glm::vec3(0.0f)) return false;
    if (!material.emission_texture.present()) return true;
    // Some exporters write a factor of 1 with a black texture.
    const auto& rgba = images[static_cast<std::size_t>(material.emission_texture.image)].rgba;
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        for (int c = 0; c < 3; ++c) {
            if (rgba[i + static_cast<std::size_t>(c)] > 0 && material.emission[c] > 0.0f) return true;
        }
    }
    return false;
}

bool has_emitter(const Scene& scene)
{
    std::vector<std::uint8_t> used(scene.materials.size(), 0);
    for (const Draw& draw : scene.draws) used[static_cast<std::size_t>(draw.material)] = 1;
    for (std::size_t m = 0; m < used.size(); ++m) {
        if (used[m] && emits(scene.materials[m], scene.images)) return true;
    }
    return false;
}

Scene read_scene(const std::filesystem::path& file)
{
    Scene scene;
    scene.name = file.stem().string();
    const Document document = read_document(file, scene.warnings);
    const std::vector<Instance> nodes = walk_nodes(document);
    const Materials materials = read_materials(document, scene.warnings);
    check_size(document, nodes);
    MeshLibrary library(document, materials, scene.warnings);
    const std::vector<PlacedMesh> placed = place_meshes(document, nodes, library, scene.warnings);

    const BoxWs box = bounding_box_ws(placed);
    scene.origin_ws = 0.5 * (box.min + box.max);
    scene.bounds = {glm::vec3(box.min - scene.origin_ws), glm::vec3(box.max - scene.origin_ws)};
    std::size_t vertices = 0, indices = 0;
    for (const PlacedMesh& place : placed) {
        vertices += place.mesh->vertices.size();
        indices += place.mesh->indices.size();
    }
    scene.vertices.reserve(vertices);
    scene.indices.reserve(indices);
    for (const PlacedMesh& place : placed) append(scene, place);

    scene.materials = materials.materials;
    scene.images = read_images(document, materials.images, scene.warnings);
    settle_blending(scene, materials);
    scene.cameras = read_cameras(document, nodes, scene.origin_ws, scene.warnings);
    scene.lights = read_lights(document, nodes, scene.origin_ws, scene.warnings);
    if (scene.lights.empty() && !has_emitter(scene)) {
        scene.has_default_light = true;
        scene.lights.push_back(default_light(scene));
    }
    return scene;
}

// Names in a damaged file may hold anything; an error or a warning is one line of bounded length.
std::string one_line(std::string text)
{
    for (char& c : text) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    }
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    std::size_t end = 500;
    while (end < text.size() && (text[end] & 0xc0) == 0x80) --end;  // not within a character of UTF-8
    if (text.size() > end) text = text.substr(0, end) + " ...";
    return text;
}

}  // namespace
}  // namespace gltf

Scene load_scene(const std::filesystem::path& file)
{
    const auto refuse = [&](const std::string& fault) {
        throw std::runtime_error(gltf::one_line(file.string() + ": " + fault));
    };
    try {
        Scene scene = gltf::read_scene(file);
        for (std::string& warning : scene.warnings) warning = gltf::one_line(warning);
        return scene;
    } catch (const std::bad_alloc&) {
        refuse("there is not enough memory to load it");
    } catch (const std::exception& e) {
        refuse(e.what());
    }
    return {};
}

}  // namespace conebook
