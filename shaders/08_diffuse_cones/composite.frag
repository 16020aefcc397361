#version 450 core
// The picture is the sum of its parts, each the radiance that leaves the surface towards the camera:
// L = direct + rho * (E / pi) + specular + emission.
#include "common/g_buffer.glsl"

layout(binding = 16) uniform sampler2D direct_light;     // radiance
layout(binding = 17) uniform sampler2D gathered_light;   // E / pi, ambient
layout(binding = 18) uniform sampler2D specular_light;   // radiance
uniform vec4 parts;          // direct, diffuse, specular, emission: 1 or 0
uniform bool show_ambient;
uniform float bounce_strength;  // artistic, 1 = right
uniform float ao_strength;      // artistic, 0 = right
uniform float direct_ao_strength;  // the same for direct light
uniform vec3 sky_radiance;
layout(location = 0) out vec4 color;

// A part that a chapter does not have is one black texel.
vec4 at(sampler2D part, ivec2 pixel) { return texelFetch(part, min(pixel, textureSize(part, 0) - 1), 0); }

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GBufferSample surface = read_g_buffer(pixel);
    vec4 gathered = at(gathered_light, pixel);
    float ambient = gathered.a;
    vec3 indirect = bounce_strength * mix(1.0, ambient, ao_strength) *
                    (parts.y * surface.albedo * gathered.rgb + parts.z * at(specular_light, pixel).rgb);
    vec3 direct = mix(1.0, ambient, direct_ao_strength) * parts.x * at(direct_light, pixel).rgb;
    vec3 radiance = direct + indirect + parts.w * surface.emission;
    if (show_ambient) radiance = vec3(ambient);
    vec3 background = show_ambient ? vec3(1.0) : min(dot(parts, vec4(1.0)), 1.0) * sky_radiance * parts.w;
    color = surface.covered ? vec4(radiance, 1.0) : vec4(background, 0.0);
}
