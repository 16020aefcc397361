// The material of a fragment: at its centre of area, textures averaged over about its own size, in linear light.
#include "common/material.glsl"

struct VoxelMaterial {
    vec3 albedo;     // reflectance of both lobes: rho, and what the specular one reflects in the mean
    vec3 emission;   // radiance, W/(sr m^2)
    vec3 normal;     // interpolated, unit; no normal map: its details are smaller than voxels
    float coverage;  // share of the fragment that an alpha mask lets stay
    int sides;       // 1, or 2 when double-sided
};

// Directional-hemispherical reflectance of the specular lobe, its mean over the cosine: F0 x + F90 y. Polynomials in
// the roughness through the integrals of chapter 09's table, within 0.003 of x and 0.0005 of y; 20/21 and 1/21 when
// smooth. A voxel sends light to all sides alike, so of a lobe it keeps the power and not the direction; without it
// metals would send nothing, and rooms with glossy surfaces would grow darker with every bounce.
// snippet: lobe_reflectance
vec2 lobe_reflectance(float r)
{
    float x = 0.95356 + r * (-0.06649 + r * (0.79085 + r * (-2.81514 + r * 1.54639)));
    float y = 0.04613 + r * (0.05210 + r * (-0.45261 + r * (0.60111 - r * 0.24441)));
    return vec2(x, y);
}
// end snippet

// Of a point in the triangle's plane, turned grid space.
vec3 barycentric(GridTriangle t, vec3 p)
{
    float inverse = 1.0 / max(dot(t.normal, t.normal), 1e-30);
    float b1 = dot(cross(p - t.v0, t.v2 - t.v0), t.normal) * inverse;
    float b2 = dot(cross(t.v1 - t.v0, p - t.v0), t.normal) * inverse;
    return vec3(1.0 - b1 - b2, b1, b2);
}

// The same, clamped to the triangle.
vec3 on_triangle(GridTriangle t, vec3 p)
{
    vec3 b = clamp(barycentric(t, p), 0.0, 1.0);
    return b / (b.x + b.y + b.z);
}

#if TEXTURES
vec4 uv_at(TriangleAttributes a, vec3 b) { return a.uv0 * b.x + a.uv1 * b.y + a.uv2 * b.z; }

// Level of detail at which a texel is as large as the fragment: half the log2 of the texels on it.
float fragment_lod(GridTriangle t, TriangleAttributes a, float area, ivec2 texels)
{
    vec2 e = (a.uv1.xy - a.uv0.xy) * vec2(texels), f = (a.uv2.xy - a.uv0.xy) * vec2(texels);
    float texels_per_area = abs(e.x * f.y - e.y * f.x) / max(length(t.normal), 1e-30);
    return 0.5 * log2(max(texels_per_area * area, 1e-6));
}
#endif

#if VERTEX_ALPHA
// Share of the part that the mask leaves where vertices have an alpha of their own: factor, vertex and texture together
// against the cutoff, as pixels do it, at points spread evenly over the part (Roberts 2018, R2 sequence). Where the
// texture is finer than the points' distance a single voxel is off by 1/16 (half of sqrt(1/64)) in the mean; over many
// voxels that evens out.
const int kMaskPoints = 64;

float masked_alpha(TriangleAttributes a, vec3 b)
{
    float alpha = drawn_material.base_color.a * dot(vec3(a.color0.a, a.color1.a, a.color2.a), b);
#if BASE_COLOR_TEXTURE
    vec4 uv = uv_at(a, b);
    alpha *= textureLod(base_color_texture, texture_uv(drawn_material, kBaseColorSlot, uv.xy, uv.zw), 0.0).a;
#endif
    return alpha;
}

float sampled_coverage(GridTriangle t, TriangleAttributes a, ivec3 voxel_t, vec3 center)
{
    float cutoff = drawn_material.emission.a;
    // The part's box, seen along the axis.
    vec2 low = max(min(t.v0.xy, min(t.v1.xy, t.v2.xy)), vec2(voxel_t.xy));
    vec2 high = min(max(t.v0.xy, max(t.v1.xy, t.v2.xy)), vec2(voxel_t.xy) + 1.0);
    const vec2 kStep = vec2(0.7548776662, 0.5698402910);
    vec2 s = fract(vec2(voxel_t.xy) * kStep.yx + float(voxel_t.z) * kStep);  // neighbours have other points
    float inside = 0.0, left = 0.0;
    for (int i = 0; i < kMaskPoints; ++i) {
        s = fract(s + kStep);
        vec2 xy = mix(low, high, s);
        vec3 p = vec3(xy, t.v0.z - dot(slope_of(t), xy - t.v0.xy)), b = barycentric(t, p);
        bool counts = all(greaterThanEqual(b, vec3(0.0))) && floor(p.z) == float(voxel_t.z);
        inside += counts ? 1.0 : 0.0;
        left += counts && masked_alpha(a, b) >= cutoff ? 1.0 : 0.0;
    }
    // A part so small or thin that no point is inside: its centre decides.
    return inside > 0.0 ? left / inside : masked_alpha(a, on_triangle(t, center)) >= cutoff ? 1.0 : 0.0;
}
#endif

// `part`: of the triangle, in voxel_t (turned axes).
VoxelMaterial voxel_material(GridTriangle t, TriangleAttributes a, ivec3 voxel_t, TrianglePart part)
{
    MaterialData m = drawn_material;
    vec3 point = vec3(voxel_t) + part.center, b = on_triangle(t, point);
    TextureSamples samples = TextureSamples(vec4(1.0), vec4(1.0), vec3(1.0), 1.0, vec3(1.0));
#if TEXTURES
    vec4 uv = uv_at(a, b);
#define SAMPLE(texture_of_slot, slot)                                  \
    textureLod(texture_of_slot, texture_uv(m, slot, uv.xy, uv.zw), \
               fragment_lod(t, a, part.area, textureSize(texture_of_slot, 0)))
#endif
#if BASE_COLOR_TEXTURE
    samples.base_color = SAMPLE(base_color_texture, kBaseColorSlot);
#endif
#if METALLIC_ROUGHNESS_TEXTURE
    samples.metallic_roughness = SAMPLE(metallic_roughness_texture, kMetallicRoughnessSlot);
#endif
#if EMISSION_TEXTURE
    samples.emission = SAMPLE(emission_texture, kEmissionSlot).rgb;
#endif
#if SPECULAR_TEXTURE
    samples.specular = SAMPLE(specular_texture, kSpecularSlot).a;
#endif
#if SPECULAR_COLOR_TEXTURE
    samples.specular_color = SAMPLE(specular_color_texture, kSpecularColorSlot).rgb;
#endif
    SurfaceMaterial s = material_at(m, samples, a.color0 * b.x + a.color1 * b.y + a.color2 * b.z);

    VoxelMaterial v;
    v.normal = normalize(mat3(a.normal0, a.normal1, a.normal2) * b + 1e-6 * axis_from_z(t.normal, t.axis));
    v.sides = (m.flags & kMaterialDoubleSided) != 0 ? 2 : 1;
    vec2 lobe = lobe_reflectance(s.roughness);
    v.albedo = min(s.albedo + s.f0 * lobe.x + s.f90 * lobe.y, vec3(1.0));
    v.emission = s.emission;
#if VERTEX_ALPHA
    v.coverage = sampled_coverage(t, a, voxel_t, point);
#elif COVERAGE_TEXTURE
    v.coverage = SAMPLE(coverage_texture, kBaseColorSlot).r;
#else
    v.coverage = (m.flags & kMaterialMasked) == 0 || s.alpha >= m.emission.a ? 1.0 : 0.0;
#endif
    return v;
}
