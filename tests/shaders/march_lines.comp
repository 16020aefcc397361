#version 450 core
// What chapter 18's rays bring, one thread a ray.
#include "18_voxel_ray_marching/walk.glsl"

struct Ray {
    vec4 origin;     // xyz: grid space
    vec4 direction;  // xyz: unit
};
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer RayBuffer { Ray rays[]; };
layout(std430, binding = 1) writeonly buffer LightBuffer { vec4 arrived[]; };

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < uint(rays.length())) arrived[i] = vec4(trace(rays[i].origin.xyz, rays[i].direction.xyz), 1.0);
}
