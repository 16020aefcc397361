#version 450 core
// Where rays end, for tests: the walk of chapter 08 with its thresholds, without cones around it. One thread a ray.
#include "08_diffuse_cones/gather.glsl"

struct Ray {
    vec4 origin;     // xyz: grid space, w: number of the cone, which has its threshold
    vec4 direction;  // xyz: unit
};
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer RayBuffer { Ray rays[]; };
layout(std430, binding = 1) writeonly buffer EndBuffer { vec2 ends[]; };  // 1 where it is stopped, distance in voxels

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= uint(rays.length())) return;
    RayStart start = RayStart(rays[i].origin.xyz, vec3(0.0), vec3(0.0));
    WalkEnd end = walk(start, rays[i].direction.xyz, threshold_of(int(rays[i].origin.w)));
    ends[i] = vec2(end.stopped ? 1.0 : 0.0, end.t);
}
