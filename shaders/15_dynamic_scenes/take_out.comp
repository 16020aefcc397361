#version 450 core
// Takes what moved out of its last voxels: what stands still there is put back, from the sums that it has kept. One
// thread a voxel of the list.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "05_atomic_averaging/face_index.glsl"
#include "05_atomic_averaging/face_mean.glsl"
#include "15_dynamic_scenes/dynamic_structs.glsl"

layout(r32ui, binding = 0) writeonly uniform uimage3D occupancy;
layout(r32ui, binding = 1) writeonly uniform uimage3D face_index;
layout(std430, binding = kDynamicVoxelBinding) readonly buffer DynamicVoxelBuffer { DynamicVoxel dynamic_voxels[]; };
layout(std430, binding = kFaceBinding) writeonly buffer FaceBuffer { VoxelFace faces[]; };
uniform uint voxel_count;

void main()
{
    if (item_index() >= voxel_count) return;
    DynamicVoxel d = dynamic_voxels[item_index()];
    if ((d.voxel & kLostVoxel) != 0u) return;  // it was never put in
    // snippet: take_out
    ivec3 voxel = unpack_voxel(d.voxel);
    imageStore(occupancy, voxel, uvec4(face_mask(d.before)));
    imageStore(face_index, voxel, uvec4(d.before));
    uint place = d.before >> 6;
    for (uint rest = face_mask(d.before); rest != 0u; rest &= rest - 1u, ++place)
        faces[place] = face_mean(place, d.voxel | uint(findLSB(rest)) << 27);
    // end snippet
}
