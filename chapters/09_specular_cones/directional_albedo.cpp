#include "09_specular_cones/directional_albedo.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/material_constants.glsl"
#include "scene/radical_inverse.hpp"

namespace conebook {

namespace {

// Points spread evenly over the unit disc: a Hammersley set, by radius and angle.
std::vector<glm::dvec2> disc_points(int count)
{
    std::vector<glm::dvec2> points;
    for (int i = 0; i < count; ++i) {
        const double r = std::sqrt((i + 0.5) / count), phi = 2.0 * std::numbers::pi * radical_inverse(2, unsigned(i));
        points.emplace_back(r * std::cos(phi), r * std::sin(phi));
    }
    return points;
}

// A normal visible from v, with probability in proportion to its projected area (Heitz 2018, listing 1); `disc` is
// uniform on the unit disc.
glm::dvec3 visible_normal(glm::dvec3 v, double alpha, glm::dvec2 disc)
{
    const glm::dvec3 vh = glm::normalize(glm::dvec3(alpha * v.x, alpha * v.y, v.z));
    const double length2 = vh.x * vh.x + vh.y * vh.y;
    const glm::dvec3 t1 = length2 > 0.0 ? glm::dvec3(-vh.y, vh.x, 0.0) / std::sqrt(length2) : glm::dvec3(1, 0, 0);
    const glm::dvec3 t2 = glm::cross(vh, t1);
    const double s = 0.5 * (1.0 + vh.z), p1 = disc.x;
    const double p2 = (1.0 - s) * std::sqrt(1.0 - p1 * p1) + s * disc.y;
    const glm::dvec3 nh = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.0, 1.0 - p1 * p1 - p2 * p2)) * vh;
    return glm::normalize(glm::dvec3(alpha * nh.x, alpha * nh.y, std::max(0.0, nh.z)));
}

// Smith's Lambda for GGX (Heitz 2014, eq. 72).
double smith_lambda(double cos_theta, double alpha)
{
    const double cos2 = cos_theta * cos_theta;
    return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - cos2) / cos2) - 1.0);
}

// Mean over visible normals.
glm::dvec2 albedo_over(const std::vector<glm::dvec2>& disc, double n_dot_v, double alpha)
{
    const double cos_v = std::clamp(n_dot_v, 1e-4, 1.0), lambda_v = smith_lambda(cos_v, alpha);
    const glm::dvec3 v(std::sqrt(1.0 - cos_v * cos_v), 0.0, cos_v);
    glm::dvec2 sum(0.0);
    // snippet: split_sum
    for (const glm::dvec2& point : disc) {
        const glm::dvec3 h = visible_normal(v, alpha, point);
        const double v_dot_h = glm::dot(v, h);
        const glm::dvec3 l = 2.0 * v_dot_h * h - v;
        if (l.z <= 0.0) continue;
        // Visible normals leave G2 / G1 of the estimator (Heitz 2018, eq. 19).
        const double g = (1.0 + lambda_v) / (1.0 + lambda_v + smith_lambda(l.z, alpha));
        const double m = 1.0 - v_dot_h, grazing = m * m * m * m * m;  // Schlick 1994
        sum += g * glm::dvec2(1.0 - grazing, grazing);
    }
    // end snippet
    return sum / double(disc.size());
}

}  // namespace

glm::dvec2 directional_albedo(double n_dot_v, double alpha, int samples)
{
    return albedo_over(disc_points(samples), n_dot_v, alpha);
}

std::vector<glm::vec2> directional_albedo_table(int size, int samples)
{
    const std::vector<glm::dvec2> disc = disc_points(samples);
    std::vector<glm::vec2> table;
    for (int row = 0; row < size; ++row)
        for (int column = 0; column < size; ++column) {
            const double roughness = std::max(double(row) / (size - 1), double(kMinRoughness));
            table.push_back(glm::vec2(albedo_over(disc, double(column) / (size - 1), roughness * roughness)));
        }
    return table;
}

}  // namespace conebook
