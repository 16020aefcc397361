#version 450 core
// Every triangle as the light sees it.
layout(location = 0) in vec3 in_position;
layout(location = 3) in vec2 in_uv0;
layout(location = 4) in vec2 in_uv1;
layout(location = 5) in vec4 in_color;
uniform mat4 clip_from_scene;
out vec2 uv0;
out vec2 uv1;
out float vertex_alpha;

void main()
{
    uv0 = in_uv0;
    uv1 = in_uv1;
    vertex_alpha = in_color.a;
    gl_Position = clip_from_scene * vec4(in_position, 1.0);
}
