// One narrow cone: a ray that leaps to where it ends, and the light there, as blurred as the cone is wide.
#include "07_anisotropic_mips/pyramid.glsl"
#include "08_diffuse_cones/walk.glsl"
#include "08_diffuse_cones/cone_common.glsl"

// The level whose voxels are as wide as a cone that is `width` voxels wide, or the next coarser one.
int level_of(float width) { return min(int(ceil(log2(max(width, 1.0)))), grid.size.w - 1); }

// Radiance that comes along `direction` from the surfaces at distance t.
// snippet: light_from
vec3 light_from(vec3 origin, vec3 direction, float t, int level)
{
    float voxel = float(1 << level);
    // Beside the bounds the border is repeated, not empty: what is outside is not known.
    vec3 low = floor(grid.content_min.xyz / voxel) + 0.5, high = floor(grid.content_max.xyz / voxel) + 0.5;
    vec3 p = clamp((origin + direction * t) / voxel, low, high), weight = abs(direction);
    ivec3 faces = ivec3(0, 2, 4) + ivec3(lessThan(direction, vec3(0.0)));
    COUNT_LIGHT_FETCHES(3 * kTexelsPerFetch)
    vec4 sum = weight.x * light_at(faces.x, p, level) + weight.y * light_at(faces.y, p, level) +
               weight.z * light_at(faces.z, p, level);
    vec3 premultiplied = light_scale * sum.rgb + EMITTED_LIGHT(faces, weight, p, level, t);
    return premultiplied / max(sum.a, 1e-5);
}
// end snippet

// `threshold`: 0 .. kStopped, see walk().
// snippet: trace_cone
ConeLight trace_cone(RayStart start, vec3 direction, float tan_half, float threshold)
{
    float light_reach = reach_of(range_diffuse), occlusion_reach = reach_of(range_ao);
    WalkEnd end = walk(start, direction, threshold, max(light_reach, occlusion_reach));
    if (!end.stopped) return ConeLight(sky_radiance, 0.0);
    float occlusion = end.t <= occlusion_reach ? occlusion_at(end.t) : 0.0;
    if (end.t > light_reach) return ConeLight(sky_radiance, occlusion);
    vec3 radiance = light_from(start.position, direction, end.t, level_of(2.0 * end.t * tan_half));
    return ConeLight(radiance, occlusion);
}
// end snippet
