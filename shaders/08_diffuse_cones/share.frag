#version 450 core
// Neighbouring pixels share their cones: the mean over a window that holds every set once, of pixels on the same surface.
// Run twice, with windows that lean to opposite sides: together a tent of 7 x 7 pixels around the pixel.
#include "common/g_buffer.glsl"

layout(binding = 16) uniform sampler2D gathered_light;
uniform float plane_tolerance;  // m
uniform int window_begin;       // pixels from the pixel to the window's first column and row
layout(location = 0) out vec4 shared_light;

const int kWindow = 4;
const float kMinCosine = 0.9;  // between normals of one surface

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GBufferSample center = read_g_buffer(pixel);
    shared_light = vec4(0.0);
    if (!center.covered) return;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    // snippet: share
    for (int i = 0; i < kWindow * kWindow; ++i) {
        ivec2 other = pixel + ivec2(i % kWindow, i / kWindow) + window_begin;
        other = clamp(other, ivec2(0), textureSize(gathered_light, 0) - 1);
        GBufferSample neighbour = read_g_buffer(other);
        float off_plane = abs(dot(neighbour.position - center.position, center.geometric_normal));
        bool same = neighbour.covered && off_plane < plane_tolerance &&
                    dot(neighbour.normal, center.normal) > kMinCosine;
        sum += same ? texelFetch(gathered_light, other, 0) : vec4(0.0);
        weights += same ? 1.0 : 0.0;
    }
    // end snippet
    shared_light = sum / max(weights, 1.0);
}
