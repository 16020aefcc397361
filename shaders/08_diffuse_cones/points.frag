#version 450 core
// The points of the pixels that gather, see points.glsl.
#include "common/g_buffer.glsl"
#include "08_diffuse_cones/points.glsl"

layout(location = 0) out uvec4 point;

void main()
{
    ivec2 pixel = min(gathering_pixel(ivec2(gl_FragCoord.xy)), ivec2(camera.size.xy) - 1);
    GBufferSample surface = read_g_buffer(pixel);
    vec3 position = surface.covered ? grid_from_scene(surface.position) : vec3(uintBitsToFloat(0x7f800000u));
    point = pack_point(position, surface.normal);
}
