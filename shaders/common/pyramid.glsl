// The six directional pyramids: layout and weights. Taught in chapter 07.
//
// One atlas, rgba16f, holds the six side by side along x, for every level: texel (face * size.x + x, y, z).
//   a    A: share of the voxel's cross-section that surfaces facing `face` cover, 0..1
//   rgb  A L: their mean radiance L, W/(sr m^2), premultiplied with the coverage
// In eight bits rgb is a share of light_scale; with SPLIT_COVERAGE, where the format has no room for A, an atlas of its
// own holds it.
#include "common/voxel_grid.glsl"

layout(binding = kLightAtlasUnit) uniform sampler3D light_atlas;
// W/(sr m^2), 1 for formats that need none.
layout(std140, binding = kPyramidBlock) uniform PyramidBlock { float light_scale; };
#ifdef SPLIT_COVERAGE
const int kFetchesPerTexel = 2;
layout(binding = kCoverageAtlasUnit) uniform sampler3D coverage_atlas;
vec4 stored_texel(ivec3 texel, int level)
{
    return vec4(texelFetch(light_atlas, texel, level).rgb, texelFetch(coverage_atlas, texel, level).r);
}
vec4 stored_light(vec3 uvw, float level)
{
    return vec4(textureLod(light_atlas, uvw, level).rgb, textureLod(coverage_atlas, uvw, level).r);
}
float stored_coverage(vec3 uvw, float level) { return textureLod(coverage_atlas, uvw, level).r; }
#else
const int kFetchesPerTexel = 1;
vec4 stored_texel(ivec3 texel, int level) { return texelFetch(light_atlas, texel, level); }
vec4 stored_light(vec3 uvw, float level) { return textureLod(light_atlas, uvw, level); }
float stored_coverage(vec3 uvw, float level) { return textureLod(light_atlas, uvw, level).a; }
#endif

ivec3 level_size(int level) { return grid.size.xyz >> level; }
ivec3 atlas_texel(int face, ivec3 voxel, int level) { return ivec3(face * level_size(level).x, 0, 0) + voxel; }

// Share of the voxel's length along `axis` that lies within the scene's bounds. Beyond them nothing is known, so what is
// outside is left out of averages instead of being counted as empty: a wall that ends at the bounds stays whole.
float inside_share(ivec3 voxel, int axis, int level)
{
    float size = float(1 << level), low = float(voxel[axis]) * size;
    float inside = min(low + size, grid.content_max[axis]) - max(low, grid.content_min[axis]);
    return clamp(inside / size, 1e-6, 1.0);
}

// Weight of a column of voxels along the face's axis in the mean over its cross-section.
float column_weight(ivec3 voxel, int face, int level)
{
    int axis = face >> 1;
    return inside_share(voxel, (axis + 1) % 3, level) * inside_share(voxel, (axis + 2) % 3, level);
}

// The nearest half-float values. What imageStore does is left to the driver (OpenGL 4.6, 2.3.4.2); some cut off, and
// a bias of half a unit a level would add up.
vec4 nearest_half(vec4 v) { return vec4(unpackHalf2x16(packHalf2x16(v.xy)), unpackHalf2x16(packHalf2x16(v.zw))); }
