#version 450 core
// Indirect specular light of every pixel: one cone along the mirror direction, as wide as the GGX lobe.
#include "common/g_buffer.glsl"
#include "common/cone.glsl"

layout(binding = 16) uniform sampler2D directional_albedo;  // x: n.v, y: roughness; albedo = F0 r + F90 g
uniform float lobe_share;
uniform float start_offset;
layout(location = 0) out vec4 specular;  // rgb: radiance towards the camera

// Half the angle of the cone around the mirror direction that holds the share p of the lobe, seen along the normal.
// Microfacet normals: tan^2 = alpha^2 p / (1 - p) (the inverse of Walter et al. 2007, eq. 35); reflection doubles it.
// snippet: lobe
float lobe_half_angle(float alpha, float share)
{
    return min(2.0 * atan(alpha * sqrt(share / (1.0 - share))), 1.2);
}
// end snippet

void main()
{
    GBufferSample surface = read_g_buffer(ivec2(gl_FragCoord.xy));
    specular = vec4(0.0);
    if (!surface.covered) return;
    vec3 view = view_direction(surface.position);
    // Interpolated and mapped normals may turn away from the eye; nothing can be mirrored there but in the facet itself.
    vec3 normal = dot(surface.normal, view) > 0.0 ? surface.normal : surface.geometric_normal;
    float n_dot_v = max(dot(normal, view), 0.0);
    vec2 table = texture(directional_albedo, vec2(n_dot_v, surface.roughness)).rg;
    vec3 albedo = surface.f0 * table.x + surface.f90 * table.y;
    bool reflects = max(albedo.r, max(albedo.g, albedo.b)) > 1e-4;

    // The surface cuts the lobe at its horizon: what is left of it is narrower, and its middle lies higher.
    vec3 mirrored = reflect(-view, normal);
    float elevation = asin(min(n_dot_v, 1.0)), half_angle = lobe_half_angle(surface.roughness * surface.roughness, lobe_share);
    if (half_angle > elevation) {
        half_angle = 0.5 * (elevation + half_angle);
        vec3 along = mirrored - dot(mirrored, normal) * normal;
        mirrored = cos(half_angle) * along / max(length(along), 1e-6) + sin(half_angle) * normal;
    }
    Cone cone = cone_above(grid_from_scene(surface.position), surface.geometric_normal, start_offset, mirrored,
                           tan(half_angle));
    ConeLight light = trace_cone(cone, reflects ? cone_end(cone) : 0.0);
    if (reflects) specular = vec4(albedo * (light.radiance + light.transmittance * sky_radiance), 1.0);
}
