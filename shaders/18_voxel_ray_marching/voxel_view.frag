#version 450 core
// The voxels as cubes, each with the radiance that it holds for this ray.
#define ON_PLANE 0
#define FIXED_STEPS 0
#define FACING 2
#define FALLOFF 0
#include "common/camera_ray.glsl"
#include "18_voxel_ray_marching/walk.glsl"

layout(location = 0) out vec4 color;

void main()
{
    Ray ray = camera_ray(gl_FragCoord.xy);
    vec3 radiance = trace(grid_from_scene(ray.origin), ray.direction);
    color = radiance.r < 0.0 ? vec4(0.0) : vec4(radiance, 1.0);  // no surface: the sky of this view is -1
}
