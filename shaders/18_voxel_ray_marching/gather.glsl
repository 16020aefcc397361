// The mean over the rays of a point: E / pi.
#include "18_voxel_ray_marching/directions.glsl"
#include "18_voxel_ray_marching/walk.glsl"

// Rays first, first + 1, ..., last - 1 of ray_count.
// snippet: gather
vec3 gather(vec3 position_grid, vec3 geometric_normal, vec3 normal, ivec2 point, int first, int last)
{
    vec3 sum = vec3(0.0);
    for (int i = first; i < last; ++i) {
        vec3 direction = ray_direction(normal, ray_sample(point, i));
        // Nothing comes from below the surface, whatever its shading normal says.
        if (dot(direction, geometric_normal) > 0.0) sum += trace(position_grid, direction);
    }
    return sum / float(ray_count);
}
// end snippet
