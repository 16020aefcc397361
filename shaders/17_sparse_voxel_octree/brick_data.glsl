// What the passes that fill bricks share: one thread a brick of a level. FORMAT 0: rgba16f, 1: rgba32f.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "17_sparse_voxel_octree/bricks.glsl"

#if FORMAT == 0
layout(rgba16f, binding = 0) uniform image3D pool;
#else
layout(rgba32f, binding = 0) uniform image3D pool;
#endif
layout(std430, binding = kNodePlaceBinding) readonly buffer PlaceBuffer { uint node_places[]; };
// node << 3 | direction
layout(std430, binding = kBrickListBinding) readonly buffer BrickListBuffer { uint brick_list[]; };
// How much of what a sample stands for lies within the scene's bounds, along each axis: see weight_of().
layout(std430, binding = kTreeWeightBinding) readonly buffer WeightBuffer { float weights[]; };
uniform int level;
uniform uint first_brick, brick_count;  // of the level

// Along an axis: of voxel i (sampled = -1), or of sample i of the bricks whose samples are 2^sampled voxels apart.
float weight_of(int sampled, int axis, int i)
{
    int stride = (1 << tree_depth) + 1;
    return weights[((sampled + 1) * 3 + axis) * stride + i];
}

// What a driver does to a value that its format does not hold is left to it: nearest, before (chapter 07).
vec4 stored(vec4 v)
{
#if FORMAT == 0
    v = min(v, vec4(65504.0));
    return vec4(unpackHalf2x16(packHalf2x16(v.xy)), unpackHalf2x16(packHalf2x16(v.zw)));
#else
    return v;
#endif
}
