// The scene cut into patches: its triangles, bisected until they are small enough.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "scene/scene.hpp"

namespace conebook {

// A triangle of the mesh. One that was bisected has two children, nodes[child] and nodes[child + 1].
struct PatchNode {
    std::array<std::uint32_t, 3> corners;  // BisectedMesh::points, counter-clockwise from the front
    std::array<glm::vec2, 3> uv;           // of each corner: barycentrics (u, v) in the triangle of the scene
    std::uint32_t triangle = 0;            // of the scene, in the order of Scene::indices
    std::int32_t child = -1, parent = -1;
    std::uint8_t apex = 0;  // the corner opposite to the edge that was bisected
};

// A leaf of the mesh and a place on it: weights of its corners.
struct PatchPlace {
    std::uint32_t node = 0;
    glm::vec3 weights{0.0f};
};

// Longest-edge bisection (Rivara 1984, "Algorithms for refining triangular grids suitable for adaptive and multigrid
// techniques"): an edge is bisected in all triangles that share it at once, and only when it is the longest of
// each. So the mesh has no corner in the middle of an edge, and no angle is under half the least angle of the
// scene's triangles.
class BisectedMesh {
public:
    explicit BisectedMesh(const Scene& scene);

    // Bisects the leaf of the largest key, again and again, while there are fewer than `leaves` of them and the key
    // is above `enough`. A key must not grow from a leaf to its children.
    void refine(std::size_t leaves, double enough, const std::function<double(std::uint32_t)>& key);

    // The leaf below a point of a triangle of the scene. A bisection halves barycentrics: no place is lost to
    // rounding.
    PatchPlace find(std::uint32_t triangle, glm::vec2 uv) const;

    const std::vector<glm::vec3>& points() const { return points_; }  // scene space, equal positions are one point
    const std::vector<PatchNode>& nodes() const { return nodes_; }    // the scene's triangles first
    std::vector<std::uint32_t> leaves() const;
    std::size_t leaf_count() const { return leaf_count_; }
    double longest_edge(std::uint32_t node) const;  // m
    double area(std::uint32_t node) const;          // m^2
    // The leaves at the edge between corners k + 1 and k + 2 of a leaf, itself among them.
    const std::vector<std::uint32_t>& at_edge(std::uint32_t node, int k) const;

private:
    // A total order of edges, the same seen from each triangle: by length, then by name.
    struct Edge {
        double length2 = 0.0;
        std::uint64_t name = 0;
        auto operator<=>(const Edge&) const = default;
    };
    Edge edge(std::uint32_t node, int k) const;
    int longest(std::uint32_t node) const;
    void enter(std::uint32_t node);
    void leave(std::uint32_t node);
    bool bisect(std::uint32_t node, std::vector<std::uint32_t>& made);

    std::vector<glm::vec3> points_;
    std::vector<PatchNode> nodes_;
    std::size_t leaf_count_ = 0;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> leaves_at_edge_;
    std::unordered_map<std::uint64_t, std::uint32_t> middles_;  // points of bisected edges
};

}  // namespace conebook
