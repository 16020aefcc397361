// Nodes by blocks, each of which a thread counts and places.
#include "17_sparse_voxel_octree/build.glsl"

layout(std430, binding = kTreeBlockBinding) buffer BlockBuffer { uint blocks[]; };  // counts, then where they begin

// The nodes of a block of the level; none where it is beyond the level's end.
uvec2 nodes_of_block(uint block)
{
    uint first = tree.levels[level].begin + block * uint(kNodesPerBlock);
    return min(uvec2(first, first + uint(kNodesPerBlock)), uvec2(tree.levels[level].end));
}
