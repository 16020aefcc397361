#version 450 core
// Photons: every texel of a light's view carries the flux that leaves the light through it, and gives it to the face
// that it sees. One thread a texel.
#include "common/scene_structs.glsl"
#include "common/light.glsl"
#include "common/voxel_grid.glsl"
#include "17_sparse_voxel_octree/leaf_faces.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 16) uniform sampler2D light_view;  // depth, 1 near, 0 where there is nothing
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kFluxBinding) buffer FluxBuffer { uint flux[]; };  // of a face: 3 low words, 3 high ones
uniform int light_index;
uniform mat4 scene_from_clip;
uniform float half_width;  // of the part of the view that counts, in ndc: six views of a point light overlap a little
uniform float flux_unit;   // W

vec3 unproject(vec2 ndc, float depth)
{
    vec4 p = scene_from_clip * vec4(ndc, depth, 1.0);
    return p.xyz / p.w;
}

// Solid angle of a triangle of directions (Van Oosterom & Strackee 1983).
float solid_angle(vec3 a, vec3 b, vec3 c)
{
    return 2.0 * abs(atan(dot(a, cross(b, c)), 1.0 + dot(a, b) + dot(b, c) + dot(c, a)));
}

// What leaves the light through the texel: E dA of a directional light, I dw of the others, whose irradiance at the
// distance d is I / d^2 before anything else.
// snippet: texel_flux
vec3 texel_flux(LightData light, vec2 low, vec2 high, vec3 hit)
{
    LightSample to_hit = sample_light(light, hit);
    vec3 a = unproject(low, 0.0), b = unproject(vec2(high.x, low.y), 0.0);
    vec3 c = unproject(high, 0.0), d = unproject(vec2(low.x, high.y), 0.0);
    if (int(light.position.w) == kLightDirectional) return to_hit.irradiance * length(cross(b - a, d - a));
    vec3 p = light.position.xyz;
    a = normalize(a - p);
    b = normalize(b - p);
    c = normalize(c - p);
    d = normalize(d - p);
    return to_hit.irradiance * to_hit.distance * to_hit.distance * (solid_angle(a, b, c) + solid_angle(a, c, d));
}
// end snippet

// The face of the voxel at a place that looks most towards the light; kNoFace where none does.
const uint kNoFace = 0xffffffffu;
uint face_towards(vec3 place, vec3 to_light)
{
    ivec3 voxel = ivec3(floor(place));
    uint entry = leaf_entry(find_node(voxel >> 1, tree_depth - 1), voxel), found = kNoFace;
    float best = 0.0;
    for (uint i = entry >> 6; i < (entry >> 6) + uint(bitCount(face_mask(entry))); ++i) {
        float towards = faces[i].albedo_area.a > 0.0 ? dot(faces[i].normal.xyz, to_light) : 0.0;
        if (towards <= best) continue;
        best = towards;
        found = i;
    }
    return found;
}

// 64 bits in two atomics, as chapter 05 adds: the order of the threads does not matter.
// snippet: add_flux
void add_flux(uint word, float watt)
{
    float units = round(watt / flux_unit), high = floor(units / 4294967296.0);
    uint low = uint(units - high * 4294967296.0), before = atomicAdd(flux[word], low);
    uint into_high = uint(high) + (before + low < before ? 1u : 0u);
    if (into_high != 0u) atomicAdd(flux[word + 3u], into_high);
}
// end snippet

void main()
{
    ivec2 size = textureSize(light_view, 0), texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, size))) return;
    float depth = texelFetch(light_view, texel, 0).r;
    vec2 low = clamp(2.0 * vec2(texel) / vec2(size) - 1.0, -half_width, half_width);
    vec2 high = clamp(2.0 * vec2(texel + 1) / vec2(size) - 1.0, -half_width, half_width);
    if (depth <= 0.0 || any(lessThanEqual(high, low))) return;
    LightData light = lights[light_index];
    vec3 hit = unproject(2.0 * (vec2(texel) + 0.5) / vec2(size) - 1.0, depth);
    vec3 to_light = sample_light(light, hit).direction, place = grid_from_scene(hit);
    // Rounding must not decide between two voxels: a little further on, and a little nearer.
    const float kRounding = 0.02;  // voxels
    uint face = face_towards(place, to_light);
    if (face == kNoFace) face = face_towards(place - kRounding * to_light, to_light);
    if (face == kNoFace) face = face_towards(place + kRounding * to_light, to_light);
    if (face == kNoFace) return;
    vec3 watt = texel_flux(light, low, high, hit);
    for (uint channel = 0u; channel < 3u; ++channel) add_flux(6u * face + channel, watt[channel]);
}
