// main() of the programs that upsample: from points to pixels. The four points around a pixel, each by its bilinear
// weight where it lies on the pixel's surface. A pixel that none of them fits gathers for itself.
#include "common/g_buffer.glsl"
#include "08_diffuse_cones/gather.glsl"
#include "08_diffuse_cones/points.glsl"

layout(binding = 17) uniform sampler2D gathered_light;
layout(location = 0) out vec4 gathered;  // rgb: E / pi, a: ambient

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    GBufferSample surface = read_g_buffer(pixel);
    gathered = vec4(0.0);
    if (!surface.covered) return;
    vec3 position = grid_from_scene(surface.position);
    // snippet: upsample
    PointWeights points = points_around(pixel, position, surface.geometric_normal, surface.normal);
    for (int i = 0; i < 4; ++i) gathered += points.weight[i] * texelFetch(gathered_light, points.place[i], 0);
    // end snippet
    if (points.sum > 0.0) return;
    RayStart start = start_above(position, surface.geometric_normal, start_offset);
    Gathered own = gather_diffuse(start, surface.geometric_normal, surface.normal, (pixel.x & 3) + 4 * (pixel.y & 3));
    gathered = vec4(own.mean_radiance, own.ambient);
}
