#version 450 core
// A level of the tree, step 4: the flagged children get their numbers, one after another in the order of their parents.
// One thread a block of parents. EMPTY 0: children with geometry, 1: their empty neighbours, which come behind them.
#include "17_sparse_voxel_octree/blocks.glsl"

void main()
{
    uint block = item_index();
    uvec2 range = nodes_of_block(block);
    if (range.x == range.y) return;
    // snippet: allocate
#if EMPTY
    uint next = tree.levels[level + 1].geometry_end + blocks[block];
#else
    uint next = tree.levels[level + 1].begin + blocks[block];
#endif
    for (uint node = range.x; node < range.y; ++node) {
        for (uint child = 0u; child < 8u; ++child) {
            if (nodes[8u * node + child] != kChildFlag) continue;
            bool fits = next < tree.capacity;
            nodes[8u * node + child] = fits ? next : 0u;
            ivec3 corner = ivec3(child & 1u, child >> 1 & 1u, child >> 2);
            if (fits) node_places[next] = pack_place(2 * unpack_place(node_places[node]) + corner);
            ++next;
        }
    }
    // end snippet
}
