#version 450 core
// The subdivided scene as the camera sees it: every vertex looks up its own light, and the rasterizer interpolates.
#include "common/scene.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec4 in_tangent;
layout(location = 3) in vec2 in_uv0;
layout(location = 4) in vec2 in_uv1;
layout(location = 5) in vec4 in_color;
layout(binding = 8) uniform sampler2D direct_map;    // irradiance, W/m^2
layout(binding = 9) uniform sampler2D indirect_map;
uniform int map_side, back_offset;
uniform vec2 parts;  // of direct and indirect light

out vec3 vertex_position;
out vec3 vertex_normal;
out vec4 vertex_tangent;
out vec2 vertex_uv0;
out vec2 vertex_uv1;
out vec4 vertex_color;
out vec3 front_irradiance, back_irradiance;  // W/m^2

// snippet: look_up
vec3 irradiance(int patch_id)
{
    ivec2 place = ivec2(patch_id % map_side, patch_id / map_side);
    return parts.x * texelFetch(direct_map, place, 0).rgb + parts.y * texelFetch(indirect_map, place, 0).rgb;
}
// end snippet

void main()
{
    vertex_position = in_position;
    vertex_normal = in_normal;
    vertex_tangent = in_tangent;
    vertex_uv0 = in_uv0;
    vertex_uv1 = in_uv1;
    vertex_color = in_color;
    front_irradiance = irradiance(gl_VertexID);
    back_irradiance = irradiance(gl_VertexID + back_offset);
    gl_Position = camera.clip_from_scene * vec4(in_position, 1.0);
}
