// Where the shadow maps of a light are, as C++ writes it and GLSL reads it.
#ifdef __cplusplus
#pragma once
#endif
#include "common/cpp_glsl.glsl"

CONEBOOK_SHARED_BEGIN

CONEBOOK_CONSTANT int kShadowMapUnit = 14;

// One map: a directional or spot light has one, a point light six in a row (+x -x +y -y +z -z).
struct ShadowLayer {
    mat4 clip_from_scene;  // depth 1 near, 0 far
    ivec4 place;           // where it lies: xy its corner, texels; z layer of the array; w its side, texels
};

// Of a light: x: first map, y: number of maps, zw unused.
struct ShadowLight {
    ivec4 layers;
};

CONEBOOK_SHARED_END
