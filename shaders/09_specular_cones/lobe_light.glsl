// main() of the programs that trace the lobes: indirect specular light of every pixel, by a few cones that share the
// GGX lobe.
#include "common/g_buffer.glsl"
#include "common/brdf.glsl"
#include "common/frame.glsl"
#ifndef OWN_TRACE_LOBE  // a chapter with a trace_lobe() of its own includes that before and says so
#include "08_diffuse_cones/cone.glsl"
#endif
#include "09_specular_cones/specular_surface.glsl"

#ifndef STORE
#define STORE(light) vec4(light, 1.0)
#endif

uniform int specular_cones;
uniform bool interleave;  // neighbours trace other parts of the lobe and share them
uniform float lobe_share;
uniform float start_offset;
uniform float range_specular;  // m, beyond it nothing is seen but the sky; 0: none
uniform float turn;       // rad, of the points in the lobe: another one for each of many pictures of the same scene
layout(location = 0) out vec4 lobe_light;  // rgb: mean radiance in the lobe, a: 1 where there is a lobe

// Half the angle around the mirror direction that holds the share p of the lobe, seen along the normal.
// Microfacet normals: tan^2 = alpha^2 p / (1 - p) (the inverse of Walter et al. 2007, eq. 35); reflection doubles it.
// snippet: lobe
float lobe_half_angle(float alpha, float share)
{
    return min(2.0 * atan(alpha * sqrt(share / (1.0 - share))), 1.2);
}
// end snippet

// A normal visible from v, with probability in proportion to its projected area (Heitz 2018, listing 1), in the frame
// of the surface (z: normal); `disc` is uniform on the unit disc.
// snippet: visible_normal
vec3 visible_normal(vec3 v, float alpha, vec2 disc)
{
    vec3 vh = normalize(vec3(alpha * v.xy, v.z));
    float length2 = dot(vh.xy, vh.xy);
    vec3 t1 = length2 > 0.0 ? vec3(-vh.y, vh.x, 0.0) * inversesqrt(length2) : vec3(1.0, 0.0, 0.0);
    float s = 0.5 * (1.0 + vh.z);
    vec2 p = vec2(disc.x, (1.0 - s) * sqrt(max(1.0 - disc.x * disc.x, 0.0)) + s * disc.y);
    vec3 nh = p.x * t1 + p.y * cross(vh, t1) + sqrt(max(1.0 - dot(p, p), 0.0)) * vh;
    return normalize(vec3(alpha * nh.xy, max(nh.z, 0.0)));
}
// end snippet

// Smith's Lambda for GGX (Heitz 2014, eq. 72).
float smith_lambda(float cos_theta, float alpha)
{
    float cos2 = cos_theta * cos_theta;
    return 0.5 * (sqrt(1.0 + alpha * alpha * (1.0 - cos2) / cos2) - 1.0);
}

const float kGoldenAngle = 2.39996323;  // rad

#ifndef OWN_TRACE_LOBE
// Mean radiance along a cone: every run of surfaces that it meets by the share that it stops. Few cones share a lobe,
// so none leaves to chance which of them it sees.
// snippet: trace_lobe
vec3 trace_lobe(RayStart start, vec3 direction, float tan_half)
{
    WalkRay ray = walk_ray(start.position, direction);
    float reach = reach_of(range_specular);
    float exit = min(exit_distance(start.position, direction, 0.0), reach), end = exit - kBeforeSide;
    float own_end = own_blur_end(start, direction), t = 0.0, open = 1.0;
    vec3 radiance = vec3(0.0);
    while (t < end && open > 1.0 - kStopped) {
        WalkRun run = next_run(ray, start, own_end, end, t);
        if (run.covered == 0.0) continue;
        float stopped = open - run.covered < 1.0 - kStopped ? open : run.covered;
        radiance += stopped * light_from(start.position, direction, run.t, level_of(2.0 * run.t * tan_half));
        open -= stopped;
    }
    if (open == 0.0) return radiance;
    bool closed = exit < reach && closed_at(ray, start.position, exit);
    return radiance + open * (closed ? light_from(start.position, direction, exit, level_of(2.0 * exit * tan_half))
                                     : sky_radiance);
}
// end snippet
#endif

void main()
{
    GBufferSample surface = read_g_buffer(ivec2(gl_FragCoord.xy));
    lobe_light = vec4(0.0);
    if (!surface.covered || !has_lobe(surface)) return;
    vec3 view = view_direction(surface.position), normal = lobe_normal(surface, view);
    float n_dot_v = max(dot(normal, view), 1e-3), f0 = max(surface.f0.r, max(surface.f0.g, surface.f0.b));

    mat3 frame = frame_around(normal);
    vec3 v = transpose(frame) * view;
    float alpha = surface.roughness * surface.roughness, lambda_v = smith_lambda(n_dot_v, alpha);
    // Of all points of the lobe a pixel takes every 16th, where its neighbours have the others.
    ivec2 pixel = ivec2(gl_FragCoord.xy) & 3;
    int count = surface.roughness < kSharp ? 1 : specular_cones;
    int sets = interleave && surface.roughness >= kShared ? 16 : 1, set = sets == 1 ? 0 : pixel.x + 4 * pixel.y;
    float tan_half = tan(lobe_half_angle(alpha, lobe_share) / sqrt(float(count * sets)));
    RayStart start = start_above(grid_from_scene(surface.position), surface.geometric_normal, start_offset);
    vec4 sum = vec4(0.0);
    // snippet: specular_cones
    for (int i = 0; i < count; ++i) {
        // Points of equal shares of the disc (Vogel 1979); a single one is its middle, the mirror direction.
        int point = i * sets + set;
        float r = count * sets == 1 ? 0.0 : sqrt((float(point) + 0.5) / float(count * sets));
        float phi = float(point) * kGoldenAngle + turn;
        vec3 h = visible_normal(v, alpha, r * vec2(cos(phi), sin(phi)));
        vec3 l = reflect(-v, h), direction = frame * l;
        if (l.z <= 0.0 || dot(direction, surface.geometric_normal) <= 0.0) continue;
        // What visible normals leave of the estimator is G2 / G1 (Heitz 2018, eq. 19), times Fresnel (Schlick 1994).
        float fresnel = schlick_fresnel(vec3(f0), surface.f90, dot(v, h)).r;
        float weight = fresnel * (1.0 + lambda_v) / (1.0 + lambda_v + smith_lambda(l.z, alpha));
        sum += weight * vec4(trace_lobe(start, direction, tan_half), 1.0);
    }
    // end snippet
    lobe_light = STORE(sum.rgb / max(sum.a, 1e-6));
}
