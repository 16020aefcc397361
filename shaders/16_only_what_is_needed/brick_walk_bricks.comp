#version 450 core
// Which bricks of the walk volume hold something, and how far a ray may leap from those that do not: cubes of 2^k bricks
// are cubes of 2^(k + 2) cells, which walk_bits.glsl has. One thread a brick.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "08_diffuse_cones/walk_bits.glsl"
#include "16_only_what_is_needed/brick_structs.glsl"

layout(r32ui, binding = 0) writeonly uniform uimage3D walk_bricks;
layout(std430, binding = kBrickTotalBinding) buffer BrickTotals { uint listed_bricks; };

const int kBrickLevel = 2;  // of the bits: cubes of kBrickSide cells

bool is_empty(int level, ivec3 begin)
{
    return (walk_bits_from(level, begin.x + kWalkPadding, begin.yz + kWalkPadding) & 1u) == 0u;
}

void main()
{
    ivec3 bricks = (walk_size() + kBrickSide - 1) / kBrickSide;
    int i = int(item_index());
    if (i >= bricks.x * bricks.y * bricks.z) return;
    ivec3 brick = ivec3(i % bricks.x, (i / bricks.x) % bricks.y, i / (bricks.x * bricks.y)), first = kBrickSide * brick;
    uint word = 0u;
    // snippet: brick_leaps
    for (int octant = 0; octant < 8; ++octant) {
        ivec3 down = 1 - (ivec3(octant) >> ivec3(0, 1, 2) & 1);
        uint cubes = 0u;
        for (int level = kBrickLevel + 1; level < kWalkLevels; ++level)
            cubes += is_empty(level, first + down * (kBrickSide - (1 << level))) ? 1u : 0u;
        word |= cubes << (3 * octant);
    }
    // end snippet
    if (!is_empty(kBrickLevel, first)) word = 1u << 31 | atomicAdd(listed_bricks, 1u);
    imageStore(walk_bricks, brick, uvec4(word));
}
