#version 450 core
// From points to pixels: the four points around a pixel, each by its bilinear weight where it lies on the pixel's
// surface. A pixel that none of them fits traces rays of its own, as many as a draw can.
#include "common/g_buffer.glsl"
#include "08_diffuse_cones/points.glsl"
#include "18_voxel_ray_marching/gather.glsl"

layout(binding = 17) uniform sampler2D gathered_light;
layout(location = 0) out vec4 gathered;  // rgb: E / pi; a: 1 where there is a surface

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GBufferSample s = read_g_buffer(pixel);
    gathered = vec4(0.0);
    if (!s.covered) return;
    vec3 position = grid_from_scene(s.position);
    PointWeights points = points_around(pixel, position, s.geometric_normal, s.normal);
    for (int i = 0; i < 4; ++i) gathered += points.weight[i] * texelFetch(gathered_light, points.place[i], 0);
    if (points.sum > 0.0) return;
    gathered = vec4(gather(position, s.geometric_normal, s.normal, pixel, 0, ray_count), 1.0);
}
