#version 450 core
// Walk volume, step 1: the eight cells around the corners of every occupied voxel hold something. One thread a voxel.
#include "common/voxel_grid.glsl"
#include "common/voxel_counters.glsl"
#include "common/item_index.glsl"
#include "08_diffuse_cones/walk_bits.glsl"

layout(std430, binding = kVoxelListBinding) readonly buffer VoxelListBuffer { uint voxel_list[]; };

void main()
{
    if (item_index() >= voxel_statistics.voxels) return;
    ivec3 voxel = unpack_voxel(voxel_list[item_index()]), counts = walk_row_counts();
    for (int corner = 0; corner < 8; ++corner) {
        ivec3 at = voxel + ivec3(corner & 1, (corner >> 1) & 1, corner >> 2) + kWalkPadding;
        atomicOr(walk_bits[(at.z * counts.y + at.y) * counts.x + (at.x >> 5)], 1u << (at.x & 31));
    }
}
