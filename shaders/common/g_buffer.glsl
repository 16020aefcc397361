// Reads the g-buffer of chapter 02 (g_buffer.hpp). GBuffer::bind() binds its textures and the camera block.
#include "common/scene.glsl"
#include "common/material_constants.glsl"
#include "common/octahedral.glsl"

layout(binding = 8) uniform sampler2D g_depth;              // reversed: 1 near, 0 far and where nothing was drawn
layout(binding = 9) uniform sampler2D g_normal;             // octahedral
layout(binding = 10) uniform sampler2D g_geometric_normal;  // octahedral
layout(binding = 11) uniform sampler2D g_base_color_metallic;
layout(binding = 12) uniform sampler2D g_f0_f90;
layout(binding = 13) uniform sampler2D g_emission_roughness;

uniform int g_depth_bits;  // 0: as stored; otherwise as if depth were fixed point with so many bits (chapter 02)

struct GBufferSample {
    bool covered;           // false: nothing was drawn, the rest is zero
    vec3 position;          // scene space, m
    vec3 normal;            // shading normal, unit, of the side that is seen
    vec3 geometric_normal;  // of the triangle, unit, towards the camera
    vec3 albedo;            // diffuse reflectance rho
    vec3 base_color;
    float metallic;
    float roughness;        // perceptual; alpha = roughness^2
    vec3 f0;
    float f90;
    vec3 emission;          // W/(sr m^2)
    float depth;            // m along the camera's axis
};

// snippet: position_from_depth
// Scene space position of a point of the picture: pixel centre (x, y) + 0.5 and its depth value.
vec3 position_from_depth(vec2 pixel, float depth)
{
    return unproject(2.0 * pixel * camera.size.zw - 1.0, depth);  // depth is 0..1 in clip space as well
}
// end snippet

GBufferSample read_g_buffer(ivec2 pixel)
{
    GBufferSample s;
    float depth = texelFetch(g_depth, pixel, 0).r;
    s.covered = depth > 0.0;
    if (g_depth_bits > 0) depth = (floor(depth * exp2(float(g_depth_bits))) + 0.5) * exp2(-float(g_depth_bits));
    if (!s.covered)
        return GBufferSample(false, vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), 0.0, 0.0, vec3(0.0), 0.0,
                             vec3(0.0), 0.0);
    s.position = position_from_depth(vec2(pixel) + 0.5, depth);
    s.depth = axial_distance(s.position);
    s.normal = octahedral_decode(texelFetch(g_normal, pixel, 0).rg);
    s.geometric_normal = octahedral_decode(texelFetch(g_geometric_normal, pixel, 0).rg);
    vec4 base = texelFetch(g_base_color_metallic, pixel, 0);
    vec4 fresnel = texelFetch(g_f0_f90, pixel, 0);
    vec4 emission = texelFetch(g_emission_roughness, pixel, 0);
    s.base_color = base.rgb;
    s.metallic = base.a;
    s.albedo = base.rgb * (1.0 - base.a);
    s.f0 = fresnel.rgb;
    s.f90 = fresnel.a;
    s.emission = emission.rgb;
    s.roughness = max(emission.a, kMinRoughness);
    return s;
}
