#version 450 core
// Look-ups of every pixel: as numbers, or as a heat map from black (none) through red and yellow to white (`largest`).
#include "common/color_scales.glsl"
#include "common/g_buffer.glsl"

layout(binding = 16) uniform sampler2D diffuse_counts;   // of points: steps, fetches
layout(binding = 17) uniform sampler2D specular_counts;  // of pixels
uniform float largest;      // 0: numbers
uniform int gather_scale;   // pixels along a side to a point
layout(location = 0) out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 diffuse = texelFetch(diffuse_counts, pixel / gather_scale, 0).rg, specular = texelFetch(specular_counts, pixel, 0).rg;
    color = vec4(diffuse.r + diffuse.g, specular.r + specular.g, 0.0, read_g_buffer(pixel).covered ? 1.0 : 0.0);
    color.b = color.r + color.g;
    if (largest > 0.0) color = vec4(heat_color(color.b / largest), 1.0);
}
