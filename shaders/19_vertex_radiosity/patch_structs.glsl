// Patches and the lights that some of them become, as C++ writes them and GLSL reads them.
#ifdef __cplusplus
#pragma once
#endif
#include "common/cpp_glsl.glsl"

CONEBOOK_SHARED_BEGIN

// One side of one vertex of the subdivided scene.
struct Patch {
    vec4 position;  // xyz: scene space, the middle of its area; w: area, a third of the triangles round the vertex, m^2
    vec4 normal;    // xyz: unit, of the side
};

// A small disc that reflects or emits light, with radiance flux / (pi area) in every direction.
struct PatchLight {
    vec4 position;  // xyz: scene space; w: area, m^2
    vec4 normal;    // xyz: unit
    vec4 flux;      // rgb: what it sends into its hemisphere, W
};

CONEBOOK_SHARED_END
