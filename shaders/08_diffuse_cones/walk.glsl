// Follow a ray through the walk volume: empty space is passed in leaps, and what surfaces cover on the way is summed
// up.
//
// A cell of the volume is a cube round a corner of eight voxels. Empty: for each octant 3 bits, the largest k for which
// the cube of 2^k cells that begins here and goes towards the octant is empty. Otherwise bit 31, and for each of the
// six sides 5 bits of coverage, the mean of the eight voxels: a wall is two layers of one half, and a staircase adds up
// to one.
#include "common/voxel_grid.glsl"

#ifdef WALK_STORAGE
#include WALK_STORAGE
#else
#include "08_diffuse_cones/walk_volume.glsl"
#endif

#ifndef COUNT_WALK_STEPS  // chapter 14 counts
#define COUNT_WALK_STEPS(count)
#endif

// Coverage at which a ray ends: sums over blurred surfaces are within a tenth of what the surfaces cover.
const float kStopped = 0.9;
// Coverage of the cell where a ray leaves the bounds from which on there is a wall, half of which lies beyond them.
const float kClosed = 0.4;
// Cells of blur above a surface: half a voxel for where in its voxel it lies, one for the mean with its neighbours, one
// half for the other axes.
const float kBlur = 2.0;
// Height above a thin sheet up to which its other side is in the blur: one cell by the mean, half a voxel for where it
// lies.
const float kSheetBlur = 1.5;
// Rays end this far before a side, so that rounding does not carry them over it.
const float kBeforeSide = 1e-3;

// Ways end here where nothing else ends them, voxels; range_m: 0 for none (chapter 16).
const float kNoRange = 1e30;
float reach_of(float range_m) { return range_m > 0.0 ? range_m / grid.origin.w : kNoRange; }

// Where rays of a surface begin.
struct RayStart {
    vec3 position;  // grid space
    vec3 normal;    // of the surface, unit; 0 for rays that begin nowhere in particular
    vec3 sheet;     // the axis across a thin sheet, times how much of one the surface is; 0 otherwise
};

// What does not change along a ray.
struct WalkRay {
    vec3 direction, inverse, first_sides, reach;
    vec3 down;          // 1 where it goes towards lower coordinates
    vec3 nudge;         // into the cell that the ray enters, where it is on a side to within rounding
    int octant_shift;   // of its leaps' bits
    ivec3 face_shifts;  // of the coverage that looks against the ray, one side for each axis
};

WalkRay walk_ray(vec3 origin, vec3 direction)
{
    WalkRay ray;
    ray.direction = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    vec3 up = step(0.0, ray.direction), corner = origin + 0.5;
    ray.inverse = 1.0 / ray.direction;
    ray.first_sides = (1.0 - up - corner) * ray.inverse;
    ray.reach = abs(ray.inverse);
    ray.down = 1.0 - up;
    ray.nudge = corner + (2.0 * up - 1.0) * 1e-3;
    ray.octant_shift = 3 * int(dot(up, vec3(1.0, 2.0, 4.0)));
    ray.face_shifts = ivec3(0, 10, 20) + 5 * (1 - ivec3(up));
    return ray;
}

// One step: the cell at distance t, and where the ray leaves it or the empty cube that begins there.
struct WalkStep {
    uint word;
    bool occupied;
    float end;  // distance along the ray
};

// snippet: walk_step
WalkStep walk_step(WalkRay ray, float t)
{
    vec3 cell = floor(ray.nudge + ray.direction * t);
    COUNT_WALK_STEPS(1)
    WalkStep s;
    float unit;
    s.word = walk_word(cell, ray.down, unit);
    s.occupied = s.word >= 0x80000000u;
    float side = s.occupied ? 1.0 : unit * float(1u << (s.word >> ray.octant_shift & 7u));
    vec3 ends = cell * ray.inverse + ray.first_sides + side * ray.reach;
    s.end = min(ends.x, min(ends.y, ends.z));
    return s;
}
// end snippet

vec3 coverage_bits(uint word, ivec3 shifts) { return vec3(uvec3(word) >> uvec3(shifts) & 31u) / kWalkUnits; }

// Coverage per unit of the ray's way in an occupied cell: the three sides that look against it, each by |d_a|, since
// what oriented surfaces cover goes with their projected area (Jakob et al. 2010, section 3).
float coverage_met(WalkRay ray, uint word) { return dot(abs(ray.direction), coverage_bits(word, ray.face_shifts)); }

// That of the sides that look along the ray.
ivec3 leaving_shifts(WalkRay ray) { return 2 * ivec3(0, 10, 20) + 5 - ray.face_shifts; }
float coverage_left(WalkRay ray, uint word) { return dot(abs(ray.direction), coverage_bits(word, leaving_shifts(ray))); }

// The same in the blur of the surface that the ray starts from. A slanted surface shows some of its sides to a ray that
// leaves it: those across the axes along which the ray goes back (n_a d_a < 0). Exactly, n.d > 0, it shows nothing. How
// much of it is in the cell is known from its side across the axis b that the normal is nearest to of those along which
// the ray goes forward: coverage A_b = s |n_b|, so s |n_a| on the others. A thin sheet has a side on its back in the
// same voxel; it is left out until the ray has risen above its blur.
// snippet: coverage_above
vec3 coverage_above(vec3 direction, vec3 met, vec3 leaving, float unit, RayStart start, float t)
{
    vec3 n = abs(start.normal), forward = n * step(0.0, start.normal * direction);
    vec2 nearest = forward.x >= forward.y && forward.x >= forward.z ? vec2(leaving.x, forward.x)
                   : forward.y >= forward.z                         ? vec2(leaving.y, forward.y)
                                                                    : vec2(leaving.z, forward.z);
    vec3 shown = (n - forward) / max(nearest.y, 0.1);  // of its own surface, per coverage A_b
    vec3 rounding = 0.5 * unit * (1.0 + shown);        // both coverages are rounded to units
    vec3 others = max(met - shown * nearest.x - rounding, vec3(0.0));
    return others * (1.0 - start.sheet * step(t * dot(start.sheet, abs(direction)), kSheetBlur));
}
// end snippet

float coverage_met_above(WalkRay ray, uint word, RayStart start, float t)
{
    vec3 met = coverage_bits(word, ray.face_shifts), leaving = coverage_bits(word, leaving_shifts(ray));
    return dot(abs(ray.direction), coverage_above(ray.direction, met, leaving, 1.0 / kWalkUnits, start, t));
}

// Until where a ray is in the blur of the surface that it starts from; 0 where there is none.
float own_blur_end(RayStart start, vec3 direction)
{
    return kBlur * dot(start.normal, start.normal) / max(dot(start.normal, direction), 1e-3);
}

// Distance along the ray to where it leaves the scene's bounds, moved out by `margin`; all in voxels.
float exit_distance(vec3 origin, vec3 direction, float margin)
{
    vec3 d = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    vec3 far_side = mix(grid.content_min.xyz - margin, grid.content_max.xyz + margin, greaterThan(d, vec3(0.0)));
    vec3 t = (far_side - origin) / d;
    return max(min(t.x, min(t.y, t.z)), 0.0);
}

// Whether a wall on the bounds ends the ray there: of such a wall the bounds cut one half off.
bool closed_at(WalkRay ray, vec3 origin, float exit)
{
    vec3 position = origin + ray.direction * exit;
    vec3 to_bounds = abs(mix(grid.content_min.xyz, grid.content_max.xyz, step(0.0, ray.direction)) - position);
    WalkStep last = walk_step(ray, exit - kBeforeSide);
    vec3 met = coverage_bits(last.word, ray.face_shifts);
    float wall = to_bounds.x <= to_bounds.y && to_bounds.x <= to_bounds.z ? met.x : to_bounds.y <= to_bounds.z ? met.y : met.z;
    return last.occupied && wall >= kClosed;
}

// Where a ray ends: in the first run of occupied cells in which the coverage that it has met passes `threshold`, at the
// run's mean distance. With thresholds spread evenly over 0 .. kStopped among the rays of a pixel and its neighbours,
// what covers a third stops a third of them, or rather 1 / kStopped times as many: linear transmittance of opaque
// surfaces (Vicini et al. 2021, section 4).
struct WalkEnd {
    bool stopped;
    float t;  // voxels
};

WalkEnd walk(RayStart start, vec3 direction, float threshold, float reach)
{
    WalkRay ray = walk_ray(start.position, direction);
    float exit = min(exit_distance(start.position, direction, 0.0), reach), end = exit - kBeforeSide;
    float own_end = min(own_blur_end(start, direction), end);
    float t = 0.0, covered = 0.0, run = 0.0, run_t = 0.0;
    // snippet: walk
    // Out of the blur of its own surface.
    while (t < own_end && covered < threshold) {
        WalkStep s = walk_step(ray, t);
        float met = s.occupied ? (min(s.end, end) - t) * coverage_met_above(ray, s.word, start, t) : 0.0;
        run = s.occupied ? run + met : 0.0;
        run_t = s.occupied ? run_t + met * 0.5 * (t + min(s.end, end)) : 0.0;
        covered += met;
        t = s.end;
    }
    // On to the run of cells where it ends.
    bool in_run = true;
    while (t < end && in_run && covered < kStopped) {
        WalkStep s = walk_step(ray, t);
        in_run = s.occupied || covered < threshold;
        float met = s.occupied ? (min(s.end, end) - t) * coverage_met(ray, s.word) : 0.0;
        run = s.occupied ? run + met : in_run ? 0.0 : run;
        run_t = s.occupied ? run_t + met * 0.5 * (t + min(s.end, end)) : in_run ? 0.0 : run_t;
        covered += met;
        t = s.end;
    }
    // end snippet
    if (covered >= threshold) return WalkEnd(true, run_t / max(run, 1e-6));
    return WalkEnd(exit < reach && closed_at(ray, start.position, exit), exit);
}

WalkEnd walk(RayStart start, vec3 direction, float threshold) { return walk(start, direction, threshold, kNoRange); }

// Share of a ray that surfaces stop on the way to `end`. In a slanted wall the staircase of its voxels leaves some rays
// a third too little. But what enters a solid leaves it again, at a place of another phase: the larger of both sums is
// what it covers. The rim of a surface that a ray passes is not entered.
// snippet: covered_share
float covered_share(RayStart start, vec3 direction, float end)
{
    const float kEntered = 0.25;
    WalkRay ray = walk_ray(start.position, direction);
    float own_end = min(own_blur_end(start, direction), end), t = 0.0, entered = 0.0, left = 0.0;
    while (t < own_end && entered < kStopped) {
        WalkStep s = walk_step(ray, t);
        entered += s.occupied ? (min(s.end, end) - t) * coverage_met_above(ray, s.word, start, t) : 0.0;
        t = s.end;
    }
    while (t < end && max(entered, left) < kStopped) {
        WalkStep s = walk_step(ray, t);
        float way = s.occupied ? min(s.end, end) - t : 0.0;
        entered += way * coverage_met(ray, s.word);
        left += entered > kEntered ? way * coverage_left(ray, s.word) : 0.0;
        t = s.end;
    }
    float covered = max(entered, left);
    return covered < kStopped ? covered : 1.0;
}
// end snippet

// The next run of occupied cells on a ray: what it covers, where in the mean. `t` moves on behind it.
struct WalkRun {
    float covered;
    float t;  // voxels
};

WalkRun next_run(WalkRay ray, RayStart start, float own_end, float end, inout float t)
{
    WalkRun run = WalkRun(0.0, 0.0);
    bool before = true;
    while (t < end && before) {
        WalkStep s = walk_step(ray, t);
        float next = min(s.end, end), met = 0.0;
        if (s.occupied)
            met = (next - t) * (t < own_end ? coverage_met_above(ray, s.word, start, t) : coverage_met(ray, s.word));
        run.covered += met;
        run.t += met * 0.5 * (t + next);
        before = s.occupied || run.covered == 0.0;
        t = s.end;
    }
    run.t /= max(run.covered, 1e-6);
    return run;
}
