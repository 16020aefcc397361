#version 450 core
// Radiance of the surface under each pixel: what it emits and what it reflects of every light.
#include "common/surface.glsl"
#include "common/brdf.glsl"
#include "common/light.glsl"

uniform int shown;        // ForwardOutput, forward_pass.hpp
const int kShowRadiance = 0;
const int kShowDirect = 1;
const int kShowEmission = 2;
const int kShowBaseColor = 3;
const int kShowNormal = 4;
const int kShowDepth = 5;

layout(location = 0) out vec4 color;  // alpha: 1 where there is a surface

vec3 direct_light(Surface s)
{
    SurfaceMaterial m = s.material;
    // snippet: light_loop
    vec3 radiance = vec3(0.0);  // W/(sr m^2)
    for (int i = 0; i < light_count; ++i) {
        LightSample light = sample_light(lights[i], s.position);
        radiance += reflected_radiance(s.normal, s.view, light.direction, light.irradiance,
                                       m.albedo, m.roughness, m.f0, m.f90);
    }
    // end snippet
    return radiance;
}

void main()
{
    Surface s = read_surface();
    vec3 value = vec3(0.0);
    switch (shown) {
    case kShowRadiance: value = direct_light(s) + s.material.emission; break;
    case kShowDirect: value = direct_light(s); break;
    case kShowEmission: value = s.material.emission; break;
    case kShowBaseColor: value = s.material.base_color; break;
    case kShowNormal: value = 0.5 + 0.5 * s.normal; break;
    case kShowDepth: value = vec3(axial_distance(s.position)); break;
    }
    color = vec4(value, 1.0);
}
