#version 450 core
// What emitters send to every pixel, by rays aimed at them; added to what the cones have gathered.
#include "common/g_buffer.glsl"
#include "common/emitters.glsl"

layout(location = 0) out vec4 aimed;  // rgb: E / pi

void main()
{
    GBufferSample surface = read_g_buffer(ivec2(gl_FragCoord.xy));
    aimed = vec4(0.0);
    if (!surface.covered) return;
    ivec2 pixel = ivec2(gl_FragCoord.xy) & 3;
    aimed.rgb = gather_emitters(grid_from_scene(surface.position), surface.geometric_normal, surface.normal,
                                pixel.x + 4 * pixel.y);
#ifdef COUNT_FETCHES
    aimed.rgb = vec3(float(fetches));
#endif
}
