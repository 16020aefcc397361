#version 450 core
// Direct light with one of three shadows. METHOD 0: shadow map, 1: cone to the light, 2: visibility volume.
#include "common/g_buffer.glsl"
#include "common/brdf.glsl"
#include "common/light.glsl"
#include "07_anisotropic_mips/pyramid.glsl"
#if METHOD == 0
#include "common/shadow_map.glsl"
#elif METHOD == 1
#include "10_soft_shadows/shadow_cone.glsl"
#else
#include "10_soft_shadows/kept_visibility.glsl"
#endif

uniform bool show_visibility;
layout(location = 0) out vec4 color;

float visibility(int i, LightSample light, GBufferSample surface)
{
#if METHOD == 0
    return shadow_map_visibility(i, lights[i], surface.position, surface.geometric_normal);
#elif METHOD == 1
    return cone_visibility(surface.position, surface.geometric_normal, light);
#else
    return kept_visibility(surface.position, surface.geometric_normal, i);
#endif
}

void main()
{
    GBufferSample surface = read_g_buffer(ivec2(gl_FragCoord.xy));
    color = vec4(0.0);
    if (!surface.covered) return;
    vec3 view = view_direction(surface.position), radiance = vec3(0.0);
    float visible_share = 0.0, counted = 0.0;
    for (int i = 0; i < light_count; ++i) {
        LightSample light = sample_light(lights[i], surface.position);
        // A light whose middle is below the surface's horizon is hidden by the surface itself.
        float visible = dot(light.direction, surface.geometric_normal) > 0.0 ? visibility(i, light, surface) : 0.0;
        radiance += visible * reflected_radiance(surface.normal, view, light.direction, light.irradiance,
                                                 surface.albedo, surface.roughness, surface.f0, surface.f90);
        visible_share += visible;
        counted += 1.0;
    }
    color = vec4(show_visibility ? vec3(visible_share / max(counted, 1.0)) : radiance, 1.0);
}
