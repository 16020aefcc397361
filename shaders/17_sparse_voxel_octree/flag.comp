#version 450 core
// A level of the tree, step 1: every voxel steps down to its node of the level, adds its directions to the node's, and
// flags the child that it lies in. One thread a voxel; who writes the same flag twice writes the same word.
#include "common/voxel_counters.glsl"
#include "common/voxel_grid.glsl"
#include "17_sparse_voxel_octree/build.glsl"
#include "05_atomic_averaging/face_index.glsl"

layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kVoxelListBinding) readonly buffer VoxelListBuffer { uint voxel_list[]; };
layout(std430, binding = kVoxelNodeBinding) buffer VoxelNodeBuffer { uint voxel_nodes[]; };  // node << 6 | directions

// A normal has components of 2^-24 where it should have none; a half float of 1 does not hold those under 2^-11.
const float kLeastComponent = 1.0 / 2048.0;

uint directions_of(ivec3 voxel)
{
    uint entry = texelFetch(face_index, voxel, 0).r, mask = 0u;
    for (uint i = entry >> 6; i < (entry >> 6) + uint(bitCount(face_mask(entry))); ++i)
        for (int d = 0; d < kFaceCount; ++d)
            if (faces[i].albedo_area.a > 0.0 && dot(faces[i].normal.xyz, face_normal(d)) > kLeastComponent)
                mask |= 1u << d;
    return mask;
}

void main()
{
    uint i = item_index();
    if (i >= voxel_statistics.voxels) return;
    // snippet: flag
    ivec3 voxel = unpack_voxel(voxel_list[i]);
    uint node = 0u, directions = 0u;
    if (level == 0) {
        directions = directions_of(voxel);
    } else {
        directions = voxel_nodes[i] & 63u;
        node = nodes[8u * (voxel_nodes[i] >> 6) + child_slot(voxel, level - 1)];
    }
    voxel_nodes[i] = node << 6 | directions;
    atomicOr(node_bricks[node], directions);
    if (level + 1 < tree_depth) nodes[8u * node + child_slot(voxel, level)] = kChildFlag;
    // end snippet
}
