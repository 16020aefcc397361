#version 450 core
// Show the voxels as cubes: what the camera's ray meets first.
#include "common/camera_ray.glsl"
#include "common/color_scales.glsl"
#include "04_conservative_voxelization/voxel_walk.glsl"

layout(binding = kPackedColorUnit) uniform usampler3D heat;
uniform int level;
uniform bool shaded, show_heat;
layout(location = 0) out vec4 color;

void main()
{
    Ray ray = camera_ray(gl_FragCoord.xy);
    float scale = exp2(-float(level));
    VoxelHit hit = walk_voxels(grid_from_scene(ray.origin) * scale, ray.direction / grid.origin.w * scale, level);
    vec3 tint = abs(hit.normal) * vec3(0.2, 0.5, 0.1) + 0.4;  // tells the sides of a cube apart
    if (show_heat) tint = count_color(float(texelFetch(heat, hit.voxel, 0).r));
    float towards_camera = max(dot(hit.normal, -ray.direction), 0.0);
    vec3 checker = vec3(0.85 + 0.15 * float((hit.voxel.x + hit.voxel.y + hit.voxel.z) & 1));
    color = hit.hit ? vec4(shaded ? tint * checker * (0.25 + 0.75 * towards_camera) : tint, 1.0) : vec4(0.0);
}
