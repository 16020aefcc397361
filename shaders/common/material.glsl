// The material at a point of a surface, from factors, textures and vertex colour (glTF 2.0, 3.9 and Appendix B).
#include "common/scene.glsl"
#include "common/material_constants.glsl"

layout(binding = 0) uniform sampler2D base_color_texture;
layout(binding = 1) uniform sampler2D metallic_roughness_texture;
layout(binding = 2) uniform sampler2D normal_texture;
layout(binding = 3) uniform sampler2D emission_texture;
layout(binding = 4) uniform sampler2D specular_texture;
layout(binding = 5) uniform sampler2D specular_color_texture;
layout(binding = 6) uniform sampler2D coverage_texture;

struct SurfaceMaterial {
    vec3 albedo;       // diffuse reflectance rho = base colour * (1 - metallic)
    float roughness;   // perceptual
    vec3 f0;           // reflectance at normal incidence
    float f90;         // at grazing incidence
    vec3 emission;     // radiance, W/(sr m^2)
    float alpha;
    vec3 base_color;
    float metallic;
    float specular;    // specular factor after its texture
};

vec2 texture_uv(MaterialData m, int slot, vec2 uv0, vec2 uv1)
{
    vec3 uv = vec3(m.uv_row[2 * slot].w < 0.5 ? uv0 : uv1, 1.0);
    return vec2(dot(m.uv_row[2 * slot].xyz, uv), dot(m.uv_row[2 * slot + 1].xyz, uv));
}

// F0 and F90 of the mix of dielectric and metal (KHR_materials_specular; ior 1.5: 0.04).
void set_fresnel(inout SurfaceMaterial s, vec3 specular_color)
{
    s.f0 = mix(min(0.04 * specular_color, vec3(1.0)) * s.specular, s.base_color, s.metallic);
    s.f90 = mix(s.specular, 1.0, s.metallic);
    s.albedo = s.base_color * (1.0 - s.metallic);
}
