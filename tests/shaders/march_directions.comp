#version 450 core
// Directions of chapter 18's rays, one thread a ray of a point.
#include "18_voxel_ray_marching/directions.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) writeonly buffer DirectionBuffer { vec4 directions[]; };  // w: cosine
uniform vec3 normal;

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(directions.length())) return;
    int point = int(i) / ray_count;
    vec3 d = ray_direction(normal, ray_sample(ivec2(point % 64, point / 64), int(i) % ray_count));
    directions[i] = vec4(d, dot(d, normal));
}
