#version 450 core
// The mean over the samples of each pixel.
layout(binding = 16) uniform sampler2D samples;
uniform int side;  // of a pixel, in samples
layout(location = 0) out vec4 color;

void main()
{
    ivec2 corner = side * ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < side * side; ++i) sum += texelFetch(samples, corner + ivec2(i % side, i / side), 0);
    color = sum / float(side * side);
}
