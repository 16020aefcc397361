#include "reference/brdf.hpp"

#include <algorithm>
#include <cmath>

namespace conebook {
namespace {

float average(const glm::vec3& v) { return (v.x + v.y + v.z) / 3.0f; }

glm::vec3 schlick(const Brdf& brdf, float cosine)
{
    const float m = std::clamp(1.0f - cosine, 0.0f, 1.0f);
    return brdf.f0 + (brdf.f90 - brdf.f0) * (m * m * m * m * m);
}

// Smith masking of one direction (Heitz 2014 eq. 71-72): G1 = 2 / (1 + sqrt(1 + alpha^2 tan^2)).
float smith_g1(const glm::vec3& w, float alpha)
{
    const float sine2 = w.x * w.x + w.y * w.y;
    return 2.0f / (1.0f + std::sqrt(1.0f + alpha * alpha * sine2 / (w.z * w.z)));
}

// Share of the samples that goes to the specular lobe; only noise depends on it, never the mean.
float specular_share(const Brdf& brdf, const glm::vec3& wo)
{
    if (!brdf.has_specular()) return 0.0f;
    if (!brdf.has_diffuse()) return 1.0f;
    const float specular = average(schlick(brdf, wo.z)), diffuse = average(brdf.rho);
    return std::clamp(specular / (specular + diffuse), 0.1f, 0.9f);
}

}  // namespace

Frame::Frame(const glm::vec3& normal) : n(normal)
{
    const float sign = std::copysign(1.0f, n.z);
    const float a = -1.0f / (sign + n.z);
    const float c = n.x * n.y * a;
    t = {1.0f + sign * n.x * n.x * a, sign * c, -sign * n.x};
    b = {c, sign + n.y * n.y * a, -n.y};
}

Brdf Brdf::from_metallic_roughness(const glm::vec3& base_color, float metallic, float roughness, float specular,
                                   const glm::vec3& specular_color)
{
    Brdf brdf;
    brdf.rho = base_color * (1.0f - metallic);
    brdf.f0 = glm::mix(glm::min(kDielectricF0 * specular_color, glm::vec3(1.0f)) * specular, base_color, metallic);
    brdf.f90 = glm::vec3(glm::mix(specular, 1.0f, metallic));
    const float clamped = std::clamp(roughness, kMinRoughness, 1.0f);
    brdf.alpha = clamped * clamped;
    return brdf;
}

glm::vec3 clamp_view(glm::vec3 wo)
{
    if (wo.z >= kMinNdotV) return wo;
    wo.z = kMinNdotV;
    return glm::normalize(wo);
}

float ggx_distribution(const glm::vec3& h, float alpha)
{
    // n.h^2 (alpha^2 - 1) + 1 written as alpha^2 cos^2 + sin^2: no cancellation for narrow lobes in float.
    const float alpha2 = alpha * alpha;
    const float d = alpha2 * h.z * h.z + h.x * h.x + h.y * h.y;
    return alpha2 / (kPi * d * d);
}

BrdfValue evaluate_brdf(const Brdf& brdf, const glm::vec3& wo, const glm::vec3& wi)
{
    BrdfValue value;
    if (wi.z <= 0.0f) return value;
    value.diffuse = brdf.rho / kPi;
    if (!brdf.has_specular()) return value;
    const glm::vec3 h = glm::normalize(wo + wi);
    const float a2 = brdf.alpha * brdf.alpha;
    const float visibility =
        0.5f / (wi.z * std::sqrt(wo.z * wo.z * (1.0f - a2) + a2) + wo.z * std::sqrt(wi.z * wi.z * (1.0f - a2) + a2));
    value.specular = schlick(brdf, glm::dot(wo, h)) * (ggx_distribution(h, brdf.alpha) * visibility);
    return value;
}

float pdf_brdf(const Brdf& brdf, const glm::vec3& wo, const glm::vec3& wi)
{
    if (wi.z <= 0.0f) return 0.0f;
    const float share = specular_share(brdf, wo);
    float pdf = (1.0f - share) * wi.z / kPi;
    if (share > 0.0f) {
        // D_v(h) / (4 wo.h) with D_v = G1(wo) wo.h D(h) / wo.z (Heitz 2018, eq. 3 and 17).
        const glm::vec3 h = glm::normalize(wo + wi);
        pdf += share * smith_g1(wo, brdf.alpha) * ggx_distribution(h, brdf.alpha) / (4.0f * wo.z);
    }
    return pdf;
}

glm::vec3 sample_brdf(const Brdf& brdf, const glm::vec3& wo, const glm::vec2& u, float lobe)
{
    const float phi = 2.0f * kPi * u.y;
    const float r = std::sqrt(u.x);
    if (lobe >= specular_share(brdf, wo))  // cosine-weighted: a point of the unit disc, projected up (Malley)
        return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(0.0f, 1.0f - u.x))};

    // Visible normals (Heitz 2018, appendix A).
    const float alpha = brdf.alpha;
    const glm::vec3 v = glm::normalize(glm::vec3(alpha * wo.x, alpha * wo.y, wo.z));
    const float length2 = v.x * v.x + v.y * v.y;
    const glm::vec3 t1 = length2 > 0.0f ? glm::vec3(-v.y, v.x, 0.0f) / std::sqrt(length2) : glm::vec3(1, 0, 0);
    const glm::vec3 t2 = glm::cross(v, t1);
    const float p1 = r * std::cos(phi);
    const float s = 0.5f * (1.0f + v.z);
    const float p2 = (1.0f - s) * std::sqrt(std::max(0.0f, 1.0f - p1 * p1)) + s * r * std::sin(phi);
    const glm::vec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0f, 1.0f - p1 * p1 - p2 * p2)) * v;
    const glm::vec3 h = glm::normalize(glm::vec3(alpha * n.x, alpha * n.y, std::max(1e-7f, n.z)));
    return 2.0f * glm::dot(wo, h) * h - wo;
}

}  // namespace conebook
