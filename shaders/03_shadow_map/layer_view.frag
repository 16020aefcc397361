#version 450 core
// One layer of the shadow maps as grey.
#include "common/shadow_structs.glsl"

layout(binding = kShadowMapUnit) uniform sampler2DArray shadow_maps;
uniform int layer;
uniform vec2 picture_size;
layout(location = 0) out vec4 color;

void main() { color = vec4(vec3(texture(shadow_maps, vec3(gl_FragCoord.xy / picture_size, layer)).r), 1.0); }
