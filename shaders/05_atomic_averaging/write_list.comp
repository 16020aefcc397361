#version 450 core
// List of occupied voxels, step 3: every block writes its part. A voxel keeps where its faces begin and which it has.
#include "common/item_index.glsl"
#include "common/voxel_grid.glsl"
#include "05_atomic_averaging/blocks.glsl"

layout(binding = kOccupancyUnit) uniform usampler3D occupancy;
layout(r32ui, binding = 1) writeonly uniform uimage3D face_index;  // first face << 6 | mask of faces; 0 where empty
layout(std430, binding = kBlockBinding) readonly buffer BlockBuffer { Block blocks[]; };
// Packed voxel, and packed voxel | face << 27.
layout(std430, binding = kVoxelListBinding) writeonly buffer VoxelListBuffer { uint voxel_list[]; };
layout(std430, binding = kFaceListBinding) writeonly buffer FaceListBuffer { uint face_list[]; };

void main()
{
    uint block = item_index();
    if (block >= block_count()) return;
    Block b = blocks[block];
    // snippet: write_list
    for (int word = 0; word < 2; ++word) {
        for (uint rest = b.occupied[word]; rest != 0u; rest &= rest - 1u) {
            ivec3 voxel = voxel_of(block, 32 * word + findLSB(rest));
            uint mask = texelFetch(occupancy, voxel, 0).r;
            voxel_list[b.voxels++] = pack_voxel(voxel);
            imageStore(face_index, voxel, uvec4(b.faces << 6 | mask));
            for (uint faces = mask; faces != 0u; faces &= faces - 1u)
                face_list[b.faces++] = pack_voxel(voxel) | uint(findLSB(faces)) << 27;
        }
    }
    // end snippet
}
