#version 450 core
// Bricks, step 3: of which sides a voxel holds something: those that its faces show, or that its parts have. DIRECTIONS
// as in light_base.comp: what is not kept per face has all of them.
#include "16_only_what_is_needed/brick_lists.glsl"
#include "05_atomic_averaging/face_index.glsl"

#if FINEST && DIRECTIONS == 0
layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
#endif

void main()
{
    if (item_index() >= listed_voxels()) return;
    ivec3 voxel = listed_voxel(item_index());
    uint found = 0u;
#if DIRECTIONS != 0
    found = 63u;
#elif FINEST
    uint entry = texelFetch(face_index, voxel, 0).r;
    for (uint i = entry >> 6; i < (entry >> 6) + uint(bitCount(face_mask(entry))); ++i) {
        vec3 normal = faces[i].normal.xyz;
        for (int axis = 0; axis < 3; ++axis)
            found |= normal[axis] == 0.0 ? 0u : 1u << (2 * axis + (normal[axis] > 0.0 ? 1 : 0));
    }
#else
    for (int i = 0; i < 8; ++i)
        found |= directions[voxel_place(2 * voxel + ivec3(i & 1, (i >> 1) & 1, i >> 2), level - 1)];
#endif
    directions[voxel_place(voxel, level)] = found;
}
