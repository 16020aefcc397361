#version 450 core
// What the faces emit by themselves, without what they reflect.
#include "common/voxel_counters.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 10) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = 11) writeonly buffer EmissionBuffer { vec4 face_emission[]; };

void main()
{
    // snippet: emission
    uint place = gl_GlobalInvocationID.x;
    if (place < voxel_statistics.faces) face_emission[place] = vec4(faces[place].emission.rgb, 1.0);
    // end snippet
}
