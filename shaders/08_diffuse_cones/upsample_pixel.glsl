// main() of the upsampling programs: the four points around a pixel, each by its bilinear weight where it lies on the pixel's
// surface. GATHER: what a pixel gathers that none of them fits.
#include "common/g_buffer.glsl"
#include "08_diffuse_cones/points.glsl"

layout(binding = 17) uniform sampler2D gathered_light;
layout(location = 0) out vec4 gathered;  // rgb: E / pi, a: ambient

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(points, 0) - 1;
    GBufferSample surface = read_g_buffer(pixel);
    gathered = vec4(0.0);
    if (!surface.covered) return;
    vec3 position = grid_from_scene(surface.position);
    // snippet: upsample
    vec2 place = vec2(pixel - gather_offset) / float(gather_scale), first = floor(place), part = place - first;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 corner = ivec2(i & 1, i >> 1), other = clamp(ivec2(first) + corner, ivec2(0), last);
        vec2 bilinear = mix(1.0 - part, part, vec2(corner)) + 1e-4;
        bool same = same_surface(texelFetch(points, other, 0), position, surface.geometric_normal, surface.normal);
        float weight = same ? bilinear.x * bilinear.y : 0.0;
        sum += weight * texelFetch(gathered_light, other, 0);
        weights += weight;
    }
    gathered = sum / max(weights, 1e-9);
    // end snippet
    if (weights > 0.0) return;
    RayStart start = start_above(position, surface.geometric_normal, start_offset);
    Gathered own = GATHER(start, surface.geometric_normal, surface.normal, position, (pixel.x & 3) + 4 * (pixel.y & 3));
    gathered = vec4(own.mean_radiance, own.ambient);
}
