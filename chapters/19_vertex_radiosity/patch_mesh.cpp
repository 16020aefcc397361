#include "19_vertex_radiosity/patch_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "reference/surface.hpp"

namespace conebook {
namespace {

using Corners = std::array<std::uint32_t, 3>;

constexpr float kShareOfScene = 1.0f / 16.0f;

// Vertices with the same bits are one.
class Weld {
public:
    explicit Weld(std::vector<Vertex>& vertices) : vertices_(vertices) {}
    std::uint32_t index_of(const Vertex& v)
    {
        const auto [entry, is_new] = found_.try_emplace(bits(v), std::uint32_t(vertices_.size()));
        if (is_new) vertices_.push_back(v);
        return entry->second;
    }

private:
    static std::string bits(const Vertex& v)
    {
        Vertex positive = v;  // -0 and 0 are the same place
        positive.position += 0.0f;
        positive.normal += 0.0f;
        return {reinterpret_cast<const char*>(&positive), sizeof positive};
    }
    std::vector<Vertex>& vertices_;
    std::unordered_map<std::string, std::uint32_t> found_;
};

Vertex middle(const Vertex& a, const Vertex& b)
{
    const auto unit = [](const glm::vec3& sum, const glm::vec3& otherwise) {
        const float length = glm::length(sum);
        return length > 1e-6f ? sum / length : otherwise;
    };
    Vertex m;
    m.position = 0.5f * (a.position + b.position);
    m.normal = unit(a.normal + b.normal, a.normal);
    m.tangent = glm::vec4(unit(glm::vec3(a.tangent) + glm::vec3(b.tangent), glm::vec3(a.tangent)), a.tangent.w);
    m.uv0 = 0.5f * (a.uv0 + b.uv0);
    m.uv1 = 0.5f * (a.uv1 + b.uv1);
    m.color = 0.5f * (a.color + b.color);
    return m;
}

// The triangles of one draw.
class Refinement {
public:
    Refinement(std::vector<Vertex>& vertices, float max_edge) : vertices_(vertices), longest_squared_(square(max_edge))
    {
    }

    void refine(std::vector<Corners>& triangles)
    {
        for (bool again = true; again;) {
            again = false;
            std::vector<Corners> finer;
            finer.reserve(triangles.size());
            for (const Corners& t : triangles) again = split(t, finer) || again;
            triangles.swap(finer);
        }
    }

private:
    static double square(double x) { return x * x; }
    double squared_length(std::uint32_t a, std::uint32_t b) const
    {
        const glm::dvec3 d = glm::dvec3(vertices_[a].position) - glm::dvec3(vertices_[b].position);
        return glm::dot(d, d);
    }

    // Adds what becomes of a triangle; says whether it was cut. The first corner is turned so that there are three cases.
    // snippet: split
    bool split(const Corners& t, std::vector<Corners>& out)
    {
        bool cut[3];
        for (int k = 0; k < 3; ++k) cut[k] = squared_length(t[k], t[(k + 1) % 3]) > longest_squared_;
        const int count = cut[0] + cut[1] + cut[2];
        if (count == 0) return out.push_back(t), false;
        int first = 0;  // count 1: the edge that is cut; 2: the first of the two
        while (count < 3 && !(cut[first] && (count == 1 || cut[(first + 1) % 3]))) ++first;
        const std::uint32_t a = t[first], b = t[(first + 1) % 3], c = t[(first + 2) % 3], ab = half(a, b);
        if (count == 1) return out.insert(out.end(), {Corners{a, ab, c}, {ab, b, c}}), true;
        const std::uint32_t bc = half(b, c);
        out.push_back({ab, b, bc});
        if (count == 3) return split_rest(a, ab, bc, c, half(c, a), out), true;
        if (squared_length(a, bc) <= squared_length(ab, c))
            out.insert(out.end(), {Corners{a, ab, bc}, {a, bc, c}});
        else
            out.insert(out.end(), {Corners{a, ab, c}, {ab, bc, c}});
        return true;
    }
    // end snippet

    static void split_rest(std::uint32_t a, std::uint32_t ab, std::uint32_t bc, std::uint32_t c, std::uint32_t ca,
                           std::vector<Corners>& out)
    {
        out.insert(out.end(), {Corners{a, ab, ca}, {ca, bc, c}, {ab, bc, ca}});
    }

    std::uint32_t half(std::uint32_t a, std::uint32_t b)
    {
        const std::uint64_t edge = std::uint64_t(std::min(a, b)) << 32 | std::max(a, b);
        const auto [entry, is_new] = middles_.try_emplace(edge, std::uint32_t(vertices_.size()));
        if (is_new) {
            if (vertices_.size() >= kMostPatches)
                throw std::runtime_error("max_edge=" + std::to_string(std::sqrt(longest_squared_)) +
                                         ": the scene would have more than " + std::to_string(kMostPatches) +
                                         " patches; use a larger one");
            vertices_.push_back(middle(vertices_[a], vertices_[b]));
        }
        return entry->second;
    }

    std::vector<Vertex>& vertices_;
    double longest_squared_;
    std::unordered_map<std::uint64_t, std::uint32_t> middles_;  // of edges
};

glm::vec3 cross_of(const PatchMesh& mesh, std::size_t first_index)
{
    const auto corner = [&](std::size_t k) { return mesh.vertices[mesh.indices[first_index + k]].position; };
    return glm::cross(corner(1) - corner(0), corner(2) - corner(0));
}

// Mean radiance of a triangle, W/(sr m^2): the material's texture at ten points of it, each the middle of its share.
glm::vec3 mean_emission(const Scene& scene, const Material& material, const PatchMesh& mesh, std::size_t first_index)
{
    const auto at = [&](std::size_t k) { return &mesh.vertices[mesh.indices[first_index + k]]; };
    constexpr int kGrid = 4;
    glm::vec3 sum(0.0f);
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; i + j < kGrid; ++j)
            sum += emitted_radiance(scene, material,
                                    {at(0), at(1), at(2), (i + 1 / 3.0f) / kGrid, (j + 1 / 3.0f) / kGrid});
    return sum / (kGrid * (kGrid + 1) / 2.0f);
}

// Light is computed in the middle of a patch: at its vertex, unless that is on an edge, where a point of the floor
// would be in the wall as well. A patch is of each of its triangles the third that is nearest to the vertex, the
// quadrangle over the middles of two edges and of the triangle; its centroid lies 7/12 of the way from the vertex to
// the triangle's.
constexpr float kWayToCenter = 7.0f / 12.0f;

void measure(const Scene& scene, PatchMesh& mesh)
{
    const std::size_t count = mesh.vertices.size();
    mesh.patches.assign(count * (mesh.has_two_sides ? 2 : 1), shared::Patch{});
    mesh.emitted.assign(mesh.patches.size(), glm::vec3(0.0f));
    std::vector<glm::vec3> moments(count, glm::vec3(0.0f));  // area times the middle, about the vertex, m^3
    for (const Draw& draw : mesh.draws) {
        const Material& material = scene.materials[std::size_t(draw.material)];
        const bool emits = material.shines();
        for (std::size_t i = draw.first_index; i < draw.first_index + draw.index_count; i += 3) {
            const float third = glm::length(cross_of(mesh, i)) / 6.0f;
            const glm::vec3 flux =
                emits ? std::numbers::pi_v<float> * third * mean_emission(scene, material, mesh, i) : glm::vec3(0.0f);
            glm::vec3 middle(0.0f);
            for (std::size_t k = 0; k < 3; ++k) middle += mesh.vertices[mesh.indices[i + k]].position / 3.0f;
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t id = mesh.indices[i + k];
                moments[id] += third * (middle - mesh.vertices[id].position);
                for (std::size_t side : {std::size_t(id), count + id}) {
                    if (side >= count && !material.double_sided) continue;
                    mesh.patches[side].position.w += third;
                    mesh.emitted[side] += flux;
                }
            }
        }
    }
    for (std::size_t side = 0; side < mesh.patches.size(); ++side) {
        shared::Patch& patch = mesh.patches[side];
        const Vertex& v = mesh.vertices[side % count];
        const glm::vec3 normal = side < count ? v.normal : -v.normal;
        glm::vec3 to_middle(0.0f);
        if (patch.position.w > 0.0f) to_middle = moments[side % count] / patch.position.w;
        // In the tangent plane, so as not to lie within what bulges; over it in a hollow, where the plane is behind
        // the surface.
        const float height = glm::dot(to_middle, normal);
        const glm::vec3 level = to_middle - height * normal;
        patch.position = glm::vec4(v.position + kWayToCenter * (height < 0.0f ? level : to_middle), patch.position.w);
        patch.normal = glm::vec4(normal, 0.0f);
    }
}

}  // namespace

void add_parameters(ParameterTable& table, PatchMeshParams& params)
{
    table.add("max_edge", params.max_edge, 0.0, 1e6, "m",
              "longest edge of a triangle; 0: a 16th of the scene's longest side");
}

double PatchMesh::area() const
{
    double sum = 0.0;
    for (const shared::Patch& patch : patches) sum += double(patch.position.w);
    return sum;
}

PatchMesh subdivide(const Scene& scene, const PatchMeshParams& params)
{
    PatchMesh mesh;
    mesh.max_edge = params.max_edge > 0.0f ? params.max_edge : kShareOfScene * scene.bounds.longest_side();
    for (const Draw& draw : scene.draws) {
        std::vector<Corners> triangles;
        Weld weld(mesh.vertices);
        for (std::uint32_t i = draw.first_index; i < draw.first_index + draw.index_count; i += 3) {
            Corners t;
            for (std::uint32_t k = 0; k < 3; ++k) t[k] = weld.index_of(scene.vertices[scene.indices[i + k]]);
            const auto corner = [&](int k) { return mesh.vertices[t[std::size_t(k)]].position; };
            if (glm::cross(corner(1) - corner(0), corner(2) - corner(0)) != glm::vec3(0.0f)) triangles.push_back(t);
        }
        Refinement(mesh.vertices, mesh.max_edge).refine(triangles);
        Draw refined = draw;
        refined.first_index = std::uint32_t(mesh.indices.size());
        refined.index_count = std::uint32_t(3 * triangles.size());
        for (const Corners& t : triangles) mesh.indices.insert(mesh.indices.end(), t.begin(), t.end());
        mesh.draws.push_back(std::move(refined));
        mesh.has_two_sides = mesh.has_two_sides || scene.materials[std::size_t(draw.material)].double_sided;
    }
    measure(scene, mesh);
    return mesh;
}

}  // namespace conebook
