#version 450 core
// A place in the lists for every voxel that what moves overlaps: behind those of what stands still, whose own
// places, and their sums, stay as they are. Its faces begin with the sums of what stands still in it. One thread a
// voxel of the list.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "05_atomic_averaging/face_index.glsl"
#include "15_dynamic_scenes/dynamic_structs.glsl"

layout(r32ui, binding = 0) uniform uimage3D occupancy;
layout(r32ui, binding = 1) writeonly uniform uimage3D face_index;
layout(std430, binding = kDynamicVoxelBinding) readonly buffer DynamicVoxelBuffer { DynamicVoxel dynamic_voxels[]; };
layout(std430, binding = kDynamicCountBinding) buffer DynamicCountBuffer { DynamicCounts counts; };
layout(std430, binding = kFaceListBinding) writeonly buffer FaceListBuffer { uint face_list[]; };
layout(std430, binding = kVoxelListBinding) writeonly buffer VoxelListBuffer { uint voxel_list[]; };
layout(std430, binding = kFaceBinding) writeonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kSumBinding) buffer SumBuffer { uint sums[]; };
uniform uint voxel_count;                // of the list
uniform uint first_face, first_voxel;  // how many stand still

const uint kSumWords = uint(2 * kSumCount);

void main()
{
    if (item_index() >= voxel_count) return;
    DynamicVoxel d = dynamic_voxels[item_index()];
    ivec3 voxel = unpack_voxel(d.voxel);
    if ((d.voxel & kLostVoxel) != 0u) {
        imageStore(occupancy, voxel, uvec4(face_mask(d.before)));
        return;
    }
    // snippet: put_in
    uint mask = imageLoad(occupancy, voxel).r & 63u;
    imageStore(occupancy, voxel, uvec4(mask));
    uint place = first_face + atomicAdd(counts.placed_faces, uint(bitCount(mask)));
    imageStore(face_index, voxel, uvec4(place << 6 | mask));
    if (d.before == 0u) voxel_list[first_voxel + atomicAdd(counts.placed_voxels, 1u)] = d.voxel;
    for (uint rest = mask; rest != 0u; rest &= rest - 1u, ++place) {
        int face = findLSB(rest);
        bool stands = (face_mask(d.before) >> face & 1u) != 0u;
        uint still = face_place(d.before, face);
        face_list[place] = d.voxel | uint(face) << 27;
        for (uint word = 0u; word < kSumWords; ++word)
            sums[place * kSumWords + word] = stands ? sums[still * kSumWords + word] : 0u;
        // Nothing finds the face at its own place now; without area it weighs nothing in what runs over all faces.
        if (!stands) continue;
        faces[still] = VoxelFace(vec4(0.0), vec4(face_normal(face), 0.0), vec4(0.0), vec4(vec3(voxel) + 0.5, 0.0));
    }
    // end snippet
}
