#version 450 core
// What one look-up costs: rays through a cube of texels, as cones go. A pixel begins at its place on the cube's near
// side and goes in one of 16 directions, which neighbours in a window of 4 x 4 divide among them.
uniform int look_ups;  // of every pixel
uniform vec2 inverse_size;
#if TRILINEAR
layout(binding = 0) uniform sampler3D volume;
#else
layout(binding = 0) uniform usampler3D volume;
uniform int side;  // texels
#endif
layout(location = 0) out vec4 sum;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float angle = 0.3926991 * float((pixel.x & 3) + 4 * (pixel.y & 3));  // 2 pi / 16
    vec3 place = vec3(gl_FragCoord.xy * inverse_size, 0.0);
    vec3 stride = vec3(0.4 * cos(angle), 0.4 * sin(angle), 1.0) / float(look_ups);
    sum = vec4(0.0);
    for (int i = 0; i < look_ups; ++i) {
#if TRILINEAR
        sum += textureLod(volume, place, 0.0);
#else
        sum.x += float(texelFetch(volume, clamp(ivec3(place * float(side)), ivec3(0), ivec3(side - 1)), 0).r);
#endif
        place += stride;
    }
}
