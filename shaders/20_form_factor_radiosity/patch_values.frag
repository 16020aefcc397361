#version 450 core
// The value of the patch that a pixel of the g-buffer lies on.
#include "common/g_buffer.glsl"

in vec3 position;
in vec3 value;
uniform float scale;
layout(location = 0) out vec4 color;

const float kSameDepth = 1.0e-4;  // of the depth: rounding, and no more

void main()
{
    // Other patches may lie in front or behind, and holes of an alpha mask are in none.
    GBufferSample surface = read_g_buffer(ivec2(gl_FragCoord.xy));
    if (!surface.covered || abs(axial_distance(position) - surface.depth) > kSameDepth * abs(surface.depth)) discard;
    color = vec4(scale * value, 1.0);
}
