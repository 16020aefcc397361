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

#if PUNCTUAL
vec3 from_light(int i)
{
    LightSample light = sample_light(lights[i], position);
    return light.irradiance * max(dot(normal, light.direction), 0.0);
}
#else
// snippet: form_factor
// What a disc of area A, radiance flux / (pi A), gives a patch at distance r: E = flux cos cos / (pi r^2 + A). Exact on
// the disc's axis; without A it would grow without end where the two come close.
vec3 from_light(int i)
{
    PatchLight light = patch_lights[i];
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
    // snippet: seen_lights
    for (int word = first_light / 32; area > 0.0 && 32 * word < end_light; ++word)
        for (uint seen = sight[word * patch_count + patch_id]; seen != 0u; seen &= seen - 1u)
            sum += from_light(32 * word + findLSB(seen));
    // end snippet
    irradiance = vec4(sum, 1.0);
}
