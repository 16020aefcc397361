#version 450 core
// One of the shadow maps as grey: 1 at its near plane, falling with the distance in metres to 0 at its far one.
// The stored depth of a perspective map would be black nearly everywhere: it falls as 1 / distance.
#include "common/shadow_structs.glsl"

layout(binding = kShadowMapUnit) uniform sampler2DArray shadow_maps;
uniform ivec3 place;  // ShadowLayer::place
uniform int side;
uniform mat4 scene_from_clip;
uniform vec2 picture_size;
layout(location = 0) out vec4 color;

vec3 scene_point(vec2 ndc, float depth)
{
    vec4 p = scene_from_clip * vec4(ndc, depth, 1.0);
    return p.xyz / p.w;
}

void main()
{
    vec2 uv = gl_FragCoord.xy / picture_size, ndc = 2.0 * uv - 1.0;
    float depth = texelFetch(shadow_maps, ivec3(place.xy + ivec2(uv * float(side)), place.z), 0).r;
    vec3 near = scene_point(ndc, 1.0), far = scene_point(ndc, 0.0);
    float grey = 1.0 - distance(near, scene_point(ndc, depth)) / distance(near, far);
    color = vec4(vec3(depth > 0.0 ? grey : 0.0), 1.0);
}
