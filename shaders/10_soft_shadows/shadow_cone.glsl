// A cone to a light: which share of the light do the voxels leave visible? (After Villegas 2016, section 3.6.4.)
#include "07_anisotropic_mips/pyramid.glsl"
#include "common/light.glsl"
#include "common/frame.glsl"

uniform float step_factor;        // 1: two samples a voxel of the level that is read
uniform float start_offset;       // voxels along the normal, from the surface to the start
uniform float light_radius;       // m, of point and spot lights
uniform float light_half_angle;   // rad, of directional lights
uniform int shadow_cones;         // cones to a light
uniform bool net_faces;           // false: each axis for itself, the stripes

// A linearly interpolated box of width w has the variance w^2 / 4, a disc of diameter D seen from the side D^2 / 16:
// voxels half as wide as the cone blur an edge as the light does.
const float kVoxelOverDiameter = 0.5;
const float kStepOverVoxel = 0.5;  // sums of the interpolation's tents are then within 4 % of their integral,
const float kClosed = 0.96;        // so this coverage is counted as the whole;
const float kClosedColumn = 0.9;   // likewise two voxels of a wall at 45 degrees, whose column may touch a third
const float kEmpty = 0.02;         // coverage of a sample below which a surface has ended
const float kMaxSine = 0.95;       // a light may come closer than its radius
const float kGoldenAngle = 2.39996323;  // rad
const float kLead = 1.0;           // voxels: half the width of an interpolated wall

// Coverage of the faces that look along -axis or +axis (`faces`: 0 or 1 for each axis) at a point given in texels.
vec3 coverage_of(vec3 texel, vec3 faces, int level)
{
    ivec3 face = ivec3(0, 2, 4) + ivec3(faces);
    return vec3(coverage_at(face.x, texel, level), coverage_at(face.y, texel, level), coverage_at(face.z, texel, level));
}

// The same, half a voxel before and half a voxel behind the point on the face's own axis, summed.
vec3 column_of(vec3 texel, vec3 faces, int level)
{
    ivec3 face = ivec3(0, 2, 4) + ivec3(faces);
    vec3 x = vec3(0.5, 0.0, 0.0), y = vec3(0.0, 0.5, 0.0), z = vec3(0.0, 0.0, 0.5);
    return vec3(coverage_at(face.x, texel - x, level) + coverage_at(face.x, texel + x, level),
                coverage_at(face.y, texel - y, level) + coverage_at(face.y, texel + y, level),
                coverage_at(face.z, texel - z, level) + coverage_at(face.z, texel + z, level));
}

// What a point of the ray's way tells of the surfaces there.
struct Stopped {
    float net;     // single surfaces that the ray meets from their front, per voxel of the level
    float paired;  // the same of thin sheets, whose two sides share a voxel
    float wall;    // share of the cone's width that a single surface covers at this place, 0..1
};

// Faces that look against the ray stop it; what looks along it is left behind. A slanted surface has faces of both
// kinds, and only the difference is what it shows to the ray: n.d = sum n_a d_a. Where the two sides of a thin sheet
// share a voxel the difference is zero, so the smaller of both on each axis counts for itself.
Stopped stopped_at(vec3 position, vec3 direction, int level)
{
    float voxel = float(1 << level);
    vec3 p = position / voxel;
    vec3 low = floor(grid.content_min.xyz / voxel) + 0.5, high = floor(grid.content_max.xyz / voxel) + 0.5;
    vec3 q = clamp(p, low, high), along = vec3(greaterThanEqual(direction, vec3(0.0)));
    vec3 against = coverage_of(q, 1.0 - along, level), with_ray = coverage_of(q, along, level);
    // snippet: stopped
    // Beside the bounds the border is repeated; along a face's own axis what is outside is empty.
    vec3 inside = step(grid.content_min.xyz, position) * step(position, grid.content_max.xyz);
    vec3 weight = abs(direction) * max(1.0 - abs(p - q), 0.0) * inside.yzx * inside.zxy;
    float net = dot(weight, against - with_ray), met = dot(weight, against);
    // A slanted wall is a staircase of voxels, and how long a ray stays in it varies. But the two voxels of a column
    // next to the point hold the whole of it: their sum is what it covers, where at least half of that is at the point.
    vec3 column = column_of(q, 1.0 - along, level);
    vec3 peak = clamp(5.0 * against / max(column, vec3(1e-4)) - 1.5, 0.0, 1.0) * step(vec3(1e-3), weight);
    vec3 wall = column * peak * clamp(8.0 * net / max(met, 1e-4) - 0.4, 0.0, 1.0);
    return Stopped(max(net_faces ? net : met, 0.0), net_faces ? dot(weight, min(against, with_ray)) : 0.0,
                   max(wall.x, max(wall.y, wall.z)));
    // end snippet
}

// What a cone has met: within a run of covered samples, one surface or one convex thing, coverages add up to the share of
// the cone that it hides. What follows behind a gap is independent of it and hides its share of the rest.
struct Shadow {
    float visible;  // share of the cone that is open
    float sum;      // coverage of the run
    float wall;     // largest share covered at one place of the run
};

// snippet: shadow_run
void meet(inout Shadow shadow, float stopped, float wall, float stride)
{
    float before = 1.0 - min(max(shadow.sum, shadow.wall), 1.0);
    shadow.sum += stopped / kClosed * stride;
    shadow.wall = max(shadow.wall, wall / kClosedColumn);
    shadow.visible *= before > 0.0 ? (1.0 - min(max(shadow.sum, shadow.wall), 1.0)) / before : 0.0;
    float covered = clamp(stopped / kEmpty, 0.0, 1.0);
    shadow.sum *= covered;
    shadow.wall *= covered;
}
// end snippet

// `from` < 0 starts behind the origin, for what stands next to the surface: there thin sheets are left out, which may be
// the surface's own. While the cone is thinner than two voxels the finest level is all it needs; then two are mixed so
// that the variance of the filter grows with the cone.
float march_to_light(vec3 origin, vec3 direction, float tan_half, float from, float end)
{
    Shadow shadow = Shadow(1.0, 0.0, 0.0);
    float t = from, fine_end = min(end, 1.0 / (2.0 * tan_half * kVoxelOverDiameter));
    for (float stride = step_factor * kStepOverVoxel; t < fine_end && shadow.visible > 0.001; t += stride) {
        float middle = t + 0.5 * stride;
        Stopped here = stopped_at(origin + direction * middle, direction, 0);
        meet(shadow, here.net + (middle > 0.0 ? here.paired : 0.0), here.wall, stride);
    }
    // snippet: shadow_march
    while (t < end && shadow.visible > 0.001) {
        float lod = clamp(log2(2.0 * t * tan_half * kVoxelOverDiameter), 0.0, float(grid.size.w - 1));
        int fine = int(lod), coarse = min(fine + 1, grid.size.w - 1);
        float blend = (exp2(2.0 * (lod - float(fine))) - 1.0) / 3.0;
        float stride = step_factor * kStepOverVoxel * float(1 << fine);
        vec3 position = origin + direction * (t + 0.5 * stride);
        Stopped a = stopped_at(position, direction, fine), b = stopped_at(position, direction, coarse);
        meet(shadow, mix((a.net + a.paired) / float(1 << fine), (b.net + b.paired) / float(1 << coarse), blend),
             mix(a.wall, b.wall, blend), stride);
        t += stride;
    }
    // end snippet
    return shadow.visible;
}

// Distance along the ray to where it leaves the scene's bounds, moved out by `margin`; all in voxels.
float distance_to_bounds(vec3 origin, vec3 direction, float margin)
{
    vec3 d = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    vec3 far_side = mix(grid.content_min.xyz - margin, grid.content_max.xyz + margin, greaterThan(d, vec3(0.0)));
    vec3 t = (far_side - origin) / d;
    return max(min(t.x, min(t.y, t.z)), 0.0);
}

// Cones that together just hold the light, a sphere or the disc of a sun: sin a = radius / distance. They lie on a spiral
// of equal areas (Vogel 1979) and end where the light begins, or behind the bounds, where a wall on them has been passed.
float cone_visibility(vec3 position, vec3 normal, LightSample light)
{
    bool directional = light.distance >= kInfiniteDistance;
    float sine = min(directional ? sin(light_half_angle) : light_radius / light.distance, kMaxSine);
    float tan_light = sine / sqrt(1.0 - sine * sine), tan_half = tan_light / sqrt(float(shadow_cones));
    vec3 origin = grid_from_scene(position) + start_offset * normal;
    mat3 frame = frame_around(light.direction);
    float visible = 0.0;
    // snippet: shadow_cone
    for (int i = 0; i < shadow_cones; ++i) {
        float r = shadow_cones == 1 ? 0.0 : tan_light * sqrt((float(i) + 0.5) / float(shadow_cones));
        vec3 direction = normalize(frame * vec3(r * cos(float(i) * kGoldenAngle), r * sin(float(i) * kGoldenAngle), 1.0));
        if (dot(direction, normal) <= 0.0) continue;  // this part of the light is below the horizon
        float exit = distance_to_bounds(origin, direction, 0.0), widest = max(exit * tan_half, 1.0);
        float end = distance_to_bounds(origin, direction, 1.5 * widest);
        if (!directional) end = min(end, (light.distance - light_radius) / grid.origin.w);
        float lead = kLead * length(direction - dot(direction, normal) * normal);
        visible += march_to_light(origin, direction, tan_half, -lead, end);
    }
    // end snippet
    return visible / float(shadow_cones);
}
