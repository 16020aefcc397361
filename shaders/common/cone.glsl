// Follow a cone through the pyramids: taught in chapter 08, used by every later one.
#include "common/pyramid.glsl"

#if PLAIN
layout(binding = kDirectionVolumeUnit) uniform sampler3D direction_volume[6];
#endif

// EMITTED: what surfaces emit has an atlas of its own, beside that of what they reflect, and of an emitter far away cones
// gather a part only; the rest is aimed at (chapter 11).
#if EMITTED
layout(binding = kEmissionAtlasUnit) uniform sampler3D emission_atlas;
uniform float near_radius2;  // voxels squared
// Power heuristic (Veach 1997, 9.2.2.2) of the densities n / pi of cones and n t^2 / A of parts of an emitter of area
// A = pi r^2, without the cosines, of which neither knows both; moved so that it ends, at 2.6 r.
float near_share(float t)
{
    const float kEnd = 0.02;
    float q = t * t / near_radius2;
    return max((1.0 / (1.0 + q * q) - kEnd) / (1.0 - kEnd), 0.0);
}
#else
float near_share(float t) { return 1.0; }
#endif

uniform float step_factor;        // step over the diameter of the cone, or over a voxel where the cone is thinner
uniform float ao_falloff;         // 1/m, lambda of ambient occlusion
uniform vec3 sky_radiance;        // W/(sr m^2), what leaves the grid sees
uniform int transmittance_model;  // 0: linear, 1: exponential

struct Cone {
    vec3 origin;      // grid space
    vec3 direction;   // unit
    float tan_half;   // tangent of half the aperture
    vec3 normal;      // of the surface that it starts from
    vec3 sheet_axis;  // the axis of that surface, times how much of a thin sheet it is; 0 otherwise
};

struct ConeLight {
    vec3 radiance;        // mean over the cone, W/(sr m^2), without the sky
    float transmittance;  // share of the cone that reaches its end
    float ambient;        // occlusion weighted by 1 / (1 + lambda r), 0..1
};

#ifdef COUNT_FETCHES
uint fetches = 0u;  // from textures, by this invocation: chapter 14
#endif

void count_fetches(int count)
{
#ifdef COUNT_FETCHES
    fetches += uint(count);
#endif
}

// snippet: fetch
// `with_emission`: a constant; `near`: share of what is emitted that counts, where it is kept apart.
vec4 fetch(int face, vec3 p, vec3 size, int level, bool with_emission, float near)
{
    vec3 uvw = vec3((p.x / size.x + float(face)) / 6.0, p.yz / size.yz);
    count_fetches(kFetchesPerTexel);
#if PLAIN
    vec4 light = vec4(0.0);
    for (int i = 0; i < 6; ++i)
        if (i == face) light = textureLod(direction_volume[i], p / size, float(level));
#else
    vec4 light = stored_light(uvw, float(level));
#endif
#if EMITTED
    if (!with_emission) return light;
    count_fetches(1);
    light.rgb += near / light_scale * textureLod(emission_atlas, uvw, float(level)).rgb;
#endif
    return light;
}
// end snippet

// Coverage alone; p in voxels of the level.
float fetch_coverage(int face, vec3 p, vec3 size, int level)
{
    count_fetches(1);
#if PLAIN
    for (int i = 0; i < 6; ++i)
        if (i == face) return textureLod(direction_volume[i], p / size, float(level)).a;
    return 0.0;
#else
    return stored_coverage(vec3((p.x / size.x + float(face)) / 6.0, p.yz / size.yz), float(level));
#endif
}

// How far outside the bounds, in level voxels, the walls of the other axes still count. Measured with 0, 0.2, 0.5: a
// white furnace turned by 45 degrees (64 voxels) gets 0.987, 0.995, 0.997 of its light; the Cornell box (128, blocks of
// 4 x 4, one bounce) 1.003, 1.005, 1.009 of the true one, SMAPE 0.0491, 0.0489, 0.0523.
const float kCornerMargin = 0.2;

// A slanted surface shows some of its faces to a cone that leaves it: those across the axes along which the cone goes back
// (n_a d_a < 0). Exactly, n.d > 0, it shows nothing. How much of it is at a place is known from its faces across the axis
// b that the normal is nearest to of those along which the cone goes forward: coverage A_b = s |n_b|, so s |n_a| on the
// others. Share of the coverage `met` that is not the surface's own.
vec3 not_own(vec3 met, vec3 normal, vec3 direction, vec3 p, vec3 size, int level)
{
    vec3 forward = normal * direction, n = abs(normal) * step(0.0, forward);
    int b = n.x >= n.y && n.x >= n.z ? 0 : n.y >= n.z ? 1 : 2;
    float s = fetch_coverage(2 * b + (normal[b] > 0.0 ? 1 : 0), p, size, level) / max(n[b], 0.1);
    vec3 own = s * abs(normal) * step(forward, vec3(0.0));
    return clamp(1.0 - own / max(met, vec3(1e-4)), 0.0, 1.0);
}

// What a cone meets in a voxel's length: the three faces that look against the direction, each by |d_a|, since what
// oriented surfaces cover goes with their projected area (Jakob et al. 2010, section 3). a: coverage, rgb: radiance
// premultiplied with it. `axes`: 1 for those that count; `leaving`, a constant: the cone is still in the blur of its own
// surface; `with_emission` and `near` as above.
vec4 sample_level(vec3 position, Cone cone, int level, vec3 axes, bool leaving, bool with_emission, float near)
{
    float voxel = float(1 << level);
    vec3 size = vec3(level_size(level));
    // Beside the bounds the border is repeated, not empty: what is outside is not known.
    vec3 low = floor(grid.content_min.xyz / voxel) + 0.5, high = floor(grid.content_max.xyz / voxel) + 0.5;
    vec3 p = clamp(position / voxel, low, high);
    // Across its own axis a wall on the bounds is met where it is, and not in the middle of the coarse voxel that holds
    // it: the bounds are moved to the middles of the outermost voxels, smoothly, so that near them lengths stay.
    vec3 extent = max(grid.content_max.xyz - grid.content_min.xyz, vec3(1e-3));
    vec3 share = smoothstep(vec3(0.0), vec3(1.0), (position - grid.content_min.xyz) / extent);
    vec3 across = position / voxel + mix(low - grid.content_min.xyz / voxel, high - grid.content_max.xyz / voxel, share);
    across = clamp(across, low, high);
    // Outside along one axis, only walls across that axis can still be in the way. In the corners two walls share a
    // voxel, so a little way out both count.
    vec3 margin = vec3(kCornerMargin * voxel);
    vec3 inside = step(grid.content_min.xyz - margin, position) * step(position, grid.content_max.xyz + margin);
    // Along its own axis what lies on the bounds fades out beyond them as in any linear filter, so that its coverages add
    // up to what it covers.
    vec3 outside = max(max(grid.content_min.xyz - position, position - grid.content_max.xyz), vec3(0.0)) / voxel;
    vec3 weight = axes * abs(cone.direction) * max(1.0 - outside, vec3(0.0)) * inside.yzx * inside.zxy;
    ivec3 face = ivec3(0, 2, 4) + ivec3(lessThan(cone.direction, vec3(0.0)));
    vec4 x = fetch(face.x, vec3(across.x, p.yz), size, level, with_emission, near);
    vec4 y = fetch(face.y, vec3(p.x, across.y, p.z), size, level, with_emission, near);
    vec4 z = fetch(face.z, vec3(p.xy, across.z), size, level, with_emission, near);
    if (leaving && cone.normal != vec3(0.0))
        weight *= not_own(vec3(x.a, y.a, z.a), cone.normal, cone.direction, p, size, level);
    return weight.x * x + weight.y * y + weight.z * z;
}

// Voxels of a level to either side that a surface may be blurred over: one by linear interpolation, half a one for where
// in its voxel it lies. Measured with 0.5, 1, 1.5, 2: a thin wall (128) lets through 1.14, 1.07, 1.04, 1.04 % of the
// light on its other side, and a floor tilted by 40 degrees lights itself by 0.14, 0.05, 0.05, 0.05 %.
const float kBlur = 1.5;

// Distance along the ray to where it leaves the scene's bounds, moved out by `margin`; all in voxels.
float exit_distance(vec3 origin, vec3 direction, float margin)
{
    vec3 d = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    vec3 far_side = mix(grid.content_min.xyz - margin, grid.content_max.xyz + margin, greaterThan(d, vec3(0.0)));
    vec3 t = (far_side - origin) / d;
    return max(min(t.x, min(t.y, t.z)), 0.0);
}

// How much of a cone a step stops that runs through the coverage A (it may exceed 1), `open` of the cone being left.
// linear: what the filter has spread over neighbouring voxels belongs together. A wall blurred over two voxels covers u
// here and 1 - u there, 1 in all, and stops the cone wholly, in the mean where it is; what covers a third stops a third,
// however it is spread (linear transmittance of opaque surfaces: Vicini et al. 2021, section 4).
// exponential: as in a fog, with twice the depth so that a blurred wall leaks little: tau = -2 ln(1 - A).
// snippet: stopped_share
float stopped_share(float coverage, float open)
{
    if (transmittance_model == 0) return min(coverage, open);
    return open * (1.0 - pow(1.0 - min(coverage, 0.999), 2.0));
}
// end snippet

// What is left of a cone that leaves the bounds through a wall is an error of the steps, or was begun inside the blurred
// wall: the wall stops it. Where the bounds are open, or covered in part, it goes on to the sky.
// Coverage from which on the bounds count as a wall, fully so at 1; lower values would close openings. With 0.5, 0.8, 0.95
// a white furnace turned by 45 degrees (64) gets 0.996, 0.995, 0.994 of its light, 0.993 if nothing is closed; a straight
// one 1.000, and 0.996 if nothing is closed.
const float kClosed = 0.8;

void close_at_bounds(Cone cone, inout ConeLight light)
{
    float exit = exit_distance(cone.origin, cone.direction, 0.0);
    int level = clamp(int(log2(max(2.0 * exit * cone.tan_half, 1.0))), 0, grid.size.w - 1);
    vec3 position = cone.origin + cone.direction * exit;
    vec3 to_bounds = mix(position - grid.content_min.xyz, grid.content_max.xyz - position,
                         greaterThan(cone.direction, vec3(0.0)));
    vec3 a = abs(to_bounds);
    vec3 axis = a.x <= a.y && a.x <= a.z ? vec3(1, 0, 0) : a.y <= a.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    Cone across = cone;
    across.direction = mix(vec3(-1.0), vec3(1.0), greaterThan(cone.direction, vec3(0.0)));
    vec4 wall = sample_level(position, across, level, axis, false, true, near_share(exit));
    float stopped = light.transmittance * smoothstep(kClosed, 1.0, wall.a);
    light.radiance += wall.rgb * (stopped / max(wall.a, 1e-6));
    light.ambient += stopped / (1.0 + ao_falloff * exit * grid.origin.w);
    light.transmittance -= stopped;
}

// Steps meet a wall's coverage with an error of up to a tenth: what is left of a cone after that is no gap. With 0, 0.1, 0.2
// a thin wall (64) lets through 1.5, 1.3 and 1.1 %, a turned white furnace gets 0.983, 0.989, 0.995 of its light, and the
// Cornell box has SMAPE 0.0491, 0.0489, 0.0490; but what covers nine tenths may be nine tenths of a wall and a gap.
const float kNearlyStopped = 0.1;

// March along the axis in steps as long as the cone is wide, from t to the end of one part of the way. Fetches that only
// one part needs are left out of the loops of the others: a branch would be taken by all pixels of a group.
void march(inout ConeLight light, inout float t, Cone cone, float end, bool leaving, bool with_emission)
{
    float rise = dot(cone.sheet_axis, abs(cone.direction)), leave = dot(cone.normal, cone.direction);
    while (t < end && light.transmittance > 0.0) {
        float width = max(2.0 * t * cone.tan_half, 1.0);
        if (leaving && t * leave > kBlur * 2.0 * width || with_emission && !leaving && near_share(t) == 0.0) break;
        // snippet: march
        float stride = min(width * step_factor, end - t + 1e-3), middle = t + 0.5 * stride;
        float lod = log2(max(2.0 * middle * cone.tan_half, 1.0));
        int level = min(int(lod), grid.size.w - 1), next = min(level + 1, grid.size.w - 1);
        float blend = lod - float(level), near = near_share(middle);
        vec3 position = cone.origin + cone.direction * middle;
        vec3 axes = 1.0 - cone.sheet_axis * step(middle * rise, kBlur * float(1 << next));
        vec4 met = (1.0 - blend) * stride / float(1 << level) *
                       sample_level(position, cone, level, axes, leaving, with_emission, near) +
                   blend * stride / float(1 << next) *
                       sample_level(position, cone, next, axes, leaving, with_emission, near);
        float stopped = stopped_share(met.a, light.transmittance);
        if (light.transmittance - stopped < kNearlyStopped) stopped = light.transmittance;
        light.radiance += met.rgb * (stopped / max(met.a, 1e-6));
        light.ambient += stopped / (1.0 + ao_falloff * middle * grid.origin.w);
        light.transmittance -= stopped;
        t += stride;
        // end snippet
    }
}

// snippet: trace_cone
ConeLight trace_cone(Cone cone, float end)
{
    ConeLight light = ConeLight(vec3(0.0), 1.0, 0.0);
    float t = 0.0;
    march(light, t, cone, end, true, true);    // out of the blur of its own surface
#if EMITTED
    march(light, t, cone, end, false, true);   // while emitters count
#endif
    march(light, t, cone, end, false, false);
    close_at_bounds(cone, light);
    light.radiance *= light_scale;
    return light;
}
// end snippet

// A cone above a surface. It starts `offset` voxels beyond the middle of the surface's own voxel along the axis that the
// normal is nearest to. A thin sheet has a face on its other side in the same voxel; the cone leaves it out until it has
// risen above its blur.
Cone cone_above(vec3 position_grid, vec3 geometric_normal, float offset, vec3 direction, float tan_half)
{
    vec3 n = abs(geometric_normal);
    vec3 axis = n.x >= n.y && n.x >= n.z ? vec3(1, 0, 0) : n.y >= n.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    float along = dot(axis, geometric_normal);
    // Rounding must not decide between two voxels for a surface on the side between them: take the farther start.
    vec3 voxel_middle = floor(position_grid + 0.01 * sign(along) * axis) + 0.5;
    float from_middle = dot(axis, voxel_middle - position_grid);
    vec3 origin = position_grid + geometric_normal * (from_middle / along + offset / abs(along));
    int back = int(dot(axis, vec3(0.0, 2.0, 4.0))) + (along > 0.0 ? 0 : 1);
    float sheet = fetch_coverage(back, voxel_middle, vec3(level_size(0)), 0);
    return Cone(origin, direction, tan_half, geometric_normal, sheet * axis);
}

// Cones end where they have left the bounds by their own width: a wall there has then been passed wholly.
float cone_end(Cone cone)
{
    float exit = exit_distance(cone.origin, cone.direction, 0.0);
    return exit_distance(cone.origin, cone.direction, max(2.0 * exit * cone.tan_half, 1.0));
}
