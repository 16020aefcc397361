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

// What a material's textures hold at a point; 1 where it has none.
struct TextureSamples {
    vec4 base_color;          // linear
    vec4 metallic_roughness;  // g: roughness, b: metallic
    vec3 emission;            // linear
    float specular;
    vec3 specular_color;      // linear
};

// The material rule, for pixels and for voxels; the path tracer has the same in common/reference/surface.cpp. F0 and
// F90 are those of the mix of dielectric and metal (KHR_materials_specular; index of refraction 1.5).
SurfaceMaterial material_at(MaterialData m, TextureSamples t, vec4 vertex_color)
{
    vec4 base = m.base_color * vertex_color * t.base_color;
    SurfaceMaterial s;
    s.alpha = base.a;
    s.base_color = min(base.rgb, vec3(1.0));
    s.metallic = m.metallic * t.metallic_roughness.b;
    s.roughness = max(m.roughness * t.metallic_roughness.g, kMinRoughness);
    s.specular = m.specular.a * t.specular;
    s.albedo = s.base_color * (1.0 - s.metallic);
    vec3 dielectric_f0 = min(kDielectricF0 * (m.specular.rgb * t.specular_color), vec3(1.0)) * s.specular;
    s.f0 = mix(dielectric_f0, s.base_color, s.metallic);
    s.f90 = mix(s.specular, 1.0, s.metallic);
    s.emission = m.emission.rgb * t.emission;
    if ((m.flags & kMaterialUnlit) != 0) {  // shines with its colour and reflects nothing
        s.emission = s.base_color;
        s.base_color = s.albedo = s.f0 = vec3(0.0);
        s.f90 = 0.0;
    }
    return s;
}
