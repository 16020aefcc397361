#include "08_diffuse_cones/cone_sets.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "scene/radical_inverse.hpp"

namespace conebook {

namespace {

constexpr double kPi = std::numbers::pi;

struct Ring {
    int cones;
    double weight;  // of each of them
};

// Rings from the pole outwards. For 6 the weights of Villegas 2016, section 3.6.1 (pi/4 and 3 pi/20, over pi);
// otherwise equal ones, the ring sizes chosen so that the cells are about as high as they are wide.
std::vector<Ring> rings_of(int count)
{
    switch (count) {
    case 1: return {{1, 1.0}};
    case 5: return {{1, 0.2}, {4, 0.2}};
    case 6: return {{1, 0.25}, {5, 0.15}};
    case 9: return {{2, 1.0 / 9}, {7, 1.0 / 9}};
    case 16: return {{1, 1.0 / 16}, {5, 1.0 / 16}, {10, 1.0 / 16}};
    case 32: return {{1, 1.0 / 32}, {6, 1.0 / 32}, {11, 1.0 / 32}, {14, 1.0 / 32}};
    default: throw std::invalid_argument("no cone set of " + std::to_string(count) + " cones");
    }
}

double first_moment_of(double cos_tilt, double half_angle_rad) { return cos_tilt * (1.0 + std::cos(half_angle_rad)) / 2; }

// normal + x * right + y * up (Villegas 2016, listing 21): the height of the direction itself is dropped.
glm::vec4 added_to_normal(const glm::vec4& cone) { return {glm::normalize(glm::vec3(cone.x, cone.y, 1.0f)), cone.w}; }

// Of each of `count` cones. With an aperture of 0 they fill the hemisphere: a cone's solid angle 2 pi (1 - cos a) is its
// share of 2 pi; six are the usual 60 degrees, and one alone, which would be the whole hemisphere, is held to 120.
double half_angle(int count, double aperture_rad)
{
    if (aperture_rad > 0.0) return 0.5 * aperture_rad;
    return count == 6 ? kPi / 6 : std::min(std::acos(1.0 - 1.0 / count), kPi / 3);
}

}  // namespace

double first_moment(const ConeSet& set)
{
    double sum = 0.0;
    for (const glm::vec4& cone : set.cones) sum += double(cone.w) * first_moment_of(cone.z, set.half_angle_rad);
    return sum;
}

ConeSet make_cone_set(int count, ConeTable table, double aperture_rad)
{
    const double half = half_angle(count, aperture_rad);
    const std::vector<Ring> rings = rings_of(count);
    std::vector<double> cos_tilts;
    double inner_sin2 = 0.0;  // sin^2 at the ring's inner edge = weight within it
    for (const Ring& ring : rings) {
        const double outer_sin2 = std::min(inner_sin2 + ring.cones * ring.weight, 1.0);
        const double c0 = std::sqrt(1.0 - inner_sin2), c1 = std::sqrt(1.0 - outer_sin2);
        // Cosine-weighted mean of cos over the ring: integral of 2 c^2 dc over that of 2 c dc.
        const double mean_cos = 2.0 / 3.0 * (c0 * c0 * c0 - c1 * c1 * c1) / (c0 * c0 - c1 * c1);
        const bool pole = inner_sin2 == 0.0 && ring.cones == 1;
        const double tilt_of_thesis = count == 6 ? (pole ? 1.0 : 0.5) : (pole ? 1.0 : mean_cos);
        cos_tilts.push_back(table != ConeTable::tilted || pole ? tilt_of_thesis : mean_cos);
        inner_sin2 = outer_sin2;
    }
    if (table == ConeTable::tilted) {
        // The pole's cone cannot be tilted; scale the others' cosines so that the whole set has the moment 2/3.
        double pole_moment = 0.0, others_moment = 0.0;
        for (std::size_t i = 0; i < rings.size(); ++i) {
            const double moment = rings[i].cones * rings[i].weight * first_moment_of(cos_tilts[i], half);
            (cos_tilts[i] == 1.0 ? pole_moment : others_moment) += moment;
        }
        for (double& c : cos_tilts)
            if (c != 1.0) c = std::min(c * (2.0 / 3.0 - pole_moment) / others_moment, 0.999);
    }

    ConeSet set;
    set.half_angle_rad = float(half);
    for (std::size_t i = 0; i < rings.size(); ++i)
        for (int k = 0; k < rings[i].cones; ++k) {
            // Golden angle between rings: no two rings line up.
            const double phi = 2.0 * kPi * k / rings[i].cones + 2.399963 * double(i);
            const double sin_tilt = std::sqrt(std::max(0.0, 1.0 - cos_tilts[i] * cos_tilts[i]));
            set.cones.emplace_back(sin_tilt * std::cos(phi), sin_tilt * std::sin(phi), cos_tilts[i], rings[i].weight);
        }
    if (table == ConeTable::thesis_added)
        for (glm::vec4& cone : set.cones) cone = added_to_normal(cone);
    return set;
}

ConeSet make_interleaved_cones(int count, ConeTable table, double aperture_rad, int sets)
{
    if (sets == 1) return make_cone_set(count, table, aperture_rad);
    const double half = half_angle(count, aperture_rad);
    const std::vector<Ring> rings = rings_of(count);
    ConeSet all;
    all.half_angle_rad = float(half);
    for (int set = 0; set < sets; ++set) {
        // A point of the unit square for this set (Hammersley): where in their cells its cones lie.
        const double u = (set + 0.5) / sets, v = radical_inverse(2, unsigned(set)) + 0.5 / sets;
        double inner_sin2 = 0.0;
        for (const Ring& ring : rings) {
            for (int k = 0; k < ring.cones; ++k) {
                // sin^2 is uniform for directions in proportion to their cosine (Malley's method, pbrt 4ed, A.5.3).
                const double sin2 = inner_sin2 + ring.cones * ring.weight * u;
                const double phi = 2.0 * kPi * (k + v) / ring.cones;
                const double cos_tilt = std::sqrt(std::max(0.0, 1.0 - sin2)), sin_tilt = std::sqrt(sin2);
                all.cones.emplace_back(sin_tilt * std::cos(phi), sin_tilt * std::sin(phi), cos_tilt, ring.weight);
            }
            inner_sin2 += ring.cones * ring.weight;
        }
    }
    if (table == ConeTable::thesis_added)
        for (glm::vec4& cone : all.cones) cone = added_to_normal(cone);
    if (table != ConeTable::tilted) return all;
    // Raise the cones a little, for wide ones see more of the horizon than their axis: cos -> cos^e keeps the pole and
    // the horizon where they are; e by bisection so that the moment becomes 2/3, or as near to it as wide cones allow.
    double low = 0.0, high = 1.0;
    const auto moment_with = [&](double e) {
        double sum = 0.0;
        for (const glm::vec4& cone : all.cones) sum += cone.w * first_moment_of(std::pow(cone.z, e), half) / sets;
        return sum;
    };
    for (int i = 0; i < 40; ++i) (moment_with(0.5 * (low + high)) > 2.0 / 3.0 ? low : high) = 0.5 * (low + high);
    for (glm::vec4& cone : all.cones) {
        const float z = float(std::pow(cone.z, low));
        const float planar = std::sqrt((1.0f - z * z) / std::max(1.0f - cone.z * cone.z, 1e-8f));
        cone = glm::vec4(cone.x * planar, cone.y * planar, z, cone.w);
    }
    return all;
}

}  // namespace conebook
