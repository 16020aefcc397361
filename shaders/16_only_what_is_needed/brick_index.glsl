// Where in a list a voxel is that holds something: bricks of 4 x 4 x 4 voxels with a bit for each, and where the list
// has the first of them. The bits before a voxel's own, counted, lead to it (as in NanoVDB's index grids, Museth 2021).
//
// A brick is a texel of a list, level after level, within a level by x, y and z:
//   x, y   a bit for each voxel, x + 4 y + 16 z
//   z      place of the first of its voxels; places begin at 1, and 0 holds nothing
//   w      number of bits in x
// In front of them a texel for each level: xyz bricks along each axis, w the first one.
#include "common/voxel_grid.glsl"
#include "16_only_what_is_needed/brick_list.glsl"

uint brick_place(uvec4 level_record, ivec3 voxel)
{
    uvec3 brick = uvec3(voxel) / uint(kBrickSide);
    return level_record.w + (brick.z * level_record.y + brick.y) * level_record.x + brick.x;
}

// snippet: place_in
uint place_in(uvec4 brick, ivec3 voxel)
{
    uint i = brick_bit(voxel), word = i < 32u ? brick.x : brick.y, bit = 1u << (i & 31u);
    uint before = (i < 32u ? 0u : brick.w) + uint(bitCount(word & (bit - 1u)));
    return (word & bit) != 0u ? brick.z + before : 0u;
}
// end snippet
