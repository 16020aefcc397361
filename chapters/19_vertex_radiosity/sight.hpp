// Which patch sees which light: a ray for each pair (Embree), one bit kept of it.
#pragma once

#include <vector>

#include "19_vertex_radiosity/patch_structs.glsl"
#include "reference/scene_tracer.hpp"

namespace conebook {

// Bit (light & 31) of word (light / 32) * patches.size() + patch. Patches without area see nothing, and nobody sees a light
// below his horizon or from below the light's own. On all cores; the bits do not depend on their number.
std::vector<std::uint32_t> sight_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                    const std::vector<Light>& lights);
std::vector<std::uint32_t> sight_of(const SceneTracer& tracer, const std::vector<shared::Patch>& patches,
                                    const std::vector<shared::PatchLight>& lights);

}  // namespace conebook
