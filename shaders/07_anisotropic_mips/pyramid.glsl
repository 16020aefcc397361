// The six directional pyramids of light: the one place that knows how they are stored. Taught in chapter 07.
//
// One atlas, rgba16f, holds the six side by side along x, for every level: texel (face * size.x + x, y, z).
//   a    A: share of the voxel's cross-section that surfaces facing `face` cover, 0..1
//   rgb  A L: their mean radiance L, W/(sr m^2), premultiplied with the coverage
// rgb is kept in units of light_scale: in eight bits the largest radiance, in floats a power of two that brings it
// below the largest half float, 1 where it is there already. With SPLIT_COVERAGE, where the format has no room for A,
// an atlas of its own holds it. What surfaces emit may have an atlas of its own too (chapter 11): A Le in rgb, in units
// of emission_scale.
#include "common/voxel_grid.glsl"

layout(binding = kLightAtlasUnit) uniform sampler3D light_atlas;
layout(binding = kEmissionAtlasUnit) uniform sampler3D emission_atlas;
layout(std140, binding = kPyramidBlock) uniform PyramidBlock { float light_scale; };  // W/(sr m^2)
layout(std140, binding = kEmissionPyramidBlock) uniform EmissionPyramidBlock { float emission_scale; };  // W/(sr m^2)
#ifdef SPLIT_COVERAGE
const int kTexelsPerFetch = 2;  // for those who count
layout(binding = kCoverageAtlasUnit) uniform sampler3D coverage_atlas;
#define WITH_COVERAGE(fetch, place, level) vec4(fetch(light_atlas, place, level).rgb, fetch(coverage_atlas, place, level).r)
#define COVERAGE(fetch, place, level) fetch(coverage_atlas, place, level).r
#else
const int kTexelsPerFetch = 1;
#define WITH_COVERAGE(fetch, place, level) fetch(light_atlas, place, level)
#define COVERAGE(fetch, place, level) fetch(light_atlas, place, level).a
#endif

ivec3 level_size(int level) { return grid.size.xyz >> level; }
ivec3 atlas_texel(int face, ivec3 voxel, int level) { return ivec3(face * level_size(level).x, 0, 0) + voxel; }
vec3 atlas_place(int face, vec3 p, int level)
{
    vec3 size = vec3(level_size(level));
    return vec3((p.x / size.x + float(face)) / 6.0, p.yz / size.yz);
}

// A voxel's own, and between the middles of voxels; p in voxels of the level, half a voxel inside the level's sides.
vec4 light_of(int face, ivec3 voxel, int level) { return WITH_COVERAGE(texelFetch, atlas_texel(face, voxel, level), level); }
vec4 light_at(int face, vec3 p, int level) { return WITH_COVERAGE(textureLod, atlas_place(face, p, level), float(level)); }
float coverage_at(int face, vec3 p, int level) { return COVERAGE(textureLod, atlas_place(face, p, level), float(level)); }
vec3 emission_of(int face, ivec3 voxel, int level) 
{
    return emission_scale * texelFetch(emission_atlas, atlas_texel(face, voxel, level), level).rgb;
}
vec3 emission_at(int face, vec3 p, int level) 
{
    return emission_scale * textureLod(emission_atlas, atlas_place(face, p, level), float(level)).rgb;
}

// The nearest half-float values. What imageStore does is left to the driver (OpenGL 4.6, 2.3.4.2); some cut off, and
// a bias of half a unit a level would add up.
vec4 nearest_half(vec4 v) { return vec4(unpackHalf2x16(packHalf2x16(v.xy)), unpackHalf2x16(packHalf2x16(v.zw))); }
