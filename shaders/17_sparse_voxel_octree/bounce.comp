#version 450 core
// One bounce: every occupied face gathers through the tree as a pixel does, R(k) = R(0) + rho E(k - 1) / pi, and what
// it reflects then goes into the bricks again. One thread a face. MEASURE 1: keep the largest change.
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "17_sparse_voxel_octree/cone.glsl"
#include "08_diffuse_cones/gather.glsl"

layout(std430, binding = kFaceListBinding) readonly buffer FaceListBuffer { uint face_list[]; };
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kRadianceBinding) readonly buffer DirectBuffer { vec4 direct[]; };  // R(0)
layout(std430, binding = kReflectedBinding) buffer ReflectedBuffer { vec4 reflected[]; };        // R(k - 1), R(k)
#if MEASURE  // bits of floats, which have their order
layout(std430, binding = kTreeChangeBinding) buffer ChangeBuffer { uint largest_change, largest_radiance; };
#endif

// A white of 1 would never settle: chapter 12.
const float kMaxAlbedo = 0.99;

void main()
{
    uint place = item_index();
    if (place >= voxel_statistics.faces) return;
    VoxelFace face = faces[place];
    vec3 normal = face.normal.xyz;
    // In every 8 x 8 voxels of a wall each of the 64 sets of cones comes once.
    ivec3 voxel = unpack_voxel(face_list[place]) & 7;
    int axis = int(face_list[place] >> 27) >> 1, set = voxel[(axis + 1) % 3] + 8 * voxel[(axis + 2) % 3];
    // snippet: bounce
    Gathered sum = gather_diffuse(start_above(face.position.xyz, normal, start_offset), normal, normal, set);
    vec3 radiance = direct[place].rgb + min(face.albedo_area.rgb, kMaxAlbedo) * sum.mean_radiance;
    // end snippet
#if MEASURE
    vec3 change = abs(radiance - reflected[place].rgb);
    atomicMax(largest_change, floatBitsToUint(max(change.r, max(change.g, change.b))));
    atomicMax(largest_radiance, floatBitsToUint(max(radiance.r, max(radiance.g, radiance.b))));
#endif
    reflected[place] = vec4(radiance, direct[place].a);
}
