#version 450 core
// Rays of the points that gather.
#include "common/g_buffer.glsl"
#include "08_diffuse_cones/points.glsl"
#include "18_voxel_ray_marching/gather.glsl"

uniform int first_ray, last_ray;  // of this draw
layout(location = 0) out vec4 gathered;  // rgb: their part of E / pi; a: 1 where there is a surface

void main()
{
    ivec2 point = ivec2(gl_FragCoord.xy);
    GBufferSample s = read_g_buffer(min(gathering_pixel(point), ivec2(camera.size.xy) - 1));
    gathered = vec4(0.0);
    if (!s.covered) return;
    gathered.rgb = gather(grid_from_scene(s.position), s.geometric_normal, s.normal, point, first_ray, last_ray);
    gathered.a = first_ray == 0 ? 1.0 : 0.0;  // further draws add to it
}
