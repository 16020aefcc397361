#version 450 core
// Scene-linear values to what a display shows: exposure, tone curve, sRGB. Once, as the last step of a frame.

layout(binding = 0) uniform sampler2D linear_picture;
uniform int encoding;        // Encoding: 0 radiance, 1 colour, 2 data
uniform int tone_curve;      // ToneCurve: 0 Reinhard, 1 clamp
uniform float exposure;      // factor on radiance
uniform float white;         // exposed luminance that is shown as white
uniform bool srgb;
uniform float data_scale;    // factor on data, so that lengths fit into 0..1

layout(location = 0) out vec4 display;

// snippet: reinhard
// Luminance of linear sRGB primaries (ITU-R BT.709, 3.2).
float luminance(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

// Reinhard et al. 2002, eq. 4, on the luminance; the colour keeps its chromaticity.
vec3 reinhard(vec3 c)
{
    float l = luminance(c);
    float shown = l * (1.0 + l / (white * white)) / (1.0 + l);
    return l > 0.0 ? c * (shown / l) : vec3(0.0);
}
// end snippet

// snippet: srgb_encode
// IEC 61966-2-1.
vec3 srgb_encode(vec3 c)
{
    c = clamp(c, 0.0, 1.0);
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}
// end snippet

void main()
{
    vec3 c = texelFetch(linear_picture, ivec2(gl_FragCoord.xy), 0).rgb;
    if (encoding == 0) {
        c *= exposure;
        if (tone_curve == 0) c = reinhard(c);
    }
    if (encoding == 2)
        c *= data_scale;
    else if (srgb)
        c = srgb_encode(c);
    display = vec4(clamp(c, 0.0, 1.0), 1.0);
}
