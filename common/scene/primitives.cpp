#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "scene/parts.hpp"

namespace conebook::gltf {
namespace {

bool is_finite(glm::dvec4 v)
{
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z) && std::isfinite(v.w);
}

// The primitive's index list as written, or 0, 1, 2, ... without one. Every index is below vertex_count.
std::vector<std::uint32_t> read_indices(const Document& document, const tinygltf::Primitive& primitive,
                                        std::size_t vertex_count, const std::string& where)
{
    std::vector<std::uint32_t> indices;
    if (primitive.indices < 0) {
        indices.resize(vertex_count);
        std::iota(indices.begin(), indices.end(), 0u);
        return indices;
    }
    const AccessorReader reader(document, primitive.indices, where + ".indices");
    if (!reader.is_unsigned_integer() || reader.components() != 1) {
        fail(where + ".indices are not unsigned integer scalars");
    }
    indices.resize(reader.count());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        indices[i] = reader.unsigned_element(i);
        if (indices[i] < vertex_count && indices[i] != reader.largest_unsigned()) continue;
        fail(where + ".indices: index " + std::to_string(indices[i]) +
             (indices[i] == reader.largest_unsigned() ? " is the primitive restart value, which glTF does not allow"
                                                      : " of " + std::to_string(vertex_count) + " vertices"));
    }
    return indices;
}

// glTF 2.0, 3.7.2.1: strips turn every second triangle, fans share their first vertex.
std::vector<std::uint32_t> to_triangle_list(std::vector<std::uint32_t> in, int mode, const std::string& where)
{
    if (mode == TINYGLTF_MODE_TRIANGLES) {
        if (in.size() % 3 != 0) {
            fail(where + " is a triangle list of " + std::to_string(in.size()) + " corners, not a multiple of 3");
        }
        return in;
    }
    std::vector<std::uint32_t> out;
    if (in.size() < 3) return out;
    out.reserve((in.size() - 2) * 3);
    for (std::size_t i = 0; i + 2 < in.size(); ++i) {
        std::array<std::uint32_t, 3> t;
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            t = {in[i + 1], in[i + 2], in[0]};
        } else {
            t = {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]};
        }
        // Strips are joined by triangles with a repeated corner; they are not part of the surface.
        if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) out.insert(out.end(), t.begin(), t.end());
    }
    return out;
}

class PrimitiveReader {
public:
    PrimitiveReader(const Document& document, const tinygltf::Primitive& primitive, std::string where,
                    Warnings& warnings)
        : document_(document), primitive_(primitive), where_(std::move(where)), warnings_(warnings)
    {
    }

    LocalMesh read(int material_index, const Materials& materials);

private:
    // Empty when the primitive has no such attribute. Throws when its shape is wrong.
    std::optional<AccessorReader> attribute(const std::string& name, int fewest, int most) const;
    void read_uv(glm::vec2 Vertex::*member, int set, bool is_used, const std::vector<std::uint32_t>& used,
                 std::vector<Vertex>& vertices) const;
    void read_tangents(const AccessorReader& reader, const std::vector<std::uint32_t>& used, LocalMesh& mesh) const;
    void read_joints(LocalMesh& mesh) const;
    void read_targets(LocalMesh& mesh) const;

    const Document& document_;
    const tinygltf::Primitive& primitive_;
    std::string where_;
    Warnings& warnings_;
    std::size_t vertex_count_ = 0;
};

std::optional<AccessorReader> PrimitiveReader::attribute(const std::string& name, int fewest, int most) const
{
    const auto found = primitive_.attributes.find(name);
    if (found == primitive_.attributes.end()) return std::nullopt;
    AccessorReader reader(document_, found->second, where_ + "." + name);
    if (reader.components() < fewest || reader.components() > most) {
        fail(where_ + "." + name + " has " + std::to_string(reader.components()) + " components");
    }
    if (name != "POSITION" && reader.count() != vertex_count_) {
        fail(where_ + "." + name + " has " + std::to_string(reader.count()) + " elements for " +
             std::to_string(vertex_count_) + " vertices");
    }
    return reader;
}

void PrimitiveReader::read_uv(glm::vec2 Vertex::*member, int set, bool is_used, const std::vector<std::uint32_t>& used,
                              std::vector<Vertex>& vertices) const
{
    const std::string name = "TEXCOORD_" + std::to_string(set);
    const auto reader = attribute(name, 2, 2);
    if (!reader) {
        if (is_used) warn(warnings_, where_ + " has no " + name + ", which its material uses; (0, 0) is used");
        return;
    }
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        glm::dvec4 uv = reader->element(used[i]);
        if (!is_finite(uv)) {
            warn(warnings_, where_ + " has texture coordinates that are not finite; (0, 0) is used");
            uv = glm::dvec4(0.0);
        }
        vertices[i].*member = glm::vec2(uv);
    }
}

void PrimitiveReader::read_tangents(const AccessorReader& reader, const std::vector<std::uint32_t>& used,
                                    LocalMesh& mesh) const
{
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        Vertex& vertex = mesh.vertices[i];
        const glm::dvec4 source = reader.element(used[i]);
        const glm::dvec3 normal = vertex.normal;
        // Perpendicular to the normal, whatever the file's rounding.
        glm::dvec3 tangent = glm::dvec3(source) - normal * glm::dot(normal, glm::dvec3(source));
        if (!is_finite(source) || !(glm::length(tangent) > 1e-6)) {
            warn(warnings_, where_ + " has tangents without a direction; any perpendicular is used");
            tangent = perpendicular(vertex.normal);
        }
        vertex.tangent = glm::vec4(glm::normalize(tangent), source.w < 0.0 ? -1.0f : 1.0f);
    }
}

void PrimitiveReader::read_joints(LocalMesh& mesh) const
{
    const auto joints = attribute("JOINTS_0", 4, 4), weights = attribute("WEIGHTS_0", 4, 4);
    if (!joints || !weights) return;
    if (!joints->is_unsigned_integer()) fail(where_ + ".JOINTS_0 is not of unsigned integers");
    if (primitive_.attributes.contains("JOINTS_1")) {
        warn(warnings_, where_ + " has more than four joints a vertex; the first four are used");
    }
    for (const std::uint32_t source : mesh.source) {
        const glm::dvec4 joint = joints->element(source);
        glm::dvec4 weight = weights->element(source);
        const double sum = weight.x + weight.y + weight.z + weight.w;
        if (!is_finite(weight) || !(sum > 0.0)) {
            warn(warnings_, where_ + " has vertices without weights of joints; they follow the first joint");
            weight = {1.0, 0.0, 0.0, 0.0};
        } else {
            weight /= sum;
        }
        mesh.joints.emplace_back(joint);
        mesh.joint_weights.emplace_back(weight);
    }
}

void PrimitiveReader::read_targets(LocalMesh& mesh) const
{
    for (std::size_t t = 0; t < primitive_.targets.size(); ++t) {
        auto& deltas = mesh.targets.emplace_back(mesh.source.size());
        for (const auto& [name, accessor] : primitive_.targets[t]) {
            glm::vec3 MorphDelta::*member = name == "POSITION"  ? &MorphDelta::position
                                            : name == "NORMAL"  ? &MorphDelta::normal
                                            : name == "TANGENT" ? &MorphDelta::tangent
                                                                : nullptr;
            if (member == nullptr) continue;
            const std::string what = where_ + ".targets[" + std::to_string(t) + "]." + name;
            const AccessorReader reader(document_, accessor, what);
            if (reader.components() != 3 || reader.count() != vertex_count_) {
                fail(what + " does not have a vector for each of " + std::to_string(vertex_count_) + " vertices");
            }
            for (std::size_t i = 0; i < deltas.size(); ++i) {
                const glm::dvec4 delta = reader.element(mesh.source[i]);
                if (!is_finite(delta)) fail(what + " is not finite");
                deltas[i].*member = glm::vec3(delta);
            }
        }
    }
}

LocalMesh PrimitiveReader::read(int material_index, const Materials& materials)
{
    LocalMesh mesh;
    mesh.material = material_index;
    if (primitive_.mode < TINYGLTF_MODE_TRIANGLES) {
        warn(warnings_, where_ + " is made of points or lines and is left out");
        return mesh;
    }
    const auto positions = attribute("POSITION", 3, 3);
    if (!positions) fail(where_ + " has no POSITION");
    vertex_count_ = positions->count();
    mesh.indices =
        to_triangle_list(read_indices(document_, primitive_, vertex_count_, where_), primitive_.mode, where_);
    if (mesh.indices.empty()) return mesh;

    // Many exporters share one vertex array among all primitives: keep the vertices that this one uses.
    std::vector<std::uint32_t> used = mesh.indices;
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (std::uint32_t& index : mesh.indices) {
        index = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), index) - used.begin());
    }
    mesh.source = used;
    mesh.vertices.resize(used.size(), Vertex{{}, {}, {1, 0, 0, 1}, {}, {}, glm::vec4(1.0f)});
    for (std::size_t i = 0; i < used.size(); ++i) {
        const glm::dvec4 position = positions->element(used[i]);
        if (!is_finite(position)) {
            fail(where_ + ".POSITION of vertex " + std::to_string(used[i]) + " is not finite");
        }
        mesh.vertices[i].position = glm::vec3(position);
    }

    const auto material_at = static_cast<std::size_t>(material_index);
    const Material& material = materials.materials.at(material_at);
    std::array<bool, 2> uses_uv{};
    for (const TextureSlot* slot :
         {&material.base_color_texture, &material.metallic_roughness_texture, &material.normal_texture,
          &material.emission_texture, &material.specular_texture, &material.specular_color_texture}) {
        if (slot->present()) uses_uv[static_cast<std::size_t>(slot->uv_set)] = true;
    }
    const auto& sets = materials.readings.at(material_at).uv_sets;
    read_uv(&Vertex::uv0, sets[0], uses_uv[0], used, mesh.vertices);
    read_uv(&Vertex::uv1, sets[1], uses_uv[1], used, mesh.vertices);

    if (const auto colors = attribute("COLOR_0", 3, 4)) {
        for (std::size_t i = 0; i < used.size(); ++i) {
            glm::dvec4 color = colors->element(used[i]);
            if (colors->components() == 3) color.w = 1.0;
            if (!is_finite(color)) fail(where_ + ".COLOR_0 is not finite");
            const glm::dvec4 limited = glm::clamp(color, 0.0, 1.0);
            if (limited != color) warn(warnings_, where_ + " has vertex colours outside 0..1, which are clamped");
            mesh.vertices[i].color = glm::vec4(limited);
        }
    }

    const auto normals = attribute("NORMAL", 3, 3);
    if (normals) {
        for (std::size_t i = 0; i < used.size(); ++i) mesh.vertices[i].normal = glm::vec3(normals->element(used[i]));
        const NormalRepair repair = repair_normals(mesh.vertices, mesh.indices);
        if (repair.replaced > 0) {
            warn(warnings_, where_ + ": " + std::to_string(repair.replaced) +
                                " normals are zero or not finite and were computed from the faces");
        }
        if (repair.off_length > 0) {
            warn(warnings_, where_ + " has normals that are not of unit length; they were normalised");
        }
    } else {
        make_flat_normals(mesh);
    }

    // glTF 2.0, 3.7.2.1: without normals, given tangents are ignored too.
    const auto tangents = normals ? attribute("TANGENT", 4, 4) : std::nullopt;
    if (tangents) {
        read_tangents(*tangents, used, mesh);
    } else if (material.normal_texture.present()) {
        make_tangents(mesh, material.normal_texture);
    } else {
        for (Vertex& vertex : mesh.vertices) vertex.tangent = glm::vec4(perpendicular(vertex.normal), 1.0f);
    }
    read_joints(mesh);
    read_targets(mesh);
    return mesh;
}

}  // namespace

LocalMesh read_primitive(const Document& document, int mesh, std::size_t primitive, int material,
                         const Materials& materials, Warnings& warnings)
{
    const auto& source = document.model.meshes.at(static_cast<std::size_t>(mesh));
    const std::string where = "meshes[" + std::to_string(mesh) + "]" +
                              (source.name.empty() ? "" : " '" + source.name + "'") + ".primitives[" +
                              std::to_string(primitive) + "]";
    return PrimitiveReader(document, source.primitives.at(primitive), where, warnings).read(material, materials);
}

}  // namespace conebook::gltf
