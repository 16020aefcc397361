#version 450 core
// The other half: faces of one wall share what they gathered, as pixels do, and send on the share rho of it.
// L(k) = L(0) + rho E / pi
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "common/voxel_grid.glsl"
#include "05_atomic_averaging/face_index.glsl"

layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = kFaceListBinding) readonly buffer FaceListBuffer { uint face_list[]; };
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kRadianceBinding) readonly buffer DirectBuffer { vec4 direct_radiance[]; };  // L(0)
layout(std430, binding = kGatheredBinding) readonly buffer GatheredBuffer { vec4 gathered[]; };
// Float bits, >= 0.
layout(std430, binding = kChangeBinding) buffer ChangeBuffer { uint largest_change, largest_radiance; };
layout(std430, binding = kBouncedBinding) buffer BouncedBuffer { vec4 bounced_radiance[]; };  // L(k - 1), then L(k)

// The series of bounces converges only when every surface keeps some light; a white of 1 would never settle.
const float kMaxAlbedo = 0.99;
const float kMinCosine = 0.9;  // between normals of one wall

// snippet: share_faces
vec3 shared_with_wall(uint place, vec3 normal)
{
    ivec3 voxel = unpack_voxel(face_list[place]);
    int direction = int(face_list[place] >> 27), axis = direction >> 1;
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int i = 0; i < 16; ++i) {
        ivec3 other = voxel;
        other[(axis + 1) % 3] += (i & 3) - 2;
        other[(axis + 2) % 3] += (i >> 2) - 2;
        uint entry = texelFetch(face_index, clamp(other, ivec3(0), grid.size.xyz - 1), 0).r;
        uint there = (face_mask(entry) & (1u << direction)) != 0u ? face_place(entry, direction) : place;
        float same = dot(faces[there].normal.xyz, normal) > kMinCosine ? 1.0 : 0.0;
        sum += same * gathered[there].rgb;
        count += same;
    }
    return sum / max(count, 1.0);
}
// end snippet

void main()
{
    uint place = item_index();
    if (place >= voxel_statistics.faces) return;
    // snippet: send_on
    vec3 albedo = min(faces[place].albedo_area.rgb, vec3(kMaxAlbedo));
    vec3 radiance = direct_radiance[place].rgb + albedo * shared_with_wall(place, faces[place].normal.xyz);
    vec3 change = abs(radiance - bounced_radiance[place].rgb);
    bounced_radiance[place] = vec4(radiance, direct_radiance[place].a);
    // end snippet
    // Floats that are not negative have the order of their bits.
    atomicMax(largest_change, floatBitsToUint(max(change.r, max(change.g, change.b))));
    atomicMax(largest_radiance, floatBitsToUint(max(radiance.r, max(radiance.g, radiance.b))));
}
