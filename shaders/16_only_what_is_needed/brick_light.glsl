// The pyramids as lists of what is there: a voxel's place by its brick, from there how many texels it has and where the
// first one is. What is not there has texel 0, which is empty. Part of 07_anisotropic_mips/pyramid.glsl, in place of
// light_atlas.glsl.
#include "16_only_what_is_needed/brick_occupancy.glsl"

layout(binding = kBrickVoxelUnit) uniform usampler2D brick_voxels;  // first texel << 6 | directions that have one
layout(binding = kLightAtlasUnit) uniform sampler2D light_list;
layout(binding = kEmissionAtlasUnit) uniform sampler2D emission_list;
#ifdef SPLIT_COVERAGE
layout(binding = kCoverageAtlasUnit) uniform sampler2D coverage_list;
#endif

// snippet: stored_place
ivec2 stored_place(int face, ivec3 voxel, int level)
{
    uint place = place_in(brick_of(voxel, level), voxel);
    uint entry = texelFetch(brick_voxels, list_place(place), 0).r, bit = 1u << face;
    return list_place((entry & bit) != 0u ? (entry >> 6) + uint(bitCount(entry & (bit - 1u))) : 0u);
}
// end snippet

#define STORED_IMAGE image2D
#define STORED_PLACE ivec2
bool is_stored(ivec2 place) { return place != ivec2(0); }

vec3 fetch_emission(ivec2 place) { return texelFetch(emission_list, place, 0).rgb; }
#ifdef SPLIT_COVERAGE
float fetch_coverage(ivec2 place) { return texelFetch(coverage_list, place, 0).r; }
vec4 fetch_light(ivec2 place) { return vec4(texelFetch(light_list, place, 0).rgb, fetch_coverage(place)); }
#else
float fetch_coverage(ivec2 place) { return texelFetch(light_list, place, 0).a; }
vec4 fetch_light(ivec2 place) { return texelFetch(light_list, place, 0); }
#endif

// What GL_LINEAR does, with weights of full precision.
// snippet: between
#define BETWEEN(value, fetch, face, p, level)                                                         \
    ivec3 last = level_size(level) - 1, low = clamp(ivec3(floor(p - 0.5)), ivec3(0), last), high = min(low + 1, last); \
    vec3 part = clamp(p - 0.5 - vec3(low), 0.0, 1.0);                                                 \
    value v000 = fetch(stored_place(face, low, level));                                               \
    value v100 = fetch(stored_place(face, ivec3(high.x, low.yz), level));                             \
    value v010 = fetch(stored_place(face, ivec3(low.x, high.y, low.z), level));                       \
    value v110 = fetch(stored_place(face, ivec3(high.xy, low.z), level));                             \
    value v001 = fetch(stored_place(face, ivec3(low.xy, high.z), level));                             \
    value v101 = fetch(stored_place(face, ivec3(high.x, low.y, high.z), level));                      \
    value v011 = fetch(stored_place(face, ivec3(low.x, high.yz), level));                             \
    value v111 = fetch(stored_place(face, high, level));                                              \
    return mix(mix(mix(v000, v100, part.x), mix(v010, v110, part.x), part.y),                         \
               mix(mix(v001, v101, part.x), mix(v011, v111, part.x), part.y), part.z)
// end snippet

vec4 light_of(int face, ivec3 voxel, int level) { return fetch_light(stored_place(face, voxel, level)); }
vec4 light_at(int face, vec3 p, int level) { BETWEEN(vec4, fetch_light, face, p, level); }
float coverage_at(int face, vec3 p, int level) { BETWEEN(float, fetch_coverage, face, p, level); }
vec3 emission_of(int face, ivec3 voxel, int level)
{
    return emission_scale * fetch_emission(stored_place(face, voxel, level));
}
vec3 stored_emission_at(int face, vec3 p, int level) { BETWEEN(vec3, fetch_emission, face, p, level); }
vec3 emission_at(int face, vec3 p, int level) { return emission_scale * stored_emission_at(face, p, level); }
