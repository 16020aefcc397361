#version 450 core
// Show one level and direction of the pyramid: radiance, or coverage of the voxel's cross-section.
#include "common/camera_ray.glsl"
#include "04_conservative_voxelization/voxel_walk.glsl"
#include "07_anisotropic_mips/pyramid.glsl"

uniform bool with_emission;  // it has an atlas of its own
uniform int level;
uniform int direction;   // 0..5 a face, 6: the side that the ray came in through
uniform bool show_coverage;
layout(location = 0) out vec4 color;

void main()
{
    Ray ray = camera_ray(gl_FragCoord.xy);
    float scale = exp2(-float(level));
    VoxelHit hit = walk_voxels(grid_from_scene(ray.origin) * scale, ray.direction / grid.origin.w * scale, level);
    color = vec4(0.0);
    if (!hit.hit) return;
    ivec3 axis_of = ivec3(0, 1, 2);
    int axis = int(dot(abs(hit.normal), vec3(axis_of)) + 0.5);
    int face = direction < kFaceCount ? direction : 2 * axis + (hit.normal[axis] > 0.0 ? 1 : 0);
    vec4 texel = light_of(face, hit.voxel, level);
    vec3 radiance = texel.a > 0.0 ? light_scale * texel.rgb / texel.a : vec3(0.0);
    if (with_emission && texel.a > 0.0) radiance += emission_of(face, hit.voxel, level) / texel.a;
    color = vec4(show_coverage ? texel.aaa : radiance, 1.0);
}
