#version 450 core
// Border nodes: round every node with geometry its neighbours of the same level are flagged too, so that what bricks
// share with empty space has somewhere to fade out. Their parents are there: they are the parent of the node itself or
// neighbours of it, which the level above has got. One thread a node with geometry; `level` is that of the parents.
#include "17_sparse_voxel_octree/build.glsl"

uniform int neighbours;  // 26, or 6 to see what that breaks

void main()
{
    uint node = tree.levels[level + 1].begin + item_index();
    if (node >= tree.levels[level + 1].geometry_end) return;
    // snippet: border
    ivec3 place = unpack_place(node_places[node]);
    for (int i = 0; i < neighbours; ++i) {
        ivec3 other = place + neighbour_step(i);
        uint parent = find_node(other >> 1, level);  // outside the root there is none
        ivec3 corner = other & 1;
        if (parent != kNoNode)
            atomicCompSwap(nodes[8u * parent + uint(corner.x + 2 * corner.y + 4 * corner.z)], 0u, kChildFlag);
    }
    // end snippet
}
