// The material of a fragment: at its centre of area, textures averaged over about its own size, in linear light.
#include "common/material.glsl"

struct VoxelMaterial {
    vec3 albedo;     // reflectance of both lobes: rho, and what the specular one reflects in the mean
    vec3 emission;   // radiance, W/(sr m^2)
    vec3 normal;     // interpolated, unit; no normal map: its details are smaller than voxels
    float coverage;  // share of the fragment that an alpha mask lets stay
    int sides;       // 1, or 2 when double-sided
};

// Directional-hemispherical reflectance of the specular lobe, its mean over the cosine: F0 x + F90 y. Polynomials in the
// roughness through the integrals of chapter 09's table, within 0.003 of x and 0.0005 of y; 20/21 and 1/21 when smooth.
// A voxel sends light to all sides alike, so of a lobe it keeps the power and not the direction; without it metals would
// send nothing, and rooms with glossy surfaces would grow darker with every bounce.
// snippet: lobe_reflectance
vec2 lobe_reflectance(float r)
{
    float x = 0.95356 + r * (-0.06649 + r * (0.79085 + r * (-2.81514 + r * 1.54639)));
    float y = 0.04613 + r * (0.05210 + r * (-0.45261 + r * (0.60111 - r * 0.24441)));
    return vec2(x, y);
}
// end snippet

// Of a point in the triangle's plane, turned grid space; clamped to the triangle.
vec3 barycentric(GridTriangle t, vec3 p)
{
    float inverse = 1.0 / max(dot(t.normal, t.normal), 1e-30);
    float b1 = dot(cross(p - t.v0, t.v2 - t.v0), t.normal) * inverse;
    float b2 = dot(cross(t.v1 - t.v0, p - t.v0), t.normal) * inverse;
    vec3 b = clamp(vec3(1.0 - b1 - b2, b1, b2), 0.0, 1.0);
    return b / (b.x + b.y + b.z);
}

#if UV
// Level of detail at which a texel is as large as the fragment: half the log2 of the texels on it.
float fragment_lod(GridTriangle t, TriangleAttributes a, float area, ivec2 texels)
{
    vec2 e = (a.uv1.xy - a.uv0.xy) * vec2(texels), f = (a.uv2.xy - a.uv0.xy) * vec2(texels);
    float texels_per_area = abs(e.x * f.y - e.y * f.x) / max(length(t.normal), 1e-30);
    return 0.5 * log2(max(texels_per_area * area, 1e-6));
}
#endif

VoxelMaterial voxel_material(GridTriangle t, TriangleAttributes a, vec3 point, float area)
{
    MaterialData m = drawn_material;
    vec3 b = barycentric(t, point);
    VoxelMaterial v;
    v.normal = normalize(mat3(a.normal0, a.normal1, a.normal2) * b + 1e-6 * axis_from_z(t.normal, t.axis));
    v.sides = (m.flags & kMaterialDoubleSided) != 0 ? 2 : 1;
    vec4 color = a.color0 * b.x + a.color1 * b.y + a.color2 * b.z;
    vec4 base = m.base_color * color;
    vec3 emission = m.emission.rgb;
    float metallic = m.metallic, roughness = m.roughness;
#if UV
    vec4 uv = a.uv0 * b.x + a.uv1 * b.y + a.uv2 * b.z;
#define SAMPLE_SLOT(t2d, slot) \
    textureLod(t2d, texture_uv(m, slot, uv.xy, uv.zw), fragment_lod(t, a, area, textureSize(t2d, 0)))
#endif
#if BASE_COLOR_TEXTURE
    base *= SAMPLE_SLOT(base_color_texture, kBaseColorSlot);
#endif
#if METALLIC_ROUGHNESS_TEXTURE
    vec4 metallic_roughness = SAMPLE_SLOT(metallic_roughness_texture, kMetallicRoughnessSlot);
    metallic *= metallic_roughness.b;
    roughness *= metallic_roughness.g;
#endif
#if EMISSION_TEXTURE
    emission *= SAMPLE_SLOT(emission_texture, kEmissionSlot).rgb;
#endif
    bool masked = (m.flags & kMaterialMasked) != 0;
#if COVERAGE_TEXTURE
    v.coverage = SAMPLE_SLOT(coverage_texture, kBaseColorSlot).r;
#else
    v.coverage = !masked || base.a >= m.emission.a ? 1.0 : 0.0;
#endif
    base = min(base, vec4(1.0));
    bool unlit = (m.flags & kMaterialUnlit) != 0;  // shines with its colour and reflects nothing
    vec3 f0 = mix(min(kDielectricF0 * m.specular.rgb, vec3(1.0)) * m.specular.a, base.rgb, metallic);
    vec2 lobe = lobe_reflectance(max(roughness, kMinRoughness));
    vec3 albedo = base.rgb * (1.0 - metallic) + f0 * lobe.x + mix(m.specular.a, 1.0, metallic) * lobe.y;
    v.albedo = unlit ? vec3(0.0) : min(albedo, vec3(1.0));
    v.emission = unlit ? base.rgb : emission;
    return v;
}
