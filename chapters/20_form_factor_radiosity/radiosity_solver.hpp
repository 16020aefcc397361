// The radiosity equation solved for irradiance, H = F^ (E + R H), for all three channels at once.
#pragma once

#include <vector>

#include "20_form_factor_radiosity/form_factors.hpp"

namespace conebook {

struct SolverParams {
    int bounces = -1;          // indirect bounces, 0 .. 64; -1: all
    float tolerance = 1e-4f;   // the residual at which all bounces end, as a share of the largest irradiance
    int sweeps = 500;          // and the most sweeps, 1 .. 100000
    bool gauss_seidel = true;  // for all bounces; off: Jacobi
    bool operator==(const SolverParams&) const = default;
};
void add_parameters(ParameterTable& table, SolverParams& params);

// Of all patches, W/m^2.
using Irradiance = std::vector<glm::vec3>;

struct Solution {
    // By bounces: H of 0, 1, .. `bounces` of them. All bounces: one entry.
    std::vector<Irradiance> after;
    const Irradiance& irradiance() const { return after.back(); }
    // What a path that has been over `mirrors` mirrors finds when it ends: it has so many bounces less. Null: no
    // more light.
    const Irradiance* before(int mirrors) const;
    int sweeps = 0;
    double residual = 0.0;     // largest |F^ (E + R H) - H|, W/m^2
    double norm = 0.0;         // q, largest row sum of F^ R
    double error_bound = 0.0;  // residual / (1 - q), W/m^2: no irradiance is further from the solution of the equation
    std::size_t dimmed = 0;    // patches whose reflectance was lowered, see solve_radiosity
    std::vector<double> residuals;  // after each sweep, as a share of the largest irradiance
};

// rho of patches that reflect all light, or that and more with their mirror, is lowered until kMostReflected is
// reflected, if all bounces are wanted: they have no other limit. Counted in `dimmed`.
constexpr float kMostReflected = 0.99f;

// With as unknown the radiosity B, rows of the matrix can add up to more than 1 where there are mirrors; those of
// F^ R cannot: sum_j F^_ij (1 - rho_s,j) <= 1, so they are at most the largest rho_d / (1 - rho_s). Throws
// std::runtime_error when all bounces are wanted and q >= 1.
Solution solve_radiosity(const Patches& patches, const FormFactors& factors, const SolverParams& params);

// B = emitted + lit + rho H, W/m^2.
Irradiance radiosity_of(const Patches& patches, const Irradiance& irradiance);

}  // namespace conebook
