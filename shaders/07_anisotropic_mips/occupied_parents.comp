#version 450 core
// List of a coarse level's voxels that hold something: the parents of those of the level below, each once.
#include "common/voxel_grid.glsl"
#include "07_anisotropic_mips/occupied_levels.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kVoxelListBinding) readonly buffer FinerListBuffer { uint finer_list[]; };
// A bit for each voxel of the level.
layout(std430, binding = kClaimedBinding) buffer ClaimedBuffer { uint claimed[]; };
uniform int level;
uniform uint finer_begin, begin;

void main()
{
    uint place = gl_GlobalInvocationID.x;
    if (place >= levels[level - 1].count) return;
    // snippet: claim
    ivec3 parent = unpack_voxel(finer_list[finer_begin + place]) >> 1, size = grid.size.xyz >> level;
    uint cell = uint((parent.z * size.y + parent.y) * size.x + parent.x), bit = 1u << (cell & 31u);
    if ((atomicOr(claimed[cell >> 5], bit) & bit) == 0u) {
        uint next = atomicAdd(levels[level].count, 1u);
        occupied[begin + next] = pack_voxel(parent);
        if (next % 64u == 0u) atomicAdd(levels[level].groups_x, 1u);
    }
    // end snippet
}
