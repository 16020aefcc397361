// Fragment shaders: the surface under a pixel, with material, mapped normal and the side that faces the eye.
// The vertex shader is 01_first_light/scene.vert.
#include "common/material.glsl"

in vec3 vertex_position;  // scene space, m
in vec3 vertex_normal;
in vec4 vertex_tangent;   // w: sign of the bitangent
in vec2 vertex_uv0;
in vec2 vertex_uv1;
in vec4 vertex_color;     // linear

struct Surface {
    vec3 position;          // scene space, m
    vec3 normal;            // shading normal, unit, of the side that is seen
    vec3 geometric_normal;  // of the triangle, unit, towards the eye
    vec3 view;              // unit, towards the eye
    SurfaceMaterial material;
};

// snippet: surface_normal
vec3 mapped_normal(MaterialData m)
{
    vec3 n = normalize(vertex_normal);
    if (m.uv_row[2 * kNormalSlot + 1].w > 0.5) {  // glTF 2.0, 3.9.3
        vec2 uv = texture_uv(m, kNormalSlot, vertex_uv0, vertex_uv1);
        vec3 map = 2.0 * texture(normal_texture, uv).xyz - 1.0;
        vec3 t = vertex_tangent.xyz;
        vec3 b = vertex_tangent.w * cross(vertex_normal, t);
        vec3 mapped = m.normal_scale * (map.x * t + map.y * b) + map.z * n;
        if (dot(mapped, mapped) > 1.0e-12) n = normalize(mapped);
    }
    return gl_FrontFacing ? n : -n;  // the back of a double-sided surface
}
// end snippet

// The normal of the triangle itself: the position is linear on it, so its differences span the plane.
vec3 facet_normal(vec3 view, vec3 shading_normal)
{
    vec3 n = cross(dFdx(vertex_position), dFdy(vertex_position));
    float squared = dot(n, n);
    n = squared > 1.0e-30 ? n * inversesqrt(squared) : shading_normal;
    return dot(n, view) < 0.0 ? -n : n;
}

// Discards where an alpha mask is cut out.
Surface read_surface()
{
    MaterialData m = drawn_material;
    Surface s;
    s.position = vertex_position;
    s.view = view_direction(vertex_position);
    s.normal = mapped_normal(m);
    s.geometric_normal = facet_normal(s.view, s.normal);
    TextureSamples t;
#define SAMPLE(texture_of_slot, slot) texture(texture_of_slot, texture_uv(m, slot, vertex_uv0, vertex_uv1))
    t.base_color = SAMPLE(base_color_texture, kBaseColorSlot);
    t.metallic_roughness = SAMPLE(metallic_roughness_texture, kMetallicRoughnessSlot);
    t.emission = SAMPLE(emission_texture, kEmissionSlot).rgb;
    t.specular = SAMPLE(specular_texture, kSpecularSlot).a;
    t.specular_color = SAMPLE(specular_color_texture, kSpecularColorSlot).rgb;
    s.material = material_at(m, t, vertex_color);
    if ((m.flags & kMaterialMasked) != 0 && s.material.alpha < m.emission.a) discard;
    return s;
}
