#version 450 core
// Direct light of every punctual light at every covered pixel of the g-buffer.
// SHADOWS 1 multiplies each light with the visibility that the shadow maps of chapter 03 give.
#include "common/g_buffer.glsl"
#include "common/brdf.glsl"
#include "common/light.glsl"
#if SHADOWS
#include "common/shadow_map.glsl"
#endif

uniform bool with_emission;

layout(location = 0) out vec4 radiance;  // W/(sr m^2); alpha: 1 where there is a surface

// snippet: direct_light
void main()
{
    GBufferSample s = read_g_buffer(ivec2(gl_FragCoord.xy));
    vec3 view = view_direction(s.position);
    vec3 sum = with_emission ? s.emission : vec3(0.0);
    for (int i = 0; s.covered && i < light_count; ++i) {
        LightSample light = sample_light(lights[i], s.position);
        vec3 irradiance = light.irradiance;
#if SHADOWS
        bool faces_light = dot(s.geometric_normal, light.direction) > 0.0;  // else it lies in its own shadow
        irradiance *= faces_light ? shadow_map_visibility(i, lights[i], s.position, s.geometric_normal) : 0.0;
#endif
        sum += reflected_radiance(s.normal, view, light.direction, irradiance, s.albedo, s.roughness, s.f0, s.f90);
    }
    radiance = vec4(sum, s.covered ? 1.0 : 0.0);
}
// end snippet
