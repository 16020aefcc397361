// A ray through the voxels, and what it meets there.
// INDEX, SIX_SIDES: as in scatter.comp. FIXED_STEPS 1: samples at fixed steps; 0: every voxel on the way. ON_PLANE 1: a
// ray ends where it crosses the plane of the piece that a voxel holds; 0: where it enters an occupied voxel.
// FACING 0: backs do not count, 1: cosine, 2: all count. FALLOFF 0: none, 1: window, 2: 1/r^2.
#include "common/voxel_grid.glsl"
#include "18_voxel_ray_marching/packing.glsl"
#include "18_voxel_ray_marching/piece.glsl"

layout(binding = 22) uniform usampler3D voxels;
layout(binding = 23) uniform usampler3D sides;
#if INDEX
layout(std430, binding = kPieceBinding) readonly buffer PieceBuffer { Piece pieces[]; };
#endif
uniform float largest_channel;  // s
uniform float min_distance;     // voxels; without planes: what is nearer does not count
uniform float step_length;      // voxels
uniform int steps;
uniform vec3 sky_radiance;

// What a word stands for.
struct Held {
    vec3 normal, radiance;
    vec3 place;  // of the piece, grid space; of no use without an index
};

Held held_by(uint word)
{
#if INDEX
    Piece piece = pieces[unpack_index(word)];
    vec3 place = grid_from_scene(uintBitsToFloat(piece.place.xyz));
    return Held(piece_normal(piece), uintBitsToFloat(piece.light.xyz), place);
#else
    return Held(unpack_normal(word), largest_channel * unpack_color(word), vec3(0.0));
#endif
}

uint word_of_side(ivec3 voxel, int side)
{
    return texelFetch(sides, voxel + ivec3(side * textureSize(voxels, 0).x, 0, 0), 0).r;
}

// A box that is left by t_out.
struct Crossing {
    float t_in, t_out;  // voxels from the origin
};

struct Meeting {
    bool ends;       // the ray does not go on
    float t;         // voxels
    vec3 radiance;   // W/(sr m^2)
    float back;      // voxels: the nearest back on the way
};

const float kNothing = 1e30;

#if ON_PLANE
const float kPlaneMargin = 0.5;  // voxels by which a plane reaches beyond the voxel that stands for it
const float kOwn = 1e-3;         // voxels, rounding: a surface does not meet itself
const float kOwnBack = 1.0;      // voxels: a curved surface's own backs
const float kSheet = 1.0;        // voxels: a front so close behind a back is the other side of one thin sheet

// snippet: plane
// Where the ray crosses the plane of what the voxel holds, if that is nearer than what was met so far. A ray never
// crosses the plane that it starts on: surfaces neither light nor hide themselves.
void meet(inout Meeting best, uint word, vec3 origin, vec3 direction, Crossing c)
{
    Held held = held_by(word);
    float along = dot(held.normal, direction), t = dot(held.normal, held.place - origin) / along;
    bool is_back = along >= 0.0 && FACING != 2;
    // Also false where the ray runs along the plane, and t is no number.
    bool crosses = t > max(c.t_in - kPlaneMargin, is_back ? kOwnBack : kOwn) && t < c.t_out + kPlaneMargin;
    if (crosses && is_back) best.back = min(best.back, t);
    if (!crosses || is_back || t >= best.t) return;
    best = Meeting(true, t, held.radiance * (FACING == 1 ? -along : 1.0), best.back);
}
// end snippet
#else
const float kSheet = 0.0;

// snippet: cube
// The voxel is full. Its own surface's voxels are left out by their distance alone.
void meet(inout Meeting best, uint word, vec3 origin, vec3 direction, Crossing c)
{
    Held held = held_by(word);
    float along = dot(held.normal, direction);
    if (c.t_in < min_distance || (FACING == 0 && along >= 0.0)) return;
    best = Meeting(true, c.t_in, held.radiance * (FACING == 1 ? max(-along, 0.0) : 1.0), best.back);
}
// end snippet
#endif

Meeting meet_voxel(ivec3 voxel, uint word, vec3 origin, vec3 direction, Crossing c)
{
    Meeting best = Meeting(false, kNothing, vec3(0.0), kNothing);
#if SIX_SIDES && ON_PLANE
    for (int side = 0; side < kFaceCount; ++side)
        if ((word & (1u << side)) != 0u) meet(best, word_of_side(voxel, side), origin, direction, c);
#elif SIX_SIDES
    // The side that faces the ray most, of those that there are.
    int facing = -1;
    float most = -2.0;
    for (int side = 0; side < kFaceCount; ++side) {
        float towards = -dot(face_normal(side), direction);
        bool nearer = (word & (1u << side)) != 0u && towards > most;
        facing = nearer ? side : facing;
        most = nearer ? towards : most;
    }
    meet(best, word_of_side(voxel, facing), origin, direction, c);
#else
    meet(best, word, origin, direction, c);
#endif
    return best;
}

float falloff(float t)
{
#if FALLOFF == 1
    float left = max(1.0 - t / (float(steps) * step_length), 0.0);
    return left * left;
#elif FALLOFF == 2
    float metres = t * grid.origin.w;
    return min(1.0 / (metres * metres), 1.0);
#else
    return 1.0;
#endif
}

bool is_inside(ivec3 voxel)
{
    return all(greaterThanEqual(voxel, ivec3(0))) && all(lessThan(voxel, textureSize(voxels, 0)));
}

// `origin` in grid space, direction unit. Radiance that comes along the ray, W/(sr m^2).
#if FIXED_STEPS
// snippet: fixed_steps
vec3 trace(vec3 origin, vec3 direction)
{
    for (int i = 1; i <= steps; ++i) {
        float t = float(i) * step_length;
        ivec3 voxel = ivec3(floor(origin + t * direction));
        if (!is_inside(voxel)) return sky_radiance;
        uint word = texelFetch(voxels, voxel, 0).r;
        if (word == 0u) continue;
        Meeting m = meet_voxel(voxel, word, origin, direction, Crossing(t, t));
        if (m.ends) return m.radiance * falloff(m.t);
    }
    return vec3(0.0);
}
// end snippet
#else
vec3 trace(vec3 origin, vec3 direction)
{
    ivec3 size = textureSize(voxels, 0);
    direction = mix(direction, vec3(1e-8), lessThan(abs(direction), vec3(1e-8)));
    vec3 inverse = 1.0 / direction, to_low = -origin * inverse, to_high = (vec3(size) - origin) * inverse;
    vec3 enter = min(to_low, to_high), leave = max(to_low, to_high);
    float t = max(0.0, max(enter.x, max(enter.y, enter.z)));
    if (t >= min(leave.x, min(leave.y, leave.z))) return sky_radiance;
    ivec3 voxel = clamp(ivec3(floor(origin + t * direction)), ivec3(0), size - 1), step_by = ivec3(sign(direction));
    vec3 next = (vec3(voxel) + max(vec3(step_by), vec3(0.0)) - origin) * inverse;
    // Amanatides & Woo 1987. What an occupied voxel means takes longer than a step: lanes wait for each other less when
    // all have found one.
    float back = kNothing;  // a back ends the ray and sends nothing, but that a front lies close behind it
    // snippet: dda
    while (is_inside(voxel) && t <= back + kSheet) {
        uint word = 0u;
        float t_in = t;
        ivec3 met = voxel;
        while (word == 0u && is_inside(voxel)) {
            met = voxel;
            t_in = t;
            word = texelFetch(voxels, voxel, 0).r;
            t = min(next.x, min(next.y, next.z));
            bvec3 crossed = next.x <= next.y && next.x <= next.z ? bvec3(true, false, false)
                            : next.y <= next.z                   ? bvec3(false, true, false)
                                                                 : bvec3(false, false, true);
            voxel += step_by * ivec3(crossed);
            next += vec3(crossed) * abs(inverse);
        }
        if (word == 0u) break;
        Meeting m = meet_voxel(met, word, origin, direction, Crossing(t_in, t));
        back = min(back, m.back);
        if (m.ends) return m.t <= back + kSheet ? m.radiance * falloff(m.t) : vec3(0.0);
    }
    // end snippet
    return back < kNothing ? vec3(0.0) : sky_radiance;
}
#endif
