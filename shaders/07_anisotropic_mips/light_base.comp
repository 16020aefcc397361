#version 450 core
// Finest level: radiance of the voxel's faces, each weighted by its area projected on the axis, one thread a voxel.
#include "07_anisotropic_mips/store_light.glsl"
#include "07_anisotropic_mips/column_weight.glsl"
#include "07_anisotropic_mips/projected_area.glsl"
#include "common/item_index.glsl"
#include "common/voxel_counters.glsl"
#include "05_atomic_averaging/face_index.glsl"

layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = kVoxelListBinding) readonly buffer VoxelListBuffer { uint voxel_list[]; };
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kRadianceBinding) readonly buffer RadianceBuffer { vec4 face_radiance[]; };

uniform vec2 part;  // of radiance and emission: (1, 1) all, (1, 0) what is reflected, (0, 1) emitted, (0, 0) none

void main()
{
    if (item_index() >= voxel_statistics.voxels) return;
    ivec3 voxel = unpack_voxel(voxel_list[item_index()]);
    uint entry = texelFetch(face_index, voxel, 0).r;
    vec4 sums[kFaceCount] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    for (uint i = entry >> 6; i < (entry >> 6) + uint(bitCount(face_mask(entry))); ++i) {
        VoxelFace face = faces[i];
        vec4 light = vec4(part.x * face_radiance[i].rgb + part.y * face.emission.rgb, 1.0);
#if DIRECTIONS == 0
        // snippet: projected
        vec3 area = face.albedo_area.a * face.normal.xyz, against = max(-area, vec3(0.0)), along = max(area, vec3(0.0));
        sums[0] += against.x * light;
        sums[1] += along.x * light;
        sums[2] += against.y * light;
        sums[3] += along.y * light;
        sums[4] += against.z * light;
        sums[5] += along.z * light;
        // end snippet
#else
        // Not per face: every direction holds what the direction that the face looks to most would.
        int nearest = nearest_direction(face.normal.xyz);
        for (int direction = 0; direction < kFaceCount; ++direction)
            sums[direction] += projected_area(face, nearest) / column_weight(voxel, nearest, 0) * light;
#endif
    }
    for (int direction = 0; direction < kFaceCount; ++direction) {
        vec4 sum = sums[direction];
#if DIRECTIONS == 0
        sum /= column_weight(voxel, direction, 0);
#endif
        sum /= max(sum.a, 1.0);  // surfaces behind each other cover no more than the whole
        store_texel(direction, voxel, 0, vec4(sum.rgb / light_scale, sum.a));
    }
}
