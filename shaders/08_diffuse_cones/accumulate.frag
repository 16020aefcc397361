#version 450 core
// The mean of many pictures, one more at a time: m(k) = m(k - 1) + (p - m(k - 1)) / k.
layout(binding = 16) uniform sampler2D picture;
layout(binding = 17) uniform sampler2D mean_before;
uniform float share;  // 1 / k
layout(location = 0) out vec4 mean;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 now = texelFetch(picture, pixel, 0);
    mean = share == 1.0 ? now : mix(texelFetch(mean_before, pixel, 0), now, share);
}
