#version 450 core
// A level of the tree, step 2: how many children the nodes of a block are to get, or how many bricks its nodes have.
// One thread a block. BRICKS 0 or 1.
#include "17_sparse_voxel_octree/blocks.glsl"

void main()
{
    uvec2 range = nodes_of_block(item_index());
    if (range.x == range.y) return;
    uint sum = 0u;
    for (uint node = range.x; node < range.y; ++node) {
#if BRICKS
        sum += uint(bitCount((node_bricks[node] | node_bricks[node] >> 6) & 63u));
#else
        for (uint child = 0u; child < 8u; ++child) sum += nodes[8u * node + child] >> 31;
#endif
    }
    blocks[item_index()] = sum;
}
