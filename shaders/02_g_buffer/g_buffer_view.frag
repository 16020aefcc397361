#version 450 core
// One attachment of the g-buffer as a picture.
#include "common/g_buffer.glsl"

uniform int attachment;  // GBufferView, g_buffer_view.hpp

layout(location = 0) out vec4 color;

void main()
{
    GBufferSample s = read_g_buffer(ivec2(gl_FragCoord.xy));
    vec3 value = vec3(0.0);
    switch (attachment) {
    case 0: value = s.emission; break;
    case 1: value = s.base_color; break;
    case 2: value = 0.5 + 0.5 * s.normal; break;
    case 3: value = vec3(s.depth); break;
    case 4: value = 0.5 + 0.5 * s.geometric_normal; break;
    case 5: value = vec3(s.metallic); break;
    case 6: value = vec3(s.roughness); break;
    case 7: value = s.f0; break;
    case 8: value = vec3(s.f90); break;
    case 9: value = s.position; break;
    }
    color = s.covered ? vec4(value, 1.0) : vec4(0.0);
}
