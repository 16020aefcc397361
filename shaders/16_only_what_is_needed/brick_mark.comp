#version 450 core
// Bricks, step 1: a bit for every voxel of a level that holds something.
#include "16_only_what_is_needed/brick_lists.glsl"

void main()
{
    if (item_index() >= listed_voxels()) return;
    ivec3 voxel = listed_voxel(item_index());
    uint i = brick_bit(voxel);
    atomicOr(brick_words[4u * brick_place(brick_at(uint(level)), voxel) + (i >> 5)], 1u << (i & 31u));
}
