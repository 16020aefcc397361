// Bricks: 3^3 samples of a node, at its corners, the middles of its edges and sides, and its middle; neighbours hold
// copies of what they share. A node has one for each of the directions in which something of it or of its neighbours
// sends light, in a row. Texels as in chapter 07: a coverage A, rgb A L in units of light_scale.
#include "17_sparse_voxel_octree/octree.glsl"

// first << 6 | directions
layout(std430, binding = kNodeBrickBinding) readonly buffer NodeBrickBuffer { uint node_bricks[]; };

const uint kNoBrick = 0xffffffffu;

// The brick of one of the node's directions, or kNoBrick: all of its samples are 0.
uint brick_of(uint node, int direction)
{
    uint word = node_bricks[node];
    if ((word >> direction & 1u) == 0u) return kNoBrick;
    return (word >> 6) + uint(bitCount(word & ((1u << direction) - 1u)));
}

// First texel of a brick in the pool.
ivec3 brick_corner(uint brick)
{
    uint row = uint(kBrickRow);
    return 3 * ivec3(brick % row, brick / row % row, brick / (row * row));
}
