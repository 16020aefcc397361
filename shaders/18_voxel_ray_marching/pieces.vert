#version 450 core
// The streamed out list, drawn as points: their words are attributes.
#include "common/camera.glsl"

layout(location = 0) in uvec4 place;  // Piece
layout(location = 1) in uvec4 light;
flat out vec3 radiance;

void main()
{
    radiance = uintBitsToFloat(light.xyz);
    gl_Position = camera.clip_from_scene * vec4(uintBitsToFloat(place.xyz), 1.0);
}
