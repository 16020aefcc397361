#version 450 core
// Finest level: radiance of the voxel's faces, each weighted by its area projected on the axis, one thread a voxel.
#include "common/pyramid.glsl"
#include "07_anisotropic_mips/projected_area.glsl"
#include "common/voxel_counters.glsl"
#include "common/face_index.glsl"

layout(local_size_x = 64) in;
layout(binding = kFaceIndexUnit) uniform usampler3D face_index;
layout(std430, binding = 7) readonly buffer VoxelListBuffer { uint voxel_list[]; };
layout(std430, binding = 10) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = 11) readonly buffer RadianceBuffer { vec4 face_radiance[]; };
layout(rgba16f, binding = 0) writeonly uniform image3D light;

void main()
{
    if (gl_GlobalInvocationID.x >= voxel_statistics.voxels) return;
    ivec3 voxel = unpack_voxel(voxel_list[gl_GlobalInvocationID.x]);
    uint entry = texelFetch(face_index, voxel, 0).r;
    // snippet: projected
    for (int direction = 0; direction < kFaceCount; ++direction) {
        vec4 sum = vec4(0.0);
        for (uint i = 0u; i < uint(bitCount(face_mask(entry))); ++i) {
            uint place = (entry >> 6) + i;
            sum += projected_area(faces[place], direction) * vec4(face_radiance[place].rgb, 1.0);
        }
        sum /= column_weight(voxel, direction, 0);
        sum /= max(sum.a, 1.0);  // surfaces behind each other cover no more than the whole
        imageStore(light, atlas_texel(direction, voxel, 0), nearest_half(min(sum, vec4(65504.0))));
    }
    // end snippet
}
