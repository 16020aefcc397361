#version 450 core
// Half of a bounce: every occupied face gathers the light of the pyramid as pixels do, E / pi = sum_i W_i L_i(k - 1).
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "common/diffuse_gather.glsl"
#if EMITTED
#include "common/emitters.glsl"
#endif

layout(std430, binding = kFaceListBinding) readonly buffer FaceListBuffer { uint face_list[]; };
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kGatheredBinding) writeonly buffer GatheredBuffer { vec4 gathered[]; };

void main()
{
    uint place = item_index();
    if (place >= voxel_statistics.faces) return;
    VoxelFace face = faces[place];
    // snippet: gather_face
    // In every 4 x 4 voxels of a wall each of the 16 sets of cones comes once.
    ivec3 voxel = unpack_voxel(face_list[place]) & 3;
    int axis = int(face_list[place] >> 27) >> 1;
    int neighbour = voxel[(axis + 1) % 3] + 4 * voxel[(axis + 2) % 3];
    vec3 normal = face.normal.xyz;
    vec3 mean_radiance = gather_diffuse(face.position.xyz, normal, normal, neighbour).mean_radiance;
#if EMITTED
    mean_radiance += gather_emitters(face.position.xyz, normal, normal, neighbour);
#endif
    gathered[place] = vec4(mean_radiance, 0.0);
    // end snippet
}
