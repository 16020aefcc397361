// The pyramids in one atlas, whatever is in them: for every level the six directions side by side along x. Part of
// pyramid.glsl.
layout(binding = kLightAtlasUnit) uniform sampler3D light_atlas;
layout(binding = kEmissionAtlasUnit) uniform sampler3D emission_atlas;
#ifdef SPLIT_COVERAGE
layout(binding = kCoverageAtlasUnit) uniform sampler3D coverage_atlas;
#define WITH_COVERAGE(fetch, place, level) vec4(fetch(light_atlas, place, level).rgb, fetch(coverage_atlas, place, level).r)
#define COVERAGE(fetch, place, level) fetch(coverage_atlas, place, level).r
#else
#define WITH_COVERAGE(fetch, place, level) fetch(light_atlas, place, level)
#define COVERAGE(fetch, place, level) fetch(light_atlas, place, level).a
#endif

vec4 light_of(int face, ivec3 voxel, int level) { return WITH_COVERAGE(texelFetch, atlas_texel(face, voxel, level), level); }
vec4 light_at(int face, vec3 p, int level) { return WITH_COVERAGE(textureLod, atlas_place(face, p, level), float(level)); }
float coverage_at(int face, vec3 p, int level) { return COVERAGE(textureLod, atlas_place(face, p, level), float(level)); }
vec3 emission_of(int face, ivec3 voxel, int level)
{
    return emission_scale * texelFetch(emission_atlas, atlas_texel(face, voxel, level), level).rgb;
}
vec3 emission_at(int face, vec3 p, int level)
{
    return emission_scale * textureLod(emission_atlas, atlas_place(face, p, level), float(level)).rgb;
}

#define STORED_IMAGE image3D
#define STORED_PLACE ivec3
ivec3 stored_place(int face, ivec3 voxel, int level) { return atlas_texel(face, voxel, level); }
bool is_stored(ivec3 place) { return true; }
