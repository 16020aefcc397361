#version 450 core
// Direct light with soft shadows: chapter 10's thin cones to every light, through the octree.
#include "common/g_buffer.glsl"
#include "common/brdf.glsl"
#include "17_sparse_voxel_octree/cone.glsl"

#define OWN_OPEN_SHARE
// Share of a thin cone that is open on a way of `length` voxels; the leaves decide.
// snippet: open_share
float open_share(RayStart start, vec3 direction, float length)
{
    TreeRay ray = tree_ray(start.position, direction);
    float own_end = own_blur_end(start, direction), end = min(length, ray.exit), t = 0.0, open = 1.0;
    while (t < end && open >= 1.0 - kStopped) {
        ConeStep s = cone_step(ray, start, own_end, 0.0, t, end);
        open -= s.met.a;
        t = s.end;
    }
    if (length >= ray.exit) open -= beyond_root(ray, 0.0).a;
    return open >= 1.0 - kStopped ? open : 0.0;
}
// end snippet
#include "10_soft_shadows/shadow_cone.glsl"

layout(location = 0) out vec4 color;

void main()
{
    GBufferSample surface = read_g_buffer(ivec2(gl_FragCoord.xy));
    color = vec4(0.0);
    if (!surface.covered) return;
    vec3 view = view_direction(surface.position), radiance = vec3(0.0);
    for (int i = 0; i < light_count; ++i) {
        LightSample light = sample_light(lights[i], surface.position);
        // A light whose middle is below the surface's horizon is hidden by the surface itself.
        if (dot(light.direction, surface.geometric_normal) <= 0.0) continue;
        radiance += cone_visibility(surface.position, surface.geometric_normal, light) *
                    reflected_radiance(surface.normal, view, light.direction, light.irradiance, surface.albedo,
                                       surface.roughness, surface.f0, surface.f90);
    }
    color = vec4(radiance, 1.0);
}
