#version 450 core
// Arrows that show where lights are and which way they send: two ends a line.
#include "common/camera.glsl"

layout(location = 0) in vec4 in_position;  // xyz: scene space
layout(location = 1) in vec4 in_color;
flat out vec3 line_color;

void main()
{
    line_color = in_color.rgb;
    gl_Position = camera.clip_from_scene * vec4(in_position.xyz, 1.0);
}
