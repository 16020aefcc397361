#version 450 core
// The occupancy of the next level again, above the voxels of the list. One thread a voxel of the list; several may
// have the same parent and write the same.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "15_dynamic_scenes/dynamic_structs.glsl"

layout(r32ui, binding = 0) readonly uniform uimage3D finer;
layout(r32ui, binding = 1) writeonly uniform uimage3D coarser;
layout(std430, binding = kDynamicVoxelBinding) readonly buffer DynamicVoxelBuffer { DynamicVoxel dynamic_voxels[]; };
uniform uint voxel_count;
uniform int level;

void main()
{
    if (item_index() >= voxel_count) return;
    ivec3 parent = unpack_voxel(dynamic_voxels[item_index()].voxel) >> level;
    uint faces = 0u;
    for (int child = 0; child < 8; ++child)
        faces |= imageLoad(finer, 2 * parent + ivec3(child & 1, (child >> 1) & 1, child >> 2)).r;
    imageStore(coarser, parent, uvec4(faces));
}
