#version 450 core
// The largest radiance that any face gives to the pyramid: what the eight bits of a channel are a share of.
#include "common/voxel_structs.glsl"
#include "common/voxel_counters.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kRadianceBinding) readonly buffer RadianceBuffer { vec4 face_radiance[]; };
// Float bits, which have the floats' order from 0 up.
layout(std430, binding = kLightScaleBinding) buffer ScaleBuffer { uint largest; };

uniform vec2 part;  // of radiance and emission, as in light_base.comp

void main()
{
    if (gl_GlobalInvocationID.x >= voxel_statistics.faces) return;
    uint place = gl_GlobalInvocationID.x;
    vec3 radiance = part.x * face_radiance[place].rgb + part.y * faces[place].emission.rgb;
    atomicMax(largest, floatBitsToUint(max(max(radiance.r, 0.0), max(radiance.g, radiance.b))));
}
