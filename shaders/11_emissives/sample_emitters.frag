#version 450 core
// Every point that gathers aims a set of rays at parts of the emitters.
#include "common/g_buffer.glsl"
#include "07_anisotropic_mips/pyramid.glsl"
#include "08_diffuse_cones/walk.glsl"
#include "08_diffuse_cones/cone_common.glsl"
#include "08_diffuse_cones/points.glsl"
#include "11_emissives/emitters.glsl"

uniform float start_offset;
uniform int first_set;  // another one for each of many pictures of the same scene
layout(location = 0) out vec4 arriving;    // rgb: E / pi of a set
layout(location = 1) out vec4 unshadowed;  // the same if nothing were in the way

void main()
{
    ivec2 place = ivec2(gl_FragCoord.xy);
    GBufferSample surface = read_g_buffer(min(gathering_pixel(place), ivec2(camera.size.xy) - 1));
    arriving = unshadowed = vec4(0.0);
    if (!surface.covered) return;
    vec3 position = grid_from_scene(surface.position);
    RayStart start = start_above(position, surface.geometric_normal, start_offset);
    EmitterSamples samples = sample_emitters(start, position, surface.geometric_normal, surface.normal,
                                             (place.x & 3) + 4 * (place.y & 3) + first_set);
    arriving.rgb = samples.arriving;
    unshadowed.rgb = samples.unshadowed;
}
