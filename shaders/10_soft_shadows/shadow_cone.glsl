// Cones to a light: which share of the light do the voxels leave visible? (After Villegas 2016, section 3.6.4.)
// The cone that holds the light is divided into thin ones, each of which leaps through the walk volume of chapter 08.
#ifndef OWN_OPEN_SHARE  // a chapter with an open_share() of its own includes that before and says so
#include "07_anisotropic_mips/pyramid.glsl"
#include "08_diffuse_cones/walk.glsl"
#include "08_diffuse_cones/cone_common.glsl"
#endif
#include "common/light.glsl"
#include "common/frame.glsl"

uniform float start_offset;      // voxels from the middle of the surface's own voxel to the start
uniform float light_radius;      // m, of point and spot lights
uniform float light_half_angle;  // rad, of directional lights
uniform int shadow_cones;        // cones to a light
uniform float range_shadow;      // m, beyond it nothing throws a shadow; 0: none

const float kMaxSine = 0.95;            // a light may come closer than its radius
const float kGoldenAngle = 2.39996323;  // rad

#ifndef OWN_OPEN_SHARE
// Share of a thin cone that is open on a way of `length` voxels.
// snippet: open_share
float open_share(RayStart start, vec3 direction, float length)
{
    float exit = exit_distance(start.position, direction, 0.0);
    // A light beyond the bounds is behind the walls that stand on them.
    if (length >= exit && closed_at(walk_ray(start.position, direction), start.position, exit)) return 0.0;
    return 1.0 - covered_share(start, direction, min(length, exit - kBeforeSide));
}
// end snippet
#endif

// Thin cones that together just hold the light, a sphere or the disc of a sun: sin a = radius / distance. They lie on a
// spiral of equal areas (Vogel 1979) and end where the light begins.
float cone_visibility(vec3 position, vec3 normal, LightSample light)
{
    bool directional = light.distance >= kInfiniteDistance;
    float sine = min(directional ? sin(light_half_angle) : light_radius / light.distance, kMaxSine);
    float tan_light = sine / sqrt(1.0 - sine * sine);
    float to_light = directional ? kInfiniteDistance : max(light.distance - light_radius, 0.0) / grid.origin.w;
    to_light = min(to_light, reach_of(range_shadow));
    RayStart start = start_above(grid_from_scene(position), normal, start_offset);
    mat3 frame = frame_around(light.direction);
    float open = 0.0, all = 0.0;
    // snippet: shadow_cone
    for (int i = 0; i < shadow_cones; ++i) {
        float r = tan_light * sqrt((float(i) + 0.5) / float(shadow_cones)), turn = float(i) * kGoldenAngle;
        vec3 direction = normalize(frame * vec3(r * cos(turn), r * sin(turn), 1.0));
        float cosine = dot(direction, normal);  // each part of the light brings its share of E
        if (cosine <= 0.0) continue;            // and what is below the horizon none
        open += cosine * open_share(start, direction, to_light);
        all += cosine;
    }
    // end snippet
    return open / max(all, 1e-6);
}
