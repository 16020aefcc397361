#version 450 core
// Corners of triangles on their way to the tessellator.
layout(location = 0) in vec3 in_position;
layout(location = 3) in vec2 in_uv0;
layout(location = 4) in vec2 in_uv1;
layout(location = 5) in vec4 in_color;

out vec3 vertex_position;  // scene space, m
out vec4 vertex_uv;        // xy: UV set 0, zw: UV set 1
out vec4 vertex_color;     // linear
flat out int vertex_instance;

void main()
{
    vertex_position = in_position;
    vertex_uv = vec4(in_uv0, in_uv1);
    vertex_color = in_color;
    vertex_instance = gl_InstanceID;
}
