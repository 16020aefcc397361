#version 450 core
// Patches as the camera sees them, a value at each corner.
#include "common/camera.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_value;

out vec3 position;  // scene space, m
out vec3 value;

void main()
{
    position = in_position;
    value = in_value;
    gl_Position = camera.clip_from_scene * vec4(in_position, 1.0);
}
