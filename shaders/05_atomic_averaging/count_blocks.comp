#version 450 core
// List of occupied voxels, step 1: which voxels each block of 4x4x4 has, and how many faces. One thread a block.
#include "common/item_index.glsl"
#include "common/voxel_grid.glsl"
#include "05_atomic_averaging/blocks.glsl"

layout(binding = kOccupancyUnit) uniform usampler3D occupancy;
layout(std430, binding = kBlockBinding) writeonly buffer BlockBuffer { Block blocks[]; };

void main()
{
    uint block = item_index();
    if (block >= block_count()) return;
    // The occupancy pyramid knows which blocks are empty; its level 2 has one texel a block.
    bool empty = grid.size.w > 2 && texelFetch(occupancy, block_corner(block) >> 2, 2).r == 0u;
    Block b = Block(0u, 0u, uint[2](0u, 0u));
    int last = empty ? 0 : kBlockVoxels;
    for (int i = 0; i < last; ++i) {
        ivec3 voxel = voxel_of(block, i);
        uint faces = all(lessThan(voxel, grid.size.xyz)) ? texelFetch(occupancy, voxel, 0).r : 0u;
        if (faces == 0u) continue;
        b.voxels += 1u;
        b.faces += uint(bitCount(faces));
        b.occupied[i >> 5] |= 1u << (i & 31);
    }
    blocks[block] = b;
}
