#version 450 core
// Bricks, step 2: where the list of voxels has the first one of each brick.
#include "16_only_what_is_needed/brick_index.glsl"
#include "16_only_what_is_needed/brick_scan.glsl"

layout(std430, binding = kBrickBinding) buffer BrickBuffer { uvec4 listed_bricks[]; };
layout(rgba32ui, binding = 0) writeonly uniform uimage2D brick_list;

uint voxels_in(uint i) { return i < uint(kLevelRecords) ? 0u : uint(bitCount(listed_bricks[i].x) + bitCount(listed_bricks[i].y)); }
void put(uint i, uint first)
{
    if (i >= uint(kLevelRecords)) listed_bricks[i].zw = uvec2(first, bitCount(listed_bricks[i].x));
    imageStore(brick_list, list_place(i), listed_bricks[i]);
}

void main() { SCAN(voxels_in, put, 0) }
