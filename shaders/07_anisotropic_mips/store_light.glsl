// Writing a texel of the pyramids in the format that they are kept in. FORMAT: 0 rgba16f, 1 rgba8, 2 r11g11b10f and r8.
#include "07_anisotropic_mips/pyramid.glsl"

#if FORMAT == 0
layout(rgba16f, binding = 0) writeonly uniform STORED_IMAGE light;
const float kLargestStored = 65504.0;
#elif FORMAT == 1
layout(rgba8, binding = 0) writeonly uniform STORED_IMAGE light;
const float kLargestStored = 1.0;
#else
layout(r11f_g11f_b10f, binding = 0) writeonly uniform STORED_IMAGE light;
layout(r8, binding = 1) writeonly uniform STORED_IMAGE coverage;
const float kLargestStored = 64512.0;
#endif

// What imageStore does is left to the driver (OpenGL 4.6, 2.3.4.2); some cut off, and a bias of half a unit a level
// would add up. So values are rounded to the nearest ones that the format holds, before. The nearest float with 11 -
// `lost` bits: half floats and the shorter ones have the same five bits of exponent.
float nearest_short(float v, uint lost)
{
    uint bits = packHalf2x16(vec2(v, 0.0));
    return unpackHalf2x16((bits + (1u << lost >> 1)) >> lost << lost).x;
}
// snippet: store_texel
void store_texel(int face, ivec3 voxel, int level, vec4 stored)
{
    STORED_PLACE place = stored_place(face, voxel, level);
    if (!is_stored(place)) return;
    vec4 v = min(stored, vec4(kLargestStored));
#if FORMAT == 0
    imageStore(light, place, nearest_half(v));
#elif FORMAT == 1
    imageStore(light, place, round(v * 255.0) / 255.0);
#else
    imageStore(light, place, vec4(nearest_short(v.r, 4u), nearest_short(v.g, 4u), nearest_short(v.b, 5u), 0.0));
    imageStore(coverage, place, vec4(round(v.a * 255.0) / 255.0));
#endif
}
// end snippet
