#version 450 core
// Irradiance of one patch. PUNCTUAL 1: of the scene's lights; 0: of patches that have become lights.
#include "common/bindings.glsl"
#include "19_vertex_radiosity/patch_structs.glsl"
#if PUNCTUAL
#include "common/light.glsl"
#else
layout(std430, binding = kPatchLightBinding) readonly buffer PatchLightBuffer { PatchLight patch_lights[]; };
#endif
layout(std430, binding = kSightBinding) readonly buffer SightBuffer { uint sight[]; };

flat in int patch_id;
flat in vec3 position;
flat in vec3 normal;
flat in float area;  // 0: a side that nobody sees
uniform int patch_count;
uniform int first_light, end_light;
uniform int form_factor;  // FormFactor: 0 exact, 1 published

layout(location = 0) out vec4 irradiance;  // W/m^2

const float kPi = 3.14159265358979;

bool sees(int light) { return (sight[(light >> 5) * patch_count + patch_id] >> (light & 31) & 1u) != 0u; }

#if !PUNCTUAL
// snippet: form_factor
// What a disc of area A, radiance flux / (pi A), gives a patch at distance r: E = flux cos cos / (pi r^2 + A). Exact on
// the disc's axis; without A it would grow without end where the two come close.
vec3 from_patch(PatchLight light)
{
    vec3 way = light.position.xyz - position;
    float squared = max(dot(way, way), 1.0e-30);
    way *= inversesqrt(squared);
    float cosines = max(dot(normal, way), 0.0) * max(-dot(light.normal.xyz, way), 0.0);
    float disc = light.position.w;
    if (form_factor == 0) return light.flux.rgb * cosines / (kPi * squared + disc);
    return light.flux.rgb / disc * 2.0 * cosines;  // as published: no pi, no distance, doubled
}
// end snippet
#endif

void main()
{
    vec3 sum = vec3(0.0);
    for (int i = first_light; area > 0.0 && i < end_light; ++i) {
        if (!sees(i)) continue;
#if PUNCTUAL
        LightSample light = sample_light(lights[i], position);
        sum += light.irradiance * max(dot(normal, light.direction), 0.0);
#else
        sum += from_patch(patch_lights[i]);
#endif
    }
    irradiance = vec4(sum, 1.0);
}
