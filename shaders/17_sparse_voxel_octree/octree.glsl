// The octree: the one place that knows how its nodes are stored.
//
// A node is eight words: child x + 2 y + 4 z, 0 where there is none, for node 0 is the root and nobody's child. The
// root is 2^tree_depth voxels wide, begins where the grid begins, and is level 0; a leaf, level tree_depth - 1,
// covers 2^3 voxels. Define TREE_ACCESS as nothing before, where nodes are written.
#include "common/bindings.glsl"
#include "17_sparse_voxel_octree/octree_structs.glsl"

#ifndef TREE_ACCESS
#define TREE_ACCESS readonly
#endif
layout(std430, binding = kNodeBinding) TREE_ACCESS buffer NodeBuffer { uint nodes[]; };
uniform int tree_depth;

const uint kNoNode = 0xffffffffu;

// Which child of a node of `level` a voxel lies in.
uint child_slot(ivec3 voxel, int level)
{
    ivec3 bit = voxel >> (tree_depth - 1 - level) & 1;
    return uint(bit.x + 2 * bit.y + 4 * bit.z);
}

// The node of `level` at `place` (in nodes of the level), or kNoNode.
// snippet: find_node
uint find_node(ivec3 place, int level)
{
    if (any(lessThan(place, ivec3(0))) || any(greaterThanEqual(place, ivec3(1 << level)))) return kNoNode;
    uint node = 0u;
    for (int shift = level - 1; shift >= 0; --shift) {
        ivec3 bit = place >> shift & 1;
        node = nodes[8u * node + uint(bit.x + 2 * bit.y + 4 * bit.z)];
        if (node == 0u) return kNoNode;
    }
    return node;
}
// end snippet

// Where nodes are, in nodes of their level: 10 bits an axis.
uint pack_place(ivec3 place) { return uint(place.x) | uint(place.y) << 10 | uint(place.z) << 20; }
ivec3 unpack_place(uint bits) { return ivec3(bits & 1023u, bits >> 10 & 1023u, bits >> 20 & 1023u); }

// Sides of a node, then edges, then corners: neighbour i of 26, or of the first 6.
ivec3 neighbour_step(int i)
{
    if (i < 6) return (2 * (i & 1) - 1) * ivec3(equal(ivec3(i >> 1), ivec3(0, 1, 2)));
    int rest = i - 6;
    if (rest < 12) {
        int axis = rest >> 2;
        ivec3 step = ivec3(0);
        step[(axis + 1) % 3] = 2 * (rest & 1) - 1;
        step[(axis + 2) % 3] = (rest & 2) - 1;
        return step;
    }
    rest -= 12;
    return 2 * ivec3(rest & 1, rest >> 1 & 1, rest >> 2) - 1;
}
