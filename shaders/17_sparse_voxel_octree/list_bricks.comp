#version 450 core
// The way back from a brick to its node and direction. One thread a node.
#include "17_sparse_voxel_octree/build.glsl"

// node << 3 | direction
layout(std430, binding = kBrickListBinding) writeonly buffer BrickListBuffer { uint brick_list[]; };

void main()
{
    uint node = item_index();
    if (node >= tree.nodes) return;
    uint next = node_bricks[node] >> 6;
    for (int d = 0; d < 6; ++d)
        if ((node_bricks[node] >> d & 1u) != 0u) brick_list[next++] = node << 3 | uint(d);
}
