#version 450 core
// Finest level: radiance of the voxel's faces, each weighted by its area projected on the axis, one thread a voxel.
#include "07_anisotropic_mips/store_light.glsl"
#include "07_anisotropic_mips/projected_area.glsl"
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "05_atomic_averaging/face_index.glsl"

layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = kVoxelListBinding) readonly buffer VoxelListBuffer { uint voxel_list[]; };
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kRadianceBinding) readonly buffer RadianceBuffer { vec4 face_radiance[]; };

uniform vec2 part;  // of radiance and emission: (1, 0) all, (1, -1) what is reflected, (0, 1) emitted, (0, 0) none

void main()
{
    if (item_index() >= voxel_statistics.voxels) return;
    ivec3 voxel = unpack_voxel(voxel_list[item_index()]);
    uint entry = texelFetch(face_index, voxel, 0).r;
    // snippet: projected
    for (int direction = 0; direction < kFaceCount; ++direction) {
        vec4 sum = vec4(0.0);
        for (uint i = 0u; i < uint(bitCount(face_mask(entry))); ++i) {
            VoxelFace face = faces[(entry >> 6) + i];
            // Not per face: every direction holds what the direction that the face looks to most would.
            int seen_from = DIRECTIONS == 0 ? direction : nearest_direction(face.normal.xyz);
            vec3 radiance = part.x * face_radiance[(entry >> 6) + i].rgb + part.y * face.emission.rgb;
            sum += projected_area(face, seen_from) / column_weight(voxel, seen_from, 0) * vec4(radiance, 1.0);
        }
        sum /= max(sum.a, 1.0);  // surfaces behind each other cover no more than the whole
        store_texel(atlas_texel(direction, voxel, 0), vec4(sum.rgb / light_scale, sum.a));
    }
    // end snippet
}
