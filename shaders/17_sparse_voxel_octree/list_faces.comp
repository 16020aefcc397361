#version 450 core
// Which faces the voxels of a leaf have, out of chapter 05's dense index, which may then go. One thread a leaf.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "17_sparse_voxel_octree/octree.glsl"

layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = kNodePlaceBinding) readonly buffer PlaceBuffer { uint node_places[]; };
layout(std430, binding = kLeafFaceBinding) writeonly buffer LeafFaceBuffer { uint leaf_faces[]; };
uniform uint leaf_begin, leaf_end;

void main()
{
    uint leaf = leaf_begin + item_index();
    if (leaf >= leaf_end) return;
    ivec3 corner = 2 * unpack_place(node_places[leaf]);
    for (int i = 0; i < 8; ++i) {
        ivec3 voxel = corner + ivec3(i & 1, i >> 1 & 1, i >> 2);
        bool inside = all(lessThan(voxel, grid.size.xyz));
        leaf_faces[8u * item_index() + uint(i)] = inside ? texelFetch(face_index, voxel, 0).r : 0u;
    }
}
