// The bricks of all levels, and so which voxels hold something.
#include "16_only_what_is_needed/brick_index.glsl"

layout(binding = kBrickUnit) uniform usampler2D bricks;

uvec4 brick_of(ivec3 voxel, int level)
{
    return texelFetch(bricks, list_place(brick_place(texelFetch(bricks, ivec2(level, 0), 0), voxel)), 0);
}
bool is_occupied(ivec3 voxel, int level) { return place_in(brick_of(voxel, level), voxel) != 0u; }
