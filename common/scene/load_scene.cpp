// load_scene: glTF file -> Scene. Two walks over the instances: the first finds the bounding box in double precision,
// the second writes vertices relative to its middle.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <new>

#include "scene/parts.hpp"

namespace conebook {
namespace gltf {
namespace {

struct PlacedMesh {
    const LocalMesh* mesh = nullptr;
    std::size_t node = 0;  // index into Scene::nodes
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
void check_size(const Document& document, const std::vector<Node>& nodes)
{
    const auto element_count = [&](int accessor) {
        return static_cast<std::uint64_t>(document.model.accessors.at(static_cast<std::size_t>(accessor)).count);
    };
    std::uint64_t triangles = 0, vertices = 0, deltas = 0;
    for (const Node& node : nodes) {
        const int mesh = document.model.nodes[static_cast<std::size_t>(node.file_index)].mesh;
        if (mesh < 0) continue;
        for (const auto& primitive : document.model.meshes[static_cast<std::size_t>(mesh)].primitives) {
            const auto position = primitive.attributes.find("POSITION");
            if (primitive.mode < TINYGLTF_MODE_TRIANGLES || position == primitive.attributes.end()) continue;
            const std::uint64_t positions = element_count(position->second);
            const std::uint64_t corners = primitive.indices < 0 ? positions : element_count(primitive.indices);
            triangles += primitive.mode == TINYGLTF_MODE_TRIANGLES ? corners / 3 : corners;
            // Flat normals give every corner its own vertex.
            vertices += primitive.attributes.contains("NORMAL") ? std::min(corners, positions) : corners;
            deltas += primitive.targets.size() * corners;
            if (deltas > max_morph_deltas) fail("the scene has more than 16 million vertices of morph targets");
            if (triangles > max_triangles || vertices > max_vertices) {
                fail("the scene has more than 100 million triangles or 50 million vertices after instancing");
            }
        }
    }
}

// Skins whose joints the vertices of their meshes do not know are left out.
void check_skins(Scene& scene, const std::vector<PlacedMesh>& placed, Warnings& warnings)
{
    for (const PlacedMesh& place : placed) {
        Node& node = scene.nodes[place.node];
        if (node.skin < 0) continue;
        const std::size_t count = scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
        bool sound = !place.mesh->joints.empty();
        for (const glm::uvec4 joints : place.mesh->joints) {
            sound = sound && std::max({joints.x, joints.y, joints.z, joints.w}) < count;
        }
        if (sound) continue;
        warn(warnings, "nodes[" + std::to_string(node.file_index) + "] '" + place.name +
                           "' has a skin without a mesh of vertices that name its joints; it is not applied");
        node.skin = -1;
    }
}

std::vector<PlacedMesh> place_meshes(const Document& document, const std::vector<Node>& nodes, MeshLibrary& library)
{
    std::vector<PlacedMesh> placed;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const int index = document.model.nodes[static_cast<std::size_t>(nodes[i].file_index)].mesh;
        if (index < 0) continue;
        const auto& mesh = document.model.meshes[static_cast<std::size_t>(index)];
        for (const LocalMesh& local : library.get(index)) {
            if (local.indices.empty()) continue;
            placed.push_back({&local, i, nodes[i].name.empty() ? mesh.name : nodes[i].name});
        }
    }
    if (placed.empty()) fail("the scene has no triangles");
    return placed;
}

struct BoxWs {
    glm::dvec3 min{std::numeric_limits<double>::infinity()}, max{-std::numeric_limits<double>::infinity()};
};

// A placed mesh and what puts its vertices into the world.
class Placing {
public:
    Placing(const Scene& scene, const std::vector<NodePose>& rest, const PlacedMesh& place)
        : mesh_(*place.mesh), node_(scene.nodes[place.node]), matrices_(world_from_mesh(scene, rest, place.node))
    {
    }
    glm::dmat4 matrix(std::size_t v) const
    {
        return node_.skin < 0 ? matrices_[0] : blended(matrices_, mesh_.joints[v], mesh_.joint_weights[v]);
    }
    // As modelled, with the morph targets that the rest pose has.
    Vertex vertex(std::size_t v) const
    {
        Vertex vertex = mesh_.vertices[v];
        for (std::size_t t = 0; t < node_.weights.size(); ++t) {
            const auto weight = static_cast<float>(node_.weights[t]);
            const MorphDelta& delta = mesh_.targets[t][v];
            vertex.position += weight * delta.position;
            vertex.normal += weight * delta.normal;
            vertex.tangent += glm::vec4(weight * delta.tangent, 0.0f);
        }
        return vertex;
    }

private:
    const LocalMesh& mesh_;
    const Node& node_;
    std::vector<glm::dmat4> matrices_;
};

BoxWs bounding_box_ws(const Scene& scene, const std::vector<NodePose>& rest, const std::vector<PlacedMesh>& placed)
{
    BoxWs box;
    for (const PlacedMesh& place : placed) {
        const Placing placing(scene, rest, place);
        for (std::size_t v = 0; v < place.mesh->vertices.size(); ++v) {
            const glm::dvec3 position(placing.matrix(v) * glm::dvec4(placing.vertex(v).position, 1.0));
            if (!std::isfinite(position.x + position.y + position.z)) {
                fail("nodes[" + std::to_string(scene.nodes[place.node].file_index) + "] moves a vertex to infinity");
            }
            box.min = glm::min(box.min, position);
            box.max = glm::max(box.max, position);
        }
    }
    const glm::dvec3 extent = box.max - box.min;
    const double longest = std::max({extent.x, extent.y, extent.z});
    if (!(longest <= max_extent)) fail("the scene is larger than 1e9 m");
    // Nothing but points in one place is no small scene: it is empty, and a black picture.
    if (longest > 0.0 && longest < min_extent) fail("the scene is smaller than 1e-6 m");
    return box;
}

// Keep the vertices of a mesh as modelled, for those who pose them.
void keep_modelled(Scene& scene, const LocalMesh& mesh)
{
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const Vertex& vertex = mesh.vertices[v];
        ModelledVertex modelled{vertex.position, vertex.normal, vertex.tangent};
        if (!mesh.joints.empty()) {
            modelled.joints = mesh.joints[v];
            modelled.weights = mesh.joint_weights[v];
        }
        scene.modelled.push_back(modelled);
    }
}

// Append one placed mesh in the rest pose.
void append(Scene& scene, const std::vector<NodePose>& rest, const PlacedMesh& place)
{
    Node& node = scene.nodes[place.node];
    const Placing placing(scene, rest, place);
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices = place.mesh->indices;
    for (std::size_t v = 0; v < place.mesh->vertices.size(); ++v) {
        vertices.push_back(placed(placing.vertex(v), placing.matrix(v), scene.origin_ws));
    }
    node.mirrored = is_mirroring(placing.matrix(0));
    if (node.mirrored) {
        for (std::size_t i = 0; i < indices.size(); i += 3) std::swap(indices[i + 1], indices[i + 2]);
    }
    if (place.mesh->flat_normals && (node.skin >= 0 || !node.weights.empty())) {
        for (Vertex& vertex : vertices) vertex.normal = glm::vec3(0.0f);  // the faces' own, now that these have moved
    }
    repair_normals(vertices, indices);  // a node scaled to nothing leaves normals without a direction
    for (Vertex& vertex : vertices) finish_tangent(vertex);

    const auto first_vertex = static_cast<std::uint32_t>(scene.vertices.size());
    const auto first_index = static_cast<std::uint32_t>(scene.indices.size());
    if (node.draws.count == 0) {
        node.vertices.first = first_vertex;
        node.indices.first = first_index;
        node.draws.first = static_cast<std::uint32_t>(scene.draws.size());
        node.bounds = {vertices[0].position, vertices[0].position};
        node.modelled.first = static_cast<std::uint32_t>(scene.modelled.size());
    }
    if (node.dynamic || node.skin >= 0 || !node.weights.empty()) {
        keep_modelled(scene, *place.mesh);
        node.modelled.count += static_cast<std::uint32_t>(vertices.size());
    }
    ++node.draws.count;
    node.vertices.count += static_cast<std::uint32_t>(vertices.size());
    node.indices.count += static_cast<std::uint32_t>(indices.size());
    for (const Vertex& vertex : vertices) {
        node.bounds.min = glm::min(node.bounds.min, vertex.position);
        node.bounds.max = glm::max(node.bounds.max, vertex.position);
    }
    Draw draw;
    draw.first_index = first_index;
    draw.index_count = static_cast<std::uint32_t>(indices.size());
    draw.material = place.mesh->material;
    draw.name = place.name;
    draw.vertices = {first_vertex, static_cast<std::uint32_t>(vertices.size())};
    draw.flat_normals = place.mesh->flat_normals;
    scene.vertices.insert(scene.vertices.end(), vertices.begin(), vertices.end());
    for (const std::uint32_t index : indices) scene.indices.push_back(first_vertex + index);
    scene.draws.push_back(std::move(draw));
}

// Deltas of all morph targets of a node stand target by target, and its meshes one after the other within each.
void keep_deltas(Scene& scene, const std::vector<PlacedMesh>& placed)
{
    for (std::size_t first = 0, end = 0; first < placed.size(); first = end) {
        Node& node = scene.nodes[placed[first].node];
        for (end = first; end < placed.size() && placed[end].node == placed[first].node;) ++end;
        node.first_delta = static_cast<std::uint32_t>(scene.deltas.size());
        for (std::size_t t = 0; t < node.weights.size(); ++t) {
            for (std::size_t p = first; p < end; ++p) {
                const auto& deltas = placed[p].mesh->targets[t];
                scene.deltas.insert(scene.deltas.end(), deltas.begin(), deltas.end());
            }
        }
    }
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

// The largest texel of an emission texture, linear: some exporters write a factor of 1 with a black texture.
glm::vec3 largest_texel(const Image& image)
{
    std::array<std::uint8_t, 3> largest{};
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        for (std::size_t c = 0; c < 3; ++c) largest[c] = std::max(largest[c], image.rgba[i + c]);
    }
    return {linear_from_srgb(largest[0] / 255.0), linear_from_srgb(largest[1] / 255.0),
            linear_from_srgb(largest[2] / 255.0)};
}

// Whether a drawn surface shines. Notes those whose radiance the chapters cannot keep.
bool find_emitters(Scene& scene)
{
    constexpr float largest_half = 65504.0f;
    std::vector<std::uint8_t> used(scene.materials.size(), 0);
    for (const Draw& draw : scene.draws) used[static_cast<std::size_t>(draw.material)] = 1;
    bool found = false;
    for (std::size_t m = 0; m < used.size(); ++m) {
        const Material& material = scene.materials[m];
        glm::vec3 radiance = material.emission;
        if (!used[m] || radiance == glm::vec3(0.0f)) continue;
        if (material.emission_texture.present()) {
            radiance *= largest_texel(scene.images[static_cast<std::size_t>(material.emission_texture.image)]);
        }
        const float largest = std::max({radiance.r, radiance.g, radiance.b});
        found = found || largest > 0.0f;
        if (largest <= largest_half) continue;
        std::array<char, 32> number;
        std::snprintf(number.data(), number.size(), "%.3g", static_cast<double>(largest));
        warn(scene.warnings, "materials[" + std::to_string(m) + "] '" + material.name + "' emits a radiance of " +
                                 number.data() +
                                 " W/(sr m^2); the chapters keep light in half floats, which end at 65504");
    }
    return found;
}

Scene read_scene(const std::filesystem::path& file)
{
    Scene scene;
    scene.name = file.stem().string();
    const Document document = read_document(file, scene.warnings);
    scene.nodes = read_nodes(document);
    scene.animations = read_animations(document, scene.nodes, scene.warnings);
    scene.skins = read_skins(document, scene.nodes, scene.warnings);
    if (!document.model.scenes.empty()) scene.extras = document.model.scenes[shown_scene(document)].extras_json_string;
    const Materials materials = read_materials(document, scene.warnings);
    check_size(document, scene.nodes);
    MeshLibrary library(document, materials, scene.warnings);
    const std::vector<PlacedMesh> placed = place_meshes(document, scene.nodes, library);

    check_skins(scene, placed, scene.warnings);
    mark_dynamic(scene);

    const std::vector<NodePose> rest = rest_pose(scene);
    const BoxWs box = bounding_box_ws(scene, rest, placed);
    scene.origin_ws = 0.5 * (box.min + box.max);
    scene.bounds = {glm::vec3(box.min - scene.origin_ws), glm::vec3(box.max - scene.origin_ws)};
    std::size_t vertices = 0, indices = 0;
    for (const PlacedMesh& place : placed) {
        vertices += place.mesh->vertices.size();
        indices += place.mesh->indices.size();
    }
    scene.vertices.reserve(vertices);
    scene.indices.reserve(indices);
    for (const PlacedMesh& place : placed) append(scene, rest, place);
    keep_deltas(scene, placed);

    scene.materials = materials.materials;
    scene.images = read_images(document, materials.images, scene.warnings);
    settle_blending(scene, materials);
    scene.cameras = read_cameras(document, scene.nodes, scene.origin_ws, scene.warnings);
    scene.lights = read_lights(document, scene.nodes, scene.origin_ws, scene.warnings);
    const bool has_emitter = find_emitters(scene);
    if (scene.lights.empty() && !has_emitter) {
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
