#version 450 core
// Specular light: in mirrors what rays found, in rougher lobes the light that a diffuse surface would reflect, with the
// mean of Schlick's reflectance over the hemisphere, F0 + (F90 - F0) / 21.
#include "common/g_buffer.glsl"

layout(binding = 16) uniform sampler2D gathered_light;  // E / pi
layout(binding = 17) uniform sampler2D mirror_light;    // radiance; alpha 1 where there is a mirror
layout(location = 0) out vec4 color;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GBufferSample surface = read_g_buffer(pixel);
    vec4 mirror = texelFetch(mirror_light, min(pixel, textureSize(mirror_light, 0) - 1), 0);
    vec3 lobe = surface.f0 + (surface.f90 - surface.f0) / 21.0;
    color = vec4(mirror.a > 0.5 ? mirror.rgb : lobe * texelFetch(gathered_light, pixel, 0).rgb,
                 surface.covered ? 1.0 : 0.0);
}
