// The six directional pyramids of light: the one doorway to them, however they are stored. Taught in chapter 07.
//
// A texel for each of the six sides `face` of the voxels of every level, rgba16f:
//   a    A: share of the voxel's cross-section that surfaces facing `face` cover, 0..1
//   rgb  A L: their mean radiance L, W/(sr m^2), premultiplied with the coverage
// rgb is kept in units of light_scale: in eight bits the largest radiance, in floats a power of two that brings it
// below the largest half float, 1 where it is there already. With SPLIT_COVERAGE, where the format has no room for A,
// a texture of its own holds it. What surfaces emit may have one of its own too (chapter 11): A Le in rgb, in units of
// emission_scale.
//
//   light_of, emission_of              a voxel's own
//   light_at, coverage_at, emission_at between the middles of voxels; p in voxels of the level, half a voxel inside its sides
//   stored_place, is_stored            where store_light.glsl writes, and whether there is a place
#include "common/voxel_grid.glsl"

layout(std140, binding = kPyramidBlock) uniform PyramidBlock { float light_scale; };  // W/(sr m^2)
layout(std140, binding = kEmissionPyramidBlock) uniform EmissionPyramidBlock { float emission_scale; };  // W/(sr m^2)
#ifdef SPLIT_COVERAGE
const int kTexelsPerFetch = 2;  // for those who count
#else
const int kTexelsPerFetch = 1;
#endif

ivec3 level_size(int level) { return grid.size.xyz >> level; }
// Six volumes side by side along x.
ivec3 atlas_texel(int face, ivec3 voxel, int level) { return ivec3(face * level_size(level).x, 0, 0) + voxel; }
vec3 atlas_place(int face, vec3 p, int level)
{
    vec3 size = vec3(level_size(level));
    return vec3((p.x / size.x + float(face)) / 6.0, p.yz / size.yz);
}

#ifdef LIGHT_STORAGE
#include LIGHT_STORAGE
#else
#include "07_anisotropic_mips/light_atlas.glsl"
#endif

// The nearest half-float values. What imageStore does is left to the driver (OpenGL 4.6, 2.3.4.2); some cut off, and
// a bias of half a unit a level would add up.
vec4 nearest_half(vec4 v) { return vec4(unpackHalf2x16(packHalf2x16(v.xy)), unpackHalf2x16(packHalf2x16(v.zw))); }
