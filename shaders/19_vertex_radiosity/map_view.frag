#version 450 core
// The maps as pictures. SHOWN 0: the radiosity map; 1: a level of the map that a light sees.
layout(binding = 8) uniform sampler2D first;   // direct irradiance | chosen
layout(binding = 9) uniform sampler2D second;  // indirect irradiance | normal and energy
uniform vec2 corner, extent;                   // of the picture's rectangle, pixels
uniform float brightest;                       // W/m^2

layout(location = 0) out vec4 color;

// A colour for each patch: neighbours in the list differ, and the order can still be seen.
vec3 patch_color(float id)
{
    vec3 turned = fract(id * vec3(0.61803399, 0.0123, 0.00021) + vec3(0.0, 0.33, 0.67));
    return 0.25 + 0.75 * turned;
}

void main()
{
    vec2 uv = (gl_FragCoord.xy - corner) / extent;
    ivec2 texel = ivec2(uv * vec2(textureSize(first, 0)));
    if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) discard;
#if SHOWN == 0
    color = vec4(texelFetch(first, texel, 0).rgb + texelFetch(second, texel, 0).rgb, 1.0);
#else
    float id = texelFetch(first, texel, 0).w, energy = texelFetch(second, texel, 0).w;
    color = vec4(id < 0.0 ? vec3(0.0) : patch_color(id) * (0.15 + 0.85 * energy / brightest), 1.0);
#endif
}
