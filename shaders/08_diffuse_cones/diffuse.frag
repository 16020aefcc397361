#version 450 core
// Indirect diffuse light of every pixel.
#include "common/g_buffer.glsl"
#include "common/diffuse_gather.glsl"

layout(location = 0) out vec4 gathered;  // rgb: E / pi, a: ambient

void main()
{
    GBufferSample surface = read_g_buffer(ivec2(gl_FragCoord.xy));
    gathered = vec4(0.0);
    if (!surface.covered) return;
    ivec2 pixel = ivec2(gl_FragCoord.xy) & 3;
    Gathered sum = gather_diffuse(grid_from_scene(surface.position), surface.geometric_normal, surface.normal,
                                  pixel.x + 4 * pixel.y);
    gathered = vec4(sum.mean_radiance, sum.ambient);
#ifdef COUNT_FETCHES
    gathered = vec4(float(fetches));
#endif
}
