#version 450 core
// List of a coarse level's voxels that hold something: the parents of those of the level below, each once.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "07_anisotropic_mips/occupied_levels.glsl"

layout(std430, binding = kVoxelListBinding) readonly buffer FinerListBuffer { uint finer_list[]; };
// A bit for each voxel of the level.
layout(std430, binding = kClaimedBinding) buffer ClaimedBuffer { uint claimed[]; };
uniform int level;
uniform uint finer_begin, begin;

void main()
{
    uint place = item_index();
    if (place >= levels[level - 1].count) return;
    // snippet: claim
    ivec3 parent = unpack_voxel(finer_list[finer_begin + place]) >> 1, size = grid.size.xyz >> level;
    uint cell = uint((parent.z * size.y + parent.y) * size.x + parent.x), bit = 1u << (cell & 31u);
    if ((atomicOr(claimed[cell >> 5], bit) & bit) == 0u) {
        uint next = atomicAdd(levels[level].count, 1u);
        occupied[begin + next] = pack_voxel(parent);
        uint group = next / 64u;
        bool begins_group = next % 64u == 0u;
        if (begins_group && group < kMostGroups) atomicAdd(levels[level].groups_x, 1u);
        if (begins_group && group > 0u && group % kMostGroups == 0u) atomicAdd(levels[level].groups_y, 1u);
    }
    // end snippet
}
