#version 450 core
// Show a quantity of the faces of the voxels that the camera's ray meets.
#include "common/camera_ray.glsl"
#include "04_conservative_voxelization/voxel_walk.glsl"
#include "05_atomic_averaging/face_index.glsl"

layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(binding = kPackedColorUnit) uniform usampler3D packed_color;  // RGBA8 in 32 bits, instead of the faces
layout(std430, binding = kFaceBinding) readonly buffer FaceWords { vec4 face_words[]; };
layout(std430, binding = kRadianceBinding) readonly buffer PlusWords { vec4 plus_words[]; };
uniform int stride, offset;   // in vec4, within face_words
uniform int plus_stride, plus_offset;
uniform bool has_plus;        // plus_words are added
uniform int show;             // 0: colour, 1: direction as 0.5 n + 0.5, 2: alpha as grey, 3: packed_color, 4: their difference
uniform bool has_packed;
layout(location = 0) out vec4 color;

void main()
{
    Ray ray = camera_ray(gl_FragCoord.xy);
    VoxelHit hit = walk_voxels(grid_from_scene(ray.origin), ray.direction / grid.origin.w, 0);
    color = vec4(0.0);
    if (!hit.hit) return;
    if (show == 3) {
        color = vec4(unpackUnorm4x8(texelFetch(packed_color, hit.voxel, 0).r).rgb, 1.0);
        return;
    }
    // Of the voxel's faces take the one that looks most towards the camera.
    uint entry = texelFetch(face_index, hit.voxel, 0).r;
    vec4 value = vec4(0.0);
    float best = -2.0;
    for (int face = 0; face < kFaceCount; ++face) {
        float towards = -dot(face_normal(face), ray.direction);
        if ((face_mask(entry) & (1u << face)) == 0u || towards <= best) continue;
        best = towards;
        value = face_words[face_place(entry, face) * uint(stride) + uint(offset)];
        if (has_plus) value.rgb += plus_words[face_place(entry, face) * uint(plus_stride) + uint(plus_offset)].rgb;
    }
    vec3 other = has_packed ? unpackUnorm4x8(texelFetch(packed_color, hit.voxel, 0).r).rgb : value.rgb;
    if (show == 4) value.rgb = 4.0 * abs(value.rgb - other);
    color = vec4(show == 1 ? 0.5 * value.xyz + 0.5 : show == 2 ? value.aaa : value.rgb, 1.0);
}
