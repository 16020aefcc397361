// Light of emitting surfaces by rays that are aimed at them: taught in chapter 11, used by later ones.
#include "common/brdf.glsl"
#include "common/diffuse_gather.glsl"

layout(std430, binding = kEmitterBinding) readonly buffer EmitterBuffer { EmitterPart emitters[]; };
layout(binding = kOccupancyUnit) uniform usampler3D occupancy;
uniform int emitters_per_set;

// Rays end this far in front of an emitter, in voxels, where its own blur and that of what it hangs on do not hide it.
const float kLift = 1.5;
// Coverage that a ray has entered before what it leaves counts: the rim of a surface that it passes is not entered.
const float kEntered = 0.25;

vec3 coverage_of(ivec3 faces, vec3 p, vec3 size)
{
    return vec3(fetch_coverage(faces.x, p, size, 0), fetch_coverage(faces.y, p, size, 0),
                fetch_coverage(faces.z, p, size, 0));
}

// How far a ray at p may go, in voxels, because the block of 8 x 8 x 8 voxels around p is empty. Samples half a voxel from
// its sides already mix in what is beyond them.
float empty_way(vec3 p, vec3 direction)
{
    const float kBlock = 8.0;
    if (grid.size.w <= 3 || texelFetch(occupancy, ivec3(p) >> 3, 3).r != 0u) return 0.0;
    vec3 to_side = mix(fract(p / kBlock), 1.0 - fract(p / kBlock), greaterThan(direction, vec3(0.0))) * kBlock;
    vec3 way = (to_side - 0.5) / max(abs(direction), vec3(1e-6));
    return min(way.x, min(way.y, way.z)) - 0.5;
}

// Share of the light that the voxels leave open on the way. Coverages add up to 1 in a wall that lies along the axes; in
// a slanted one the filter's ripple leaves a third in places (0.67 to 1.33 at 45 degrees). But what enters a solid leaves
// it again, at a place of another phase: the larger of both sums is what it covers.
// snippet: open_share
float open_share(Cone ray, float end)
{
    vec3 size = vec3(level_size(0)), d = abs(ray.direction);
    vec3 low = floor(grid.content_min.xyz) + 0.5, high = floor(grid.content_max.xyz) + 0.5;
    ivec3 against = ivec3(0, 2, 4) + ivec3(lessThan(ray.direction, vec3(0.0))), along = against ^ 1;
    float rise = dot(ray.sheet_axis, d), leave = dot(ray.normal, ray.direction), entered = 0.0, left = 0.0;
    for (float t = 0.0; t < end && max(entered, left) < 1.0 - kNearlyStopped;) {
        float stride = min(end - t, 1.0), middle = t + 0.5 * stride;
        vec3 p = clamp(ray.origin + ray.direction * middle, low, high);
        t += max(stride, empty_way(p, ray.direction));
        vec3 weight = stride * d * (1.0 - ray.sheet_axis * step(middle * rise, kBlur));
        vec3 facing = coverage_of(against, p, size);
        if (middle * leave < kBlur) facing *= not_own(facing, ray.normal, ray.direction, p, size, 0);
        entered += dot(weight, facing);
        if (entered > kEntered) left += dot(weight, coverage_of(along, p, size));
    }
    float covered = max(entered, left);
    return covered < 1.0 - kNearlyStopped ? 1.0 - covered : 0.0;
}
// end snippet

// E / pi of the emitters' far share: the sum over parts of L A cos cos' / (pi d^2), each by what is open on the way. Near
// a part the disc of its area stands for it: L A / (d^2 + A / pi) is exact on the disc's axis, and finite.
// snippet: gather_emitters
vec3 gather_emitters(vec3 position_grid, vec3 geometric_normal, vec3 normal, int neighbour)
{
    int first = neighbour % cone_sets * emitters_per_set;
    vec3 sum = vec3(0.0);
    for (int i = first; i < first + emitters_per_set; ++i) {
        EmitterPart part = emitters[i];
        vec3 to_part = part.position.xyz - position_grid;
        float d2 = dot(to_part, to_part);
        vec3 direction = to_part * inversesqrt(max(d2, 1e-6));
        float facing = max(dot(normal, direction), 0.0) * max(-dot(part.normal.xyz, direction), 0.0);
        if (facing <= 0.0 || dot(geometric_normal, direction) <= 0.0) continue;
        Cone ray = cone_above(position_grid, geometric_normal, start_offset, direction, 0.0);
        vec3 way = part.position.xyz + kLift * part.normal.xyz - ray.origin;
        float end = length(way);
        ray.direction = way / max(end, 1e-6);
        float far_share = 1.0 - near_share(sqrt(d2));
        sum += part.intensity.rgb * (facing * far_share * open_share(ray, end) / (kPi * (d2 + part.position.w)));
    }
    return float(cone_sets) * sum;  // a set holds 1 / cone_sets of the parts
}
// end snippet
