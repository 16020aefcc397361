// What emits in a scene, taken from its triangles: exactly, and in parts to aim at.
#pragma once

#include <vector>

#include "common/voxel_structs.glsl"
#include "scene/scene.hpp"

namespace conebook {

struct EmitterParts {
    // All emitting triangles, both sides of those that have two; empty where a texture varies the radiance of any, or where
    // they are more than kMostTriangles.
    std::vector<shared::EmitterTriangle> triangles;
    static constexpr std::size_t kMostTriangles = 64;
    // Parts of equal power: first `aimed` ones to aim at, one after the other to the `sets`, each set's parts behind each other,
    // so that each set has parts of all emitters; then kEvenParts that stand for emitters without `triangles`.
    std::vector<shared::EmitterPart> parts;
    static constexpr int kEvenParts = 512;
    // Of all area, the share that emits, weighted with radiance: (sum of power)^2 / sum of power times radiance.
    double emitting_share = 0.0;
};

// In the space of `grid`; all empty where nothing shines. Textures are averaged in linear light over pieces of about a voxel.
// What lies right in front of a part, where voxels cannot tell, is found by rays against the triangles themselves: see
// EmitterPart::normal. Throws std::runtime_error when Embree fails.
EmitterParts make_emitter_parts(const Scene& scene, const shared::GridData& grid, int aimed, int sets);

}  // namespace conebook
