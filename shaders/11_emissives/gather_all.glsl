// Both ways to emitters: cones meet those nearby, rays are aimed at those far away.
#include "11_emissives/emitted_light.glsl"
#include "08_diffuse_cones/gather.glsl"
#include "11_emissives/aimed.glsl"

Gathered gather_all(RayStart start, vec3 geometric_normal, vec3 normal, vec3 position_grid, int set)
{
    Gathered sum = gather_diffuse(start, geometric_normal, normal, set);
    sum.mean_radiance += gather_emitters(start, geometric_normal, normal, position_grid, set);
    return sum;
}
#define GATHER(start, geometric_normal, normal, position_grid, set) \
    gather_all(start, geometric_normal, normal, position_grid, set)
