#version 450 core
// Which of the six directions a node has bricks for: those of its own voxels and of its neighbours', whose samples
// reach it. One thread a node with geometry.
#include "17_sparse_voxel_octree/build.glsl"

void main()
{
    uint node = tree.levels[level].begin + item_index();
    if (node >= tree.levels[level].geometry_end) return;
    ivec3 place = unpack_place(node_places[node]);
    uint directions = node_bricks[node] & 63u;
    for (int i = 0; i < 26; ++i) {
        uint other = find_node(place + neighbour_step(i), level);
        if (other != kNoNode) atomicOr(node_bricks[other], directions << 6);
    }
}
