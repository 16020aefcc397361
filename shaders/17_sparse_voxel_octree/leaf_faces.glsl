// Where the faces of a voxel are, found by the tree: the sparse form of chapter 05's index.
#include "17_sparse_voxel_octree/octree.glsl"
#include "05_atomic_averaging/face_index.glsl"

// Of each leaf with geometry eight words, voxel x + 2 y + 4 z: first face << 6 | mask.
layout(std430, binding = kLeafFaceBinding) readonly buffer LeafFaceBuffer { uint leaf_faces[]; };
uniform uint leaf_begin, leaf_end;  // nodes: leaves with geometry

// The word of a voxel of a leaf; 0 where it is empty.
uint leaf_entry(uint leaf, ivec3 voxel)
{
    ivec3 bit = voxel & 1;
    if (leaf == kNoNode || leaf >= leaf_end) return 0u;
    return leaf_faces[8u * (leaf - leaf_begin) + uint(bit.x + 2 * bit.y + 4 * bit.z)];
}
