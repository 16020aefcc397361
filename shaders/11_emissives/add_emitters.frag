#version 450 core
// What cones have gathered and what emitters send: their exact light times the share that arrives at the points around
// the pixel that lie on its surface. A pixel that no point fits aims its own rays.
#include "common/g_buffer.glsl"
#include "07_anisotropic_mips/pyramid.glsl"
#include "08_diffuse_cones/walk.glsl"
#include "08_diffuse_cones/cone_common.glsl"
#include "08_diffuse_cones/points.glsl"
#include "11_emissives/emitters.glsl"

layout(binding = 17) uniform sampler2D arriving_light;
layout(binding = 18) uniform sampler2D unshadowed_samples;
layout(binding = 19) uniform sampler2D gathered_light;
uniform float start_offset;
layout(location = 0) out vec4 light;  // rgb: E / pi, a: ambient

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GBufferSample surface = read_g_buffer(pixel);
    light = texelFetch(gathered_light, pixel, 0);
    if (!surface.covered) return;
    vec3 position = grid_from_scene(surface.position), arriving = vec3(0.0), unshadowed = vec3(0.0);
    PointWeights points = points_around(pixel, position, surface.geometric_normal, surface.normal);
    for (int i = 0; i < 4; ++i) {
        arriving += points.weight[i] * texelFetch(arriving_light, points.place[i], 0).rgb;
        unshadowed += points.weight[i] * texelFetch(unshadowed_samples, points.place[i], 0).rgb;
    }
    if (points.sum <= 0.0) {
        RayStart start = start_above(position, surface.geometric_normal, start_offset);
        EmitterSamples samples = sample_emitters(start, position, surface.geometric_normal, surface.normal,
                                                 (pixel.x & 3) + 4 * (pixel.y & 3));
        arriving = samples.arriving;
        unshadowed = samples.unshadowed;
    }
    light.rgb += unshadowed_light(position, surface.normal) * arriving_share(arriving, unshadowed);
}
