// Light of emitting surfaces: exactly where nothing is in the way, and by rays aimed at parts of them which share of it
// arrives. Included after 08_diffuse_cones/walk.glsl and cone_common.glsl.
// TRIANGLES 1: the emitters are few triangles of even radiance; 0: the parts stand for them.
#include "common/frame.glsl"

layout(std430, binding = kEmitterBinding) readonly buffer EmitterPartBuffer { EmitterPart emitter_parts[]; };
layout(std430, binding = kEmitterTriangleBinding) readonly buffer EmitterTriangleBuffer { EmitterTriangle emitter_triangles[]; };
uniform int emitter_triangle_count;
uniform int aimed_part_count;   // of all sets; the parts behind them stand for emitters that are no few triangles
uniform int emitter_part_count;
uniform int emitter_sets;        // that neighbours share

const float kPiEmitters = 3.14159265;

// Below this height, in voxels, a point lies in an emitter's plane to within rounding, and on neither side of it.
const float kLeastHeight = 1e-3;

// --- What would arrive if nothing were in the way ---

// The vector form factor of an edge seen from the origin (Lambert 1760; Baum et al. 1989, eq. 2): the angle between its
// ends along the normal of the plane through them. Any length of the ends will do.
float edge_form_factor(vec3 a, vec3 b, vec3 n)
{
    vec3 normal = cross(a, b);
    float sine = length(normal), cosine = dot(a, b);
    return sine > 1e-12 ? atan(sine, cosine) * dot(normal, n) / sine : 0.0;
}

// Form factor of a point with the normal n to a triangle, relative to the point, whose front winds counter-clockwise;
// only what is above the horizon counts. E = pi L F.
// snippet: triangle_form_factor
float triangle_form_factor(vec3 a, vec3 b, vec3 c, vec3 n)
{
    vec3 front = cross(b - a, c - a);
    if (-dot(a, front) < kLeastHeight * length(front)) return 0.0;  // seen from behind, or in its plane
    vec3 corners[3] = vec3[](a, b, c), left = vec3(0.0), entered = vec3(0.0);
    float sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        // The part of the edge above the horizon; where the outline leaves and enters it, it goes on along the horizon.
        vec3 p = corners[i], q = corners[i == 2 ? 0 : i + 1];
        float hp = dot(p, n), hq = dot(q, n);
        vec3 crossing = p + (q - p) * clamp(hp / (abs(hp - hq) > 1e-12 ? hp - hq : 1e-12), 0.0, 1.0);
        if (hp > 0.0 && hq <= 0.0) left = crossing;
        if (hp <= 0.0 && hq > 0.0) entered = crossing;
        if (hp > 0.0 || hq > 0.0) sum += edge_form_factor(hp > 0.0 ? p : crossing, hq > 0.0 ? q : crossing, n);
    }
    if (left != entered) sum += edge_form_factor(left, entered, n);
    return max(-sum / (2.0 * kPiEmitters), 0.0);  // counter-clockwise from the front is clockwise from the point
}
// end snippet

// The same for a disc of the part's area that faces the point (Wallace et al. 1989, eq. 8), exact on its axis.
float part_form_factor(EmitterPart part, vec3 to_part, vec3 n)
{
    float d2 = max(dot(to_part, to_part), 1e-6);
    vec3 direction = to_part * inversesqrt(d2);
    float facing = max(dot(n, direction), 0.0) * max(-dot(part.normal.xyz, direction), 0.0);
    return facing / (kPiEmitters * (d2 + part.position.w));  // times the area
}

// E / pi at a point in grid space.
// snippet: unshadowed_light
vec3 unshadowed_light(vec3 position, vec3 n)
{
    vec3 sum = vec3(0.0);
#if TRIANGLES
    for (int i = 0; i < emitter_triangle_count; ++i) {
        EmitterTriangle t = emitter_triangles[i];
        sum += vec3(t.a.w, t.b.w, t.c.w) *
               triangle_form_factor(t.a.xyz - position, t.b.xyz - position, t.c.xyz - position, n);
    }
#else
    for (int i = aimed_part_count; i < emitter_part_count; ++i) {
        EmitterPart part = emitter_parts[i];
        sum += part.intensity.rgb * part_form_factor(part, part.position.xyz - position, n);
    }
#endif
    return sum;
}
// end snippet

// --- Which share of it arrives ---

struct EmitterSamples {
    vec3 arriving, unshadowed;  // E / pi of one set's parts, with what is in the way and without
};

// Whether something lies in the blur of a part, on the way to it. Of a point that lies there itself this is not asked.
bool hidden_nearby(EmitterPart part, vec3 to_part)
{
    vec3 away = normalize(-(to_part * frame_around(part.normal.xyz)));
    if (dot(to_part, part.normal.xyz) > -2.0 * kEmitterBlur) return false;
    int band = clamp(int(away.z * float(kMaskBands)), 0, kMaskBands - 1);
    int sector = int((atan(away.y, away.x) / (2.0 * kPiEmitters) + 1.0) * float(kMaskSectors)) % kMaskSectors;
    return (floatBitsToUint(part.normal.w) >> (band * kMaskSectors + sector) & 1u) != 0u;
}

// Every set holds parts of all emitters. A ray ends at the height where the blur of the emitter begins.
// snippet: sample_emitters
EmitterSamples sample_emitters(RayStart start, vec3 position, vec3 geometric_normal, vec3 n, int set)
{
    int per_set = aimed_part_count / emitter_sets, first = set % emitter_sets * per_set;
    EmitterSamples samples = EmitterSamples(vec3(0.0), vec3(0.0));
    for (int i = first; i < first + per_set; ++i) {
        EmitterPart part = emitter_parts[i];
        vec3 to_part = part.position.xyz - position;
        vec3 light = part.intensity.rgb * part_form_factor(part, to_part, n);
        if (light == vec3(0.0)) continue;
        samples.unshadowed += light;
        if (dot(to_part, geometric_normal) <= 0.0 || hidden_nearby(part, to_part)) continue;
        float height = -dot(to_part, part.normal.xyz);
        vec3 way = position + to_part * max(1.0 - kEmitterBlur / height, 0.0) - start.position;
        float end = dot(way, to_part) > 0.0 ? length(way) : 0.0;
        samples.arriving += light * (1.0 - covered_share(start, way / max(end, 1e-6), end));
    }
    return samples;
}
// end snippet

// Shadows by a ratio of what neighbours have sampled keep the exact light where nothing is in the way (Heitz et al.
// 2018).
vec3 arriving_share(vec3 arriving, vec3 unshadowed)
{
    return mix(clamp(arriving / max(unshadowed, vec3(1e-30)), 0.0, 1.0), vec3(1.0), lessThanEqual(unshadowed, vec3(0.0)));
}
