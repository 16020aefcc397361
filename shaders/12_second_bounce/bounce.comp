#version 450 core
// One more bounce: every occupied face gathers the light of the pyramid as pixels do, and sends on the share rho of it.
// L(k) = L(0) + rho * sum_i W_i L_i(k - 1)
#include "common/voxel_counters.glsl"
#include "common/diffuse_gather.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 10) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = 11) readonly buffer DirectBuffer { vec4 direct_radiance[]; };   // L(0)
layout(std430, binding = 12) buffer BouncedBuffer { vec4 bounced_radiance[]; };          // L(k - 1), then L(k)
layout(std430, binding = 13) buffer ChangeBuffer { uint largest_change, largest_radiance; };  // float bits, >= 0

// The series of bounces converges only when every surface keeps some light; a white of 1 would never settle.
const float kMaxAlbedo = 0.99;

void main()
{
    uint place = gl_GlobalInvocationID.x;
    if (place >= voxel_statistics.faces) return;
    VoxelFace face = faces[place];
    ivec3 voxel = ivec3(face.position.xyz) & 3;
    int neighbour = voxel.x + 4 * voxel.y + 5 * voxel.z;  // in every plane of 4 x 4 voxels each set comes once or so
    Gathered gathered = gather_diffuse(face.position.xyz, face.normal.xyz, face.normal.xyz, neighbour);
    vec3 albedo = min(face.albedo_area.rgb, vec3(kMaxAlbedo));
    vec3 radiance = direct_radiance[place].rgb + albedo * gathered.mean_radiance;
    vec3 change = abs(radiance - bounced_radiance[place].rgb);
    bounced_radiance[place] = vec4(radiance, direct_radiance[place].a);
    // Floats that are not negative have the order of their bits.
    atomicMax(largest_change, floatBitsToUint(max(change.r, max(change.g, change.b))));
    atomicMax(largest_radiance, floatBitsToUint(max(radiance.r, max(radiance.g, radiance.b))));
}
