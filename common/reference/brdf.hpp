// The material model of the whole book: f = rho/pi + F D V (design.md, "Radiometry").
//
//   rho = base_color * (1 - metallic)
//   F0  = mix(min(0.04 * specular_color, 1) * specular, base_color, metallic)     (KHR_materials_specular)
//   F90 = mix(specular, 1, metallic)
//   F   = F0 + (F90 - F0) (1 - h.v)^5                                             (Schlick 1994)
//   D   = alpha^2 / (pi (n.h^2 (alpha^2 - 1) + 1)^2),  alpha = roughness^2        (GGX, Walter et al. 2007 eq. 33)
//   V   = 0.5 / (n.l sqrt(n.v^2 (1 - alpha^2) + alpha^2) + n.v sqrt(n.l^2 (1 - alpha^2) + alpha^2))
//                                                     (height-correlated Smith G / (4 n.l n.v), Heitz 2014 eq. 99)
// The two lobes are added: the diffuse one is not dimmed by (1 - F). Roughness is clamped to kMinRoughness.
// Directions here are unit vectors in the local shading frame (z = shading normal), pointing away from the surface.
#pragma once

#include <glm/glm.hpp>

#include "common/material_constants.glsl"

namespace conebook {

constexpr float kPi = 3.14159265358979f;

// Orthonormal frame round a unit normal (Duff et al. 2017, "Building an Orthonormal Basis, Revisited", listing 3).
struct Frame {
    glm::vec3 t{1, 0, 0}, b{0, 1, 0}, n{0, 0, 1};
    Frame() = default;
    explicit Frame(const glm::vec3& normal);
    glm::vec3 to_local(const glm::vec3& v) const { return {glm::dot(v, t), glm::dot(v, b), glm::dot(v, n)}; }
    glm::vec3 to_scene(const glm::vec3& v) const { return v.x * t + v.y * b + v.z * n; }
};

struct Brdf {
    glm::vec3 rho{0.0f};  // diffuse albedo, 0..1
    glm::vec3 f0{0.0f};   // specular reflectance at normal incidence
    glm::vec3 f90{0.0f};  // and at grazing incidence
    float alpha = 1.0f;   // GGX width, >= kMinRoughness^2

    static Brdf from_metallic_roughness(const glm::vec3& base_color, float metallic, float roughness, float specular,
                                        const glm::vec3& specular_color);
    bool has_diffuse() const { return rho.x > 0 || rho.y > 0 || rho.z > 0; }
    bool has_specular() const { return f0.x > 0 || f0.y > 0 || f0.z > 0 || f90.x > 0 || f90.y > 0 || f90.z > 0; }
};

// The two lobes' values, 1/sr, without the cosine.
struct BrdfValue {
    glm::vec3 diffuse{0.0f}, specular{0.0f};
    glm::vec3 sum() const { return diffuse + specular; }
};

// wo.z must be >= kMinNdotV (see clamp_view); a wi below the horizon gives 0.
BrdfValue evaluate_brdf(const Brdf& brdf, const glm::vec3& wo, const glm::vec3& wi);

// D(h), 1/sr, of the GGX distribution.
float ggx_distribution(const glm::vec3& h, float alpha);

// Density per solid angle with which sample_brdf returns wi.
float pdf_brdf(const Brdf& brdf, const glm::vec3& wo, const glm::vec3& wi);

// A direction from the mix of cosine-weighted and visible-normal (Heitz 2018) sampling; u in [0, 1)^2, lobe in [0, 1).
// It may lie below the horizon, where the brdf is 0.
glm::vec3 sample_brdf(const Brdf& brdf, const glm::vec3& wo, const glm::vec2& u, float lobe);

// wo moved up to the horizon of the shading frame where an interpolated or mapped normal turns away from the eye.
glm::vec3 clamp_view(glm::vec3 wo);

}  // namespace conebook
