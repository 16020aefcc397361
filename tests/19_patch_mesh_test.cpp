// The patch mesh: edges that neighbours agree on, areas, normals and emission that are kept, both sides of a sheet.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "lit_patches.hpp"

namespace conebook {
namespace {

constexpr double kPiD = std::numbers::pi;

using Place = std::array<float, 3>;
Place place_of(const glm::vec3& p) { return {p.x, p.y, p.z}; }

std::map<std::pair<Place, Place>, int> edges_of(const PatchMesh& mesh)
{
    std::map<std::pair<Place, Place>, int> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            Place a = place_of(mesh.vertices[mesh.indices[i + k]].position);
            Place b = place_of(mesh.vertices[mesh.indices[i + (k + 1) % 3]].position);
            ++edges[a < b ? std::pair(a, b) : std::pair(b, a)];
        }
    return edges;
}

TEST(PatchMesh, EveryEdgeOfAClosedMeshHasTwoTriangles)
{
    for (const float max_edge : {1.0f, 0.31f, 0.17f}) {
        SceneBuilder b = room(0.5f);
        b.sphere({0.1f, 0, 0}, 0.4f, b.material(lambert(0.3f)), 6);
        b.triangle({-0.9f, -0.9f, 0}, {0.9f, -0.8f, 0.1f}, {-0.8f, 0.7f, 0.3f}, 0);
        const PatchMesh mesh = subdivide(b.build(), {max_edge});
        double border_m = 0.0;
        for (const auto& [edge, count] : edges_of(mesh)) {
            const glm::vec3 a(edge.first[0], edge.first[1], edge.first[2]);
            const glm::vec3 c(edge.second[0], edge.second[1], edge.second[2]);
            EXPECT_LE(glm::length(a - c), 1.000001f * max_edge);
            ASSERT_LE(count, 2);
            if (count == 1) border_m += double(glm::length(a - c));
        }
        // Open is the lone triangle alone: its edges, however often halved.
        const glm::vec3 a(-0.9f, -0.9f, 0), c(0.9f, -0.8f, 0.1f), d(-0.8f, 0.7f, 0.3f);
        EXPECT_NEAR(border_m, double(glm::length(a - c) + glm::length(c - d) + glm::length(d - a)), 1e-5);
    }
}

TEST(PatchMesh, AreaNormalsAndMaterialsAreKept)
{
    SceneBuilder b = room(0.5f);
    b.sphere({0.1f, 0, 0}, 0.4f, b.material(emitter(2.0f, 0.3f)), 6);
    const Scene scene = b.build();
    const PatchMesh mesh = subdivide(scene, {0.13f});
    ASSERT_EQ(mesh.draws.size(), scene.draws.size());
    double whole = 0.0, emitted = 0.0;
    for (std::size_t d = 0; d < mesh.draws.size(); ++d) {
        const auto area = [](const auto& of, const Draw& draw) {
            double sum = 0.0;
            for (std::size_t i = draw.first_index; i < draw.first_index + draw.index_count; i += 3) {
                const auto p = [&](std::size_t k) { return glm::dvec3(of.vertices[of.indices[i + k]].position); };
                sum += 0.5 * glm::length(glm::cross(p(1) - p(0), p(2) - p(0)));
            }
            return sum;
        };
        EXPECT_EQ(mesh.draws[d].material, scene.draws[d].material);
        const double before = area(scene, scene.draws[d]);
        EXPECT_NEAR(area(mesh, mesh.draws[d]), before, 1e-6 * before);
        whole += before;
        if (d == 1) emitted = 2.0 * kPiD * before;
    }
    EXPECT_NEAR(mesh.area(), whole, 1e-5 * whole);
    double flux = 0.0;
    for (const glm::vec3& e : mesh.emitted) flux += double(e.x);
    EXPECT_NEAR(flux, emitted, 1e-5 * emitted);  // pi Le A
    for (const Vertex& v : mesh.vertices) ASSERT_NEAR(glm::length(v.normal), 1.0f, 1e-5f);
    // The walls' normals are those of the walls: no vertex is shared over an edge of the room.
    for (std::size_t i = mesh.draws[0].first_index; i < mesh.draws[0].index_count; i += 3) {
        const auto v = [&](std::size_t k) { return mesh.vertices[mesh.indices[i + k]]; };
        const glm::vec3 n = glm::cross(v(1).position - v(0).position, v(2).position - v(0).position);
        for (std::size_t k = 0; k < 3; ++k) ASSERT_GT(glm::dot(glm::normalize(n), v(k).normal), 0.9999f);
    }
}

TEST(PatchMesh, BothSidesOfASheetArePatches)
{
    Material sheet = lambert(0.5f);
    sheet.double_sided = true;
    SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(sheet));
    b.point_light({0, -1, 0}, glm::vec3(1.0f));
    const Lit lit(b.build(), with(0.5f, 0));
    const PatchMesh& mesh = lit.radiosity.mesh();
    ASSERT_EQ(mesh.patches.size(), 2 * mesh.vertices.size());
    EXPECT_NEAR(mesh.area(), 8.0, 1e-5);
    const auto e = lit.direct();
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        EXPECT_EQ(e[i].x, 0.0f);
        // E = I cos / d^2 from below, where the back is.
        const glm::dvec3 p(mesh.patches[i].position);
        EXPECT_NEAR(e[i + mesh.vertices.size()].x, std::pow(1.0 + glm::dot(p, p), -1.5), 1e-4);
    }
}

}  // namespace
}  // namespace conebook
