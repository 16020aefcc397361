#version 450 core
// Fetches of every pixel: as numbers, or as a heat map from black (none) through red and yellow to white (`largest`).
#include "common/color_scales.glsl"
#include "common/g_buffer.glsl"

layout(binding = 16) uniform sampler2D diffuse_fetches;
layout(binding = 17) uniform sampler2D specular_fetches;
uniform float largest;  // 0: numbers
layout(location = 0) out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float diffuse = texelFetch(diffuse_fetches, pixel, 0).r, specular = texelFetch(specular_fetches, pixel, 0).r;
    color = vec4(diffuse, specular, diffuse + specular, read_g_buffer(pixel).covered ? 1.0 : 0.0);
    if (largest > 0.0) color = vec4(heat_color(color.b / largest), 1.0);
}
