// The material model of the book: f = rho/pi + F D V, Lambert plus GGX. The path tracer has the same in
// common/reference/brdf.cpp. All directions are unit vectors that point away from the surface.
#include "common/material_constants.glsl"

const float kPi = 3.14159265358979;

// snippet: ggx
// GGX distribution of microfacet normals, 1/sr (Walter et al. 2007, eq. 33). The usual n.h^2 (alpha^2 - 1) + 1 is
// written as alpha^2 cos^2 + sin^2: a narrow lobe loses no digits to cancellation.
float ggx_distribution(vec3 n, vec3 h, float alpha)
{
    float cos_h = dot(n, h);
    vec3 sin_h = cross(n, h);
    float d = alpha * alpha * cos_h * cos_h + dot(sin_h, sin_h);
    return alpha * alpha / (kPi * d * d);
}
// end snippet

// snippet: smith_fresnel
// Height-correlated Smith masking and shadowing over 4 n.l n.v (Heitz 2014, eq. 99).
float smith_visibility(float n_dot_v, float n_dot_l, float alpha)
{
    float a2 = alpha * alpha;
    return 0.5 / (n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0 - a2) + a2) +
                  n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - a2) + a2));
}

// Fresnel reflectance (Schlick 1994) from f0 at normal to f90 at grazing incidence.
vec3 schlick_fresnel(vec3 f0, float f90, float v_dot_h)
{
    float m = clamp(1.0 - v_dot_h, 0.0, 1.0);
    return f0 + (vec3(f90) - f0) * (m * m * m * m * m);
}
// end snippet

// Interpolated and mapped normals may turn away from the eye, where the visibility term is not defined: lift the
// view to the horizon.
vec3 clamp_view(vec3 n, vec3 v)
{
    float n_dot_v = dot(n, v);
    return n_dot_v >= kMinNdotV ? v : normalize(v + (kMinNdotV - n_dot_v) * n);
}

// GGX lobe, 1/sr, without the cosine. alpha = roughness^2.
vec3 specular_brdf(vec3 n, vec3 v, vec3 l, float alpha, vec3 f0, float f90)
{
    float n_dot_l = dot(n, l);
    if (n_dot_l <= 0.0) return vec3(0.0);
    v = clamp_view(n, v);
    vec3 h = normalize(v + l);
    return schlick_fresnel(f0, f90, dot(v, h)) *
           (ggx_distribution(n, h, alpha) * smith_visibility(dot(n, v), n_dot_l, alpha));
}

// snippet: reflected_radiance
// Radiance towards v from light that comes from direction l and gives `irradiance` (W/m^2) on a plane
// perpendicular to it: L = (rho/pi + F D V) E cos(theta).
vec3 reflected_radiance(vec3 n, vec3 v, vec3 l, vec3 irradiance, vec3 albedo, float roughness, vec3 f0, float f90)
{
    vec3 brdf = albedo / kPi + specular_brdf(n, v, l, roughness * roughness, f0, f90);
    return brdf * irradiance * max(dot(n, l), 0.0);
}
// end snippet
