// The scene in small triangles whose vertices are the patches that light is exchanged between.
#pragma once

#include <vector>

#include "19_vertex_radiosity/patch_structs.glsl"
#include "app/parameters.hpp"
#include "scene/scene.hpp"

namespace conebook {

struct PatchMeshParams {
    // Longest edge of a triangle, m, 0 .. 1e6: light that changes within it is lost. 0: a 16th of the scene's longest
    // side.
    float max_edge = 0.0f;
};
void add_parameters(ParameterTable& table, PatchMeshParams& params);

// Vertex i is patch i. Where some material has two sides, patch back_offset() + i is the other side of vertex i;
// without one there are no such patches. Vertices at one place that differ in normal, material or texture coordinates
// are several patches: light has an edge there, or they just have the same.
struct PatchMesh {
    std::vector<Vertex> vertices;        // scene space
    std::vector<std::uint32_t> indices;  // triangle list, wound as in the scene
    std::vector<Draw> draws;             // first_index, index_count and material of each of the scene's draws
    std::vector<shared::Patch> patches;  // area 0: nothing is lit there
    std::vector<glm::vec3> emitted;      // by each patch, W
    bool has_two_sides = false;
    float max_edge = 0.0f;  // m

    int back_offset() const { return has_two_sides ? int(vertices.size()) : 0; }
    double area() const;  // of all patches, m^2
};

// Halves every edge longer than max_edge until there is none. Whether an edge is halved depends on its ends alone, so
// triangles that share one agree on it and no vertex lies on another triangle's edge: where the scene has no such
// T-junctions, neither has the result. Throws std::runtime_error when there would be more than kMostPatches.
PatchMesh subdivide(const Scene& scene, const PatchMeshParams& params);
constexpr std::size_t kMostPatches = std::size_t(1) << 21;

}  // namespace conebook
