#version 450 core
// Bricks, step 4: where the list of texels has the first one of each voxel.
#include "16_only_what_is_needed/brick_index.glsl"
#include "16_only_what_is_needed/brick_scan.glsl"

layout(std430, binding = kBrickVoxelBinding) readonly buffer BrickVoxelBuffer { uint directions[]; };
layout(r32ui, binding = 0) writeonly uniform uimage2D voxel_entries;

uint texels_of(uint i) { return uint(bitCount(directions[i])); }
void put(uint i, uint first) { imageStore(voxel_entries, list_place(i), uvec4(first << 6 | directions[i])); }

void main() { SCAN(texels_of, put, 1) }
