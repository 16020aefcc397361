#version 450 core
// Every triangle of the scene as a face of a hemicube sees it. Three vertices a triangle, none of them shared.
layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;  // of the triangle, any length

uniform mat4 clip_from_scene;
uniform vec3 eye;
uniform vec4 clip_plane;

flat out uint triangle_and_side;
out vec2 barycentrics;

const uint kBack = 0x80000000u;         // Item::kBack
const float kBehindItsFront = 0.99999;  // of 1 / depth

void main()
{
    bool front = dot(in_normal, eye - in_position) >= 0.0;
    triangle_and_side = (uint(gl_VertexID / 3) + 1u) | (front ? 0u : kBack);
    barycentrics = vec2(gl_VertexID % 3 == 1, gl_VertexID % 3 == 2);
    gl_Position = clip_from_scene * vec4(in_position, 1.0);
    // Where a back and a front coincide (a wall of two quads), the front is what is seen.
    if (!front) gl_Position.z *= kBehindItsFront;
    gl_ClipDistance[0] = dot(clip_plane, vec4(in_position, 1.0));
}
