#version 450 core
// Neighbouring points share what they gathered: along rows, then along columns, a tent of 7 that holds each of the 4
// sets of a row in equal parts. Only points of the same surface count.
#include "common/g_buffer.glsl"
#include "08_diffuse_cones/points.glsl"

layout(binding = 17) uniform sampler2D gathered_light;
uniform ivec2 along;  // (1, 0) or (0, 1)
layout(location = 0) out vec4 filtered;

void main()
{
    ivec2 place = ivec2(gl_FragCoord.xy), last = textureSize(gathering_points, 0) - 1;
    uvec4 center = texelFetch(gathering_points, place, 0);
    ivec2 pixel = min(gathering_pixel(place), ivec2(camera.size.xy) - 1);
    vec3 position = uintBitsToFloat(center.xyz), normal = octahedral_decode(unpackSnorm2x16(center.w));
    vec3 geometric_normal = octahedral_decode(texelFetch(g_geometric_normal, pixel, 0).rg);
    // snippet: filter
    vec4 sum = 4.0 * texelFetch(gathered_light, place, 0);
    float weights = 4.0;
    for (int i = -3; i <= 3; ++i) {
        if (i == 0) continue;
        ivec2 other = clamp(place + i * along, ivec2(0), last);
        float weight = same_surface(texelFetch(gathering_points, other, 0), position, geometric_normal, normal) ? float(4 - abs(i)) : 0.0;
        sum += weight * texelFetch(gathered_light, other, 0);
        weights += weight;
    }
    // end snippet
    filtered = sum / weights;
}
