// Buffers from which bricks are made. Which voxels of a level hold something, one thread each: FINEST 1 for level 0,
// 0 for the others.
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "16_only_what_is_needed/brick_index.glsl"
#include "07_anisotropic_mips/occupied_levels.glsl"

layout(std430, binding = kBrickBinding) buffer BrickBuffer { uint brick_words[]; };  // four a brick
layout(std430, binding = kBrickVoxelBinding) buffer BrickVoxelBuffer { uint directions[]; };
layout(std430, binding = kVoxelListBinding) readonly buffer VoxelListBuffer { uint voxel_list[]; };

uniform int level;
uniform uint begin;  // of the level's part of `occupied`

#if FINEST
uint listed_voxels() { return voxel_statistics.voxels; }
ivec3 listed_voxel(uint i) { return unpack_voxel(voxel_list[i]); }
#else
uint listed_voxels() { return levels[level].count; }
ivec3 listed_voxel(uint i) { return unpack_voxel(occupied[begin + i]); }
#endif

uvec4 brick_at(uint i) { return uvec4(brick_words[4u * i], brick_words[4u * i + 1u], brick_words[4u * i + 2u], brick_words[4u * i + 3u]); }
uint voxel_place(ivec3 voxel, int of_level) { return place_in(brick_at(brick_place(brick_at(uint(of_level)), voxel)), voxel); }
