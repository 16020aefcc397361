// The naive way, for comparison: a cone that marches through the pyramids in steps as long as it is wide, whether there
// is something or not.
#include "07_anisotropic_mips/pyramid.glsl"
#include "08_diffuse_cones/walk.glsl"
#include "08_diffuse_cones/cone_common.glsl"

uniform float step_factor;        // step over the diameter of the cone, or over a voxel where the cone is thinner
uniform int transmittance_model;  // 0: linear, 1: exponential, 2: per sample
uniform bool squared_weights;     // of a voxel's sides: d^2 instead of |d|

// What a cone meets in a voxel's length: the three faces that look against the direction, each by |d_a|, its projected
// area, or by d_a^2, for comparison. a: coverage, rgb: radiance premultiplied with it.
vec4 sample_level(vec3 position, vec3 direction, int level, float t)
{
    float voxel = float(1 << level);
    vec3 low = floor(grid.content_min.xyz / voxel) + 0.5, high = floor(grid.content_max.xyz / voxel) + 0.5;
    vec3 q = position / voxel, p = clamp(q, low, high);
    // Along its own axis what lies on the bounds fades out beyond them as in any linear filter.
    vec3 inside = step(grid.content_min.xyz, position) * step(position, grid.content_max.xyz);
    vec3 side = abs(direction) * (squared_weights ? abs(direction) : vec3(1.0));
    vec3 weight = side * max(1.0 - abs(q - p), vec3(0.0)) * inside.yzx * inside.zxy;
    ivec3 faces = ivec3(0, 2, 4) + ivec3(lessThan(direction, vec3(0.0)));
    COUNT_LIGHT_FETCHES(3 * kTexelsPerFetch)
    vec4 sum = weight.x * light_at(faces.x, p, level) + weight.y * light_at(faces.y, p, level) +
               weight.z * light_at(faces.z, p, level);
    return sum + vec4(EMITTED_LIGHT(faces, weight, p, level, t) / light_scale, 0.0);
}

// How much of a cone a step stops that runs through the coverage A (it may exceed 1), `open` of the cone being left.
// linear: what the filter has spread over neighbouring voxels belongs together. A wall blurred over two voxels covers u
// here and 1 - u there, 1 in all, and stops the cone wholly (Vicini et al. 2021, section 4).
// exponential: as in a fog of twice the depth that covers A, tau = -2 ln(1 - A), so that (1 - A)^2 stays open; a
// blurred wall leaks (u (1 - u))^2, at most 1/16.
// snippet: stopped_share
float stopped_share(float coverage, float open)
{
    if (transmittance_model == 0) return min(coverage, open);
    return open * (1.0 - pow(1.0 - min(coverage, 0.999), 2.0));
}
// end snippet

// As published (Villegas 2016, section 3.6; occlusion: section 3.6.3, by the cone's radius): from a voxel along the
// direction on, every sample stops its opacity of what is left of the cone. The step is not in it: with half the step
// twice as much is stopped.
// snippet: per_sample
ConeLight trace_per_sample(RayStart start, vec3 direction, float tan_half)
{
    const float kLeastStep = 0.0625;  // voxels; there is none in print, and thin cones would never end
    float exit = exit_distance(start.position, direction, 0.0), occlusion = 0.0, opacity = 0.0;
    float end = exit_distance(start.position, direction, max(2.0 * exit * tan_half, 1.0));
    vec3 radiance = vec3(0.0);
    for (float t = 1.0; t < end && opacity < 1.0;) {
        float diameter = 2.0 * t * tan_half, lod = clamp(log2(max(diameter, 1.0)), 0.0, float(grid.size.w - 1));
        int level = int(lod), next = min(level + 1, grid.size.w - 1);
        vec3 position = start.position + direction * t;
        vec4 met = mix(sample_level(position, direction, level, t), sample_level(position, direction, next, t),
                       lod - float(level));
        float stopped = (1.0 - opacity) * min(met.a, 1.0);
        radiance += light_scale * met.rgb * (stopped / max(met.a, 1e-6));
        opacity += stopped;
        occlusion += (1.0 - occlusion) * min(met.a, 1.0) * occlusion_at(0.5 * diameter);
        t += max(diameter * step_factor, kLeastStep);
    }
    return ConeLight(radiance + (1.0 - opacity) * sky_radiance, occlusion);
}
// end snippet

ConeLight trace_cone(RayStart start, vec3 direction, float tan_half, float threshold)
{
    if (transmittance_model == 2) return trace_per_sample(start, direction, tan_half);
    // Cones end where they have left the bounds by their own width: a wall there has then been passed wholly.
    float exit = exit_distance(start.position, direction, 0.0);
    float end = exit_distance(start.position, direction, max(2.0 * exit * tan_half, 1.0));
    vec3 radiance = vec3(0.0);
    float occlusion = 0.0, open = 1.0, t = 0.0;
    // snippet: march
    while (t < end && open > 0.0) {
        float stride = min(max(2.0 * t * tan_half, 1.0) * step_factor, end - t + 1e-3), middle = t + 0.5 * stride;
        float lod = log2(max(2.0 * middle * tan_half, 1.0));
        int level = min(int(lod), grid.size.w - 1), next = min(level + 1, grid.size.w - 1);
        vec3 position = start.position + direction * middle;
        vec4 met = mix(sample_level(position, direction, level, middle) / float(1 << level),
                       sample_level(position, direction, next, middle) / float(1 << next), lod - float(level)) * stride;
        float stopped = stopped_share(met.a, open);
        if (open - stopped < 1.0 - kStopped) stopped = open;  // an error of the steps, no gap
        radiance += light_scale * met.rgb * (stopped / max(met.a, 1e-6));
        occlusion += stopped * occlusion_at(middle);
        open -= stopped;
        t += stride;
    }
    // end snippet
    // What is left of a cone that leaves the bounds through a wall is an error of the steps.
    if (open > 0.0 && closed_at(walk_ray(start.position, direction), start.position, exit)) {
        vec4 wall = sample_level(start.position + direction * exit, direction, 0, exit);
        radiance += open * light_scale * wall.rgb / max(wall.a, 1e-6);
        occlusion += open * occlusion_at(exit);
        open = 0.0;
    }
    return ConeLight(radiance + open * sky_radiance, occlusion);
}
