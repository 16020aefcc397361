#version 450 core
// What a light sees, texel by texel: the patch there, how much light it has, and the flux that the texel reflects. The
// camera stands at the light (01_first_light/scene.vert).
#include "common/surface.glsl"
#include "common/light.glsl"
#include "19_vertex_radiosity/patches.glsl"

layout(std430, binding = kIndexBinding) readonly buffer PatchIndexBuffer { uint patch_indices[]; };
layout(binding = 8) uniform sampler2D direct_map;  // irradiance, W/m^2
uniform int light_index, first_triangle, map_side;
uniform int back_offset;    // number of the back of patch 0
uniform float view_side;    // texels
uniform float tangent;      // of half the view's angle; 0: a parallel projection
uniform float texel_area;   // of a parallel projection, m^2

layout(location = 0) out vec4 chosen;           // xyz: position, scene space; w: number of the patch, -1: none
layout(location = 1) out vec4 normal_energy;    // xyz: unit, towards the light; w: mean irradiance of the patch, W/m^2
layout(location = 2) out vec4 flux_area;        // rgb: reflected flux, W; a: area that the texel sees, m^2

// snippet: texel_solid_angle
// Solid angle between (0, 0, 1), (x, 0, 1), (x, y, 1) and (0, y, 1), as seen from the origin.
float corner_solid_angle(vec2 p) { return atan(p.x * p.y / sqrt(1.0 + dot(p, p))); }

float texel_solid_angle(vec2 texel)
{
    vec2 low = (2.0 * texel / view_side - 1.0) * tangent, high = (2.0 * (texel + 1.0) / view_side - 1.0) * tangent;
    return corner_solid_angle(high) - corner_solid_angle(vec2(low.x, high.y)) -
           corner_solid_angle(vec2(high.x, low.y)) + corner_solid_angle(low);
}
// end snippet

// Of the triangle's three vertices the one that is nearest: its patch holds the point.
int nearest_patch()
{
    int nearest = 0;
    float least = 0.0;
    for (int k = 0; k < 3; ++k) {
        int id = int(patch_indices[3 * (first_triangle + gl_PrimitiveID) + k]);
        float d = distance(patches[id].position.xyz, vertex_position);
        if (k == 0 || d < least) nearest = id;
        least = k == 0 ? d : min(d, least);
    }
    return nearest;
}

void main()
{
    Surface s = read_surface();
    if (!gl_FrontFacing && (drawn_material.flags & kMaterialDoubleSided) == 0) {  // blocks light and reflects none
        chosen = vec4(s.position, -1.0);
        normal_energy = vec4(s.normal, -1.0);
        flux_area = vec4(0.0);
        return;
    }
    int id = nearest_patch() + (gl_FrontFacing ? 0 : back_offset);
    vec3 energy = texelFetch(direct_map, map_place(id, map_side), 0).rgb;
    LightSample light = sample_light(lights[light_index], s.position);
    // snippet: texel_flux
    // Across the light's way the texel is so large, and so much of the light's flux goes through it.
    float across = tangent > 0.0 ? texel_solid_angle(floor(gl_FragCoord.xy)) * light.distance * light.distance : texel_area;
    vec3 flux = light.irradiance * across;
    // end snippet
    chosen = vec4(s.position, float(id));
    normal_energy = vec4(s.normal, (energy.r + energy.g + energy.b) / 3.0);
    flux_area = vec4(s.material.albedo * flux, across / max(dot(s.geometric_normal, s.view), 1.0e-3));
}
