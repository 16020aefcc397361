// main() of the gathering programs. STORE: what a point keeps of what it gathers.
#include "common/g_buffer.glsl"
#include "08_diffuse_cones/gather.glsl"
#include "08_diffuse_cones/points.glsl"

#ifndef STORE
#define STORE(sum) vec4(sum.mean_radiance, sum.ambient)
#endif

layout(location = 0) out vec4 gathered;  // rgb: E / pi, a: ambient

void main()
{
    ivec2 place = ivec2(gl_FragCoord.xy);
    GBufferSample surface = read_g_buffer(min(gathering_pixel(place), ivec2(camera.size.xy) - 1));
    gathered = vec4(0.0);
    if (!surface.covered) return;
    vec3 position = grid_from_scene(surface.position);
    RayStart start = start_above(position, surface.geometric_normal, start_offset);
    // In every 4 x 4 points each of the 16 sets comes once.
    Gathered sum = gather_diffuse(start, surface.geometric_normal, surface.normal, (place.x & 3) + 4 * (place.y & 3));
    gathered = STORE(sum);
}
