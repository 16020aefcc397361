#version 450 core
// Bricks get their numbers, one after another in the order of the nodes and of the directions. One thread a block.
#include "17_sparse_voxel_octree/blocks.glsl"

void main()
{
    uint block = item_index();
    uvec2 range = nodes_of_block(block);
    if (range.x == range.y) return;
    uint next = tree.levels[level].bricks + blocks[block];
    for (uint node = range.x; node < range.y; ++node) {
        uint directions = (node_bricks[node] | node_bricks[node] >> 6) & 63u;
        node_bricks[node] = next << 6 | directions;
        next += uint(bitCount(directions));
    }
}
