#version 450 core
// A picture and its reference: left half of one and right half of the other, or how far they are apart.
#include "common/color_scales.glsl"

layout(binding = 0) uniform sampler2D picture;
layout(binding = 1) uniform sampler2D reference;
uniform bool difference;  // else half and half
uniform float range;      // difference that is shown in full colour

layout(location = 0) out vec4 linear;
layout(location = 1) out vec4 colors;

// snippet: signed_difference
// (I - R) / (I + R): 0 equal, 1/3 twice as bright, -1/3 half as bright, -1 black; 0 where both are black. Its mean
// magnitude is SMAPE.
vec3 signed_difference(vec3 i, vec3 r)
{
    vec3 sum = i + r;
    return mix(vec3(0.0), (i - r) / max(sum, vec3(1e-30)), greaterThan(sum, vec3(0.0)));
}
// end snippet

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 i = texelFetch(picture, pixel, 0), r = texelFetch(reference, pixel, 0);
    if (!difference) {
        linear = pixel.x < textureSize(reference, 0).x / 2 ? i : r;
        colors = linear;
        return;
    }
    if (r.a <= 0.0) {
        linear = vec4(0.0);
        colors = vec4(vec3(96.0 / 255.0), 1.0);
        return;
    }
    linear = vec4(signed_difference(i.rgb, r.rgb), 1.0);
    float all = signed_difference(vec3(dot(i.rgb, vec3(1.0))), vec3(dot(r.rgb, vec3(1.0)))).x;
    colors = vec4(difference_color(all / range), 1.0);
}
