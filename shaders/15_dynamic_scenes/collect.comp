#version 450 core
// The list of the voxels that what moves overlaps now, each once. One thread a fragment; what stands still has its
// words in the face index. DROP 1: where something stands still, nothing else comes in.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "05_atomic_averaging/face_index.glsl"
#include "15_dynamic_scenes/dynamic_structs.glsl"

layout(r32ui, binding = 0) uniform uimage3D occupancy;
layout(r32ui, binding = 1) readonly uniform uimage3D face_index;
layout(std430, binding = kFragmentBinding) readonly buffer FragmentBuffer { uvec2 fragments[]; };
layout(std430, binding = kDynamicVoxelBinding) writeonly buffer DynamicVoxelBuffer { DynamicVoxel dynamic_voxels[]; };
layout(std430, binding = kDynamicCountBinding) buffer DynamicCountBuffer { DynamicCounts counts; };
uniform uint first_fragment, fragment_count;  // of a material in the list

void main()
{
    if (item_index() >= fragment_count) return;
    // snippet: collect
    uint packed_voxel = fragments[first_fragment + item_index()].y;
    ivec3 voxel = unpack_voxel(packed_voxel);
    uint word = imageAtomicOr(occupancy, voxel, kListedVoxel);
    if ((word & kListedVoxel) != 0u) return;
    uint before = imageLoad(face_index, voxel).r;
    bool lost = DROP == 1 && before != 0u;
    dynamic_voxels[atomicAdd(counts.voxels, 1u)] = DynamicVoxel(packed_voxel | (lost ? kLostVoxel : 0u), before);
    // end snippet
    uvec3 high = uvec3(voxel), below = 511u - high;
    atomicMax(counts.below_x, below.x);
    atomicMax(counts.below_y, below.y);
    atomicMax(counts.below_z, below.z);
    atomicMax(counts.high_x, high.x);
    atomicMax(counts.high_y, high.y);
    atomicMax(counts.high_z, high.z);
    atomicAdd(counts.lost, lost ? 1u : 0u);
    atomicAdd(counts.faces, lost ? 0u : uint(bitCount(word & 63u)));
    atomicAdd(counts.new_voxels, before == 0u ? 1u : 0u);
}
