// Where an item of a list is in the rows of its texture, and where a voxel is in its brick.
#include "16_only_what_is_needed/brick_structs.glsl"

ivec2 list_place(uint i) { return ivec2(i % uint(kListWidth), i / uint(kListWidth)); }
uint brick_bit(ivec3 voxel) { return uint((voxel.x & 3) | (voxel.y & 3) << 2 | (voxel.z & 3) << 4); }
