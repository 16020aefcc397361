#version 450 core
// Neighbouring pixels share the light of wide lobes, as they share diffuse cones (chapter 08, filter.frag): run twice
// with windows that lean to opposite sides. The second time the mean light becomes reflected light.
#include "common/g_buffer.glsl"
#include "09_specular_cones/specular_surface.glsl"

layout(binding = 16) uniform sampler2D directional_albedo;  // x: n.v, y: roughness; albedo = F0 r + F90 g
layout(binding = 17) uniform sampler2D lobe_light;          // mean radiance in the lobe
uniform bool interleave;
uniform bool reflect_it;
uniform float plane_tolerance;  // m
uniform int window_begin;       // pixels from the pixel to the window's first column and row
layout(location = 0) out vec4 specular;  // rgb: the same, or radiance towards the camera

const int kWindow = 4;
const float kMinCosine = 0.98;        // between mirror directions: 11 degrees, a third of the narrowest shared lobe
const float kSameRoughness = 0.02;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GBufferSample center = read_g_buffer(pixel);
    specular = vec4(0.0);
    if (!center.covered || !has_lobe(center)) return;
    vec3 view = view_direction(center.position), normal = lobe_normal(center, view), mirrored = reflect(-view, normal);
    specular = texelFetch(lobe_light, pixel, 0);
    if (interleave && center.roughness >= kShared) {
        vec4 sum = vec4(0.0);
        for (int i = 0; i < kWindow * kWindow; ++i) {
            ivec2 other = pixel + ivec2(i % kWindow, i / kWindow) + window_begin;
            other = clamp(other, ivec2(0), textureSize(lobe_light, 0) - 1);
            GBufferSample neighbour = read_g_buffer(other);
            vec3 other_view = view_direction(neighbour.position);
            bool same = neighbour.covered && has_lobe(neighbour) &&
                        abs(neighbour.roughness - center.roughness) < kSameRoughness &&
                        abs(dot(neighbour.position - center.position, center.geometric_normal)) < plane_tolerance &&
                        dot(reflect(-other_view, lobe_normal(neighbour, other_view)), mirrored) > kMinCosine;
            sum += same ? texelFetch(lobe_light, other, 0) : vec4(0.0);
        }
        specular = sum.a > 0.0 ? sum / sum.a : specular;
    }
    if (!reflect_it) return;
    // The mean of the light in the lobe, times the lobe's albedo.
    vec2 size = vec2(textureSize(directional_albedo, 0)), entry = vec2(dot(normal, view), center.roughness) * (size - 1.0);
    vec2 table = texture(directional_albedo, (entry + 0.5) / size).rg;
    specular.rgb *= center.f0 * table.x + center.f90 * table.y;
}
