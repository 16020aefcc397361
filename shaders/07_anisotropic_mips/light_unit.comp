#version 450 core
// What the pyramid keeps radiance in units of. Eight bits: the largest that any face gives to it. Floats: the power of
// two that brings the largest below what their five bits of exponent hold, so that nothing else changes. It is 1 as it
// begins. FORMAT as in store_light.glsl.
#include "common/item_index.glsl"
#include "common/voxel_structs.glsl"
#include "common/voxel_counters.glsl"

layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kRadianceBinding) readonly buffer RadianceBuffer { vec4 face_radiance[]; };
// Float bits, which have the floats' order from 0 up.
layout(std430, binding = kLightScaleBinding) buffer ScaleBuffer { uint unit; };

uniform vec2 part;  // of radiance and emission, as in light_base.comp

void main()
{
    if (item_index() >= voxel_statistics.faces) return;
    uint place = item_index();
    vec3 radiance = part.x * face_radiance[place].rgb + part.y * faces[place].emission.rgb;
    float brightest = max(max(radiance.r, 0.0), max(radiance.g, radiance.b));
#if FORMAT == 1
    atomicMax(unit, floatBitsToUint(brightest));
#else
    const float kLargest = 64512.0;  // of r11g11b10f; 65504 of half floats
    // Rounded up to a power of two: a mantissa of 0.
    if (brightest > kLargest) atomicMax(unit, (floatBitsToUint(brightest / kLargest) + 0x7fffffu) & 0x7f800000u);
#endif
}
