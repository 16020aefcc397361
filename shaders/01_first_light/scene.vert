#version 450 core
// Every triangle of the scene, as the camera sees it. Positions are in scene space already (see common/scene).
#include "common/scene.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec2 in_uv0;
layout(location = 4) in vec2 in_uv1;
layout(location = 5) in vec4 in_color;

out vec3 vertex_position;
out vec3 vertex_normal;
out vec4 vertex_tangent;
out vec2 vertex_uv0;
out vec2 vertex_uv1;
out vec4 vertex_color;

void main()
{
    vertex_position = in_position;
    vertex_normal = in_normal;
    vertex_tangent = in_tangent;
    vertex_uv0 = in_uv0;
    vertex_uv1 = in_uv1;
    vertex_color = in_color;
    gl_Position = camera.clip_from_scene * vec4(in_position, 1.0);
}
