// Which patch sees which light: a ray for each pair (Embree), one bit kept of it.
#pragma once

#include <span>
#include <vector>

#include "19_vertex_radiosity/patch_structs.glsl"
#include "reference/scene_tracer.hpp"

namespace conebook {

// Bit (light & 31) of word (light / 32) * patches.size() + patch. Patches without area see nothing, and nobody sees a
// light below his horizon or from below the light's own. On all cores; the bits do not depend on their number.
std::vector<std::uint32_t> sight_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                    const std::vector<Light>& lights);

// A light and where its parts are in the same list; part_count 0: it has none. Those of a root come right behind it.
struct LightNode {
    shared::PatchLight light;
    std::uint32_t first_part = 0, part_count = 0;
    bool is_root = true;
};

// Of a patch that is nearer to a light than `near` times the root of its area, the bits of the light's parts, asked
// in the same way, stand for the light's.
std::vector<std::uint32_t> sight_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                    std::span<const LightNode> lights, float near);

}  // namespace conebook
