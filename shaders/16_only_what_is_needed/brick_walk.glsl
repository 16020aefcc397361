// The walk volume, coarse where nothing is: a word for every brick of 4 x 4 x 4 cells. Where a cell of it is occupied,
// bit 31 and the brick's number in a list, which has a word for each of its cells as walk_volume.glsl has them. Where
// all are empty, for each octant 3 bits, the largest k <= 4 for which the cube of 2^k bricks that begins here is empty.
#include "16_only_what_is_needed/brick_list.glsl"

layout(binding = kWalkBrickUnit) uniform usampler3D walk_bricks;
layout(binding = kWalkVolumeUnit) uniform usampler2D walk_list;

uint listed_cell(uint brick, ivec3 cell) { return (brick & 0x7fffffffu) * 64u + brick_bit(cell); }

// As in walk_volume.glsl.
// snippet: walk_word
uint walk_word(inout vec3 cell, vec3 down, out float unit)
{
    ivec3 c = ivec3(cell);
    uint brick = texelFetch(walk_bricks, c >> 2, 0).r;
    bool fine = brick >= 0x80000000u;
    uint word = texelFetch(walk_list, list_place(fine ? listed_cell(brick, c) : 0u), 0).r;
    const float kSide = float(kBrickSide);
    unit = fine ? 1.0 : kSide;
    cell = fine ? cell : kSide * floor(cell / kSide) + (kSide - 1.0) * down;
    return fine ? word : brick;
}
// end snippet

#ifdef STORES_WALK
layout(r32ui, binding = 0) writeonly uniform uimage2D stored_walk;
void store_walk(ivec3 cell, uint word)
{
    uint brick = texelFetch(walk_bricks, cell >> 2, 0).r;
    if (brick >= 0x80000000u) imageStore(stored_walk, list_place(listed_cell(brick, cell)), uvec4(word));
}
#endif
