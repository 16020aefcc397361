#include "20_form_factor_radiosity/radiosity_solver.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace conebook {
namespace {

double largest(const glm::vec3& v) { return double(std::max(v.x, std::max(v.y, v.z))); }

// What all patches send out if their irradiance is H.
glm::dvec3 sent(const Patch& patch, const glm::vec3& rho, const glm::vec3& irradiance)
{
    return glm::dvec3(patch.emitted + patch.lit) + glm::dvec3(rho) * glm::dvec3(irradiance);
}

// Row i of F^ times what is sent; sums in the row's order, so the same bits in every run.
template <typename Sent>
glm::dvec3 gathered(const FormFactorRow& row, Sent sent)
{
    glm::dvec3 sum(0.0);
    for (const FormFactorEntry& f : row.direct) sum += double(f.share) * sent(f.patch, 0u);
    for (const MirroredFormFactor& f : row.mirrored) sum += glm::dvec3(f.share) * sent(f.patch, f.reflections);
    return sum;
}

}  // namespace

void add_parameters(ParameterTable& table, SolverParams& params)
{
    table.add("bounces", params.bounces, -1, 64, "bounces", "indirect bounces; -1: all");
    table.add("tolerance", params.tolerance, 1e-7, 0.1, "",
              "largest residual over largest irradiance that ends all bounces");
    table.add("sweeps", params.sweeps, 1, 100000, "sweeps", "at most, for all bounces");
    table.add("gauss_seidel", params.gauss_seidel, "each patch uses what was found in the same sweep; off: Jacobi");
}

const Irradiance* Solution::before(int mirrors) const
{
    if (after.size() == 1) return &after.back();
    const int index = int(after.size()) - 2 - mirrors;
    return index >= 0 ? &after[std::size_t(index)] : nullptr;
}

Solution solve_radiosity(const Patches& patches, const FormFactors& factors, const SolverParams& params)
{
    const std::size_t count = patches.size();
    Solution solution;
    std::vector<glm::vec3> rho(count);
    for (std::size_t i = 0; i < count; ++i) rho[i] = patches[i].rho;

    // snippet: jacobi
    if (params.bounces >= 0) {
        // Each sweep is a bounce. A path over r mirrors has used up r of them before it arrives.
        solution.after.assign(1, Irradiance(count, glm::vec3(0.0f)));
        for (int bounce = 1; bounce <= params.bounces; ++bounce) {
            Irradiance next(count);
            for_all(count, [&](std::size_t i) {
                next[i] = glm::vec3(gathered(factors.rows[i], [&](std::uint32_t j, std::uint32_t mirrors) {
                    const int before = bounce - 1 - int(mirrors);
                    return before < 0 ? glm::dvec3(0.0)
                                      : sent(patches[j], rho[j], solution.after[std::size_t(before)][j]);
                }));
            });
            solution.after.push_back(std::move(next));
        }
        solution.sweeps = params.bounces;
        return solution;
    }
    // end snippet

    for (std::size_t i = 0; i < count; ++i) {
        const double mirror = largest(patches[i].f0), all = largest(rho[i]) + mirror;
        if (all < 1.0) continue;
        rho[i] *= float(std::max(0.0, double(kMostReflected) - mirror) / std::max(largest(rho[i]), 1e-6));
        ++solution.dimmed;
    }
    for (std::size_t i = 0; i < count; ++i)
        solution.norm = std::max(solution.norm, [&] {
            const glm::dvec3 sum =
                gathered(factors.rows[i], [&](std::uint32_t j, std::uint32_t) { return glm::dvec3(rho[j]); });
            return std::max(sum.x, std::max(sum.y, sum.z));
        }());
    if (solution.norm >= 1.0)
        throw std::runtime_error("bounces=-1: the surfaces reflect all that they get (row sum " +
                                 std::to_string(solution.norm) + "), so there is no end; choose a number of bounces");

    solution.after.assign(1, Irradiance(count, glm::vec3(0.0f)));
    Irradiance& h = solution.after[0];
    const auto residual_of = [&](Irradiance* next) {
        double most = 0.0;
        std::vector<double> each(count);
        for_all(count, [&](std::size_t i) {
            const glm::dvec3 g = gathered(
                factors.rows[i], [&](std::uint32_t j, std::uint32_t) { return sent(patches[j], rho[j], h[j]); });
            const glm::dvec3 d = glm::abs(g - glm::dvec3(h[i]));
            each[i] = std::max(d.x, std::max(d.y, d.z));
            if (next != nullptr) (*next)[i] = glm::vec3(g);
        });
        for (const double e : each) most = std::max(most, e);
        return most;
    };
    const auto peak = [&] {
        double most = 0.0;
        for (const glm::vec3& v : h) most = std::max(most, largest(v));
        return most;
    };
    for (bool done = false; !done && solution.sweeps < params.sweeps;) {
        if (params.gauss_seidel) {
            // snippet: gauss_seidel
            for (std::size_t i = 0; i < count; ++i) {
                // A patch may see itself in a mirror; that part of its row goes to the other side.
                glm::dvec3 own(0.0);
                const glm::dvec3 sum = gathered(factors.rows[i], [&](std::uint32_t j, std::uint32_t) {
                    return j == i ? sent(patches[j], rho[j], glm::vec3(0.0f)) : sent(patches[j], rho[j], h[j]);
                });
                for (const MirroredFormFactor& f : factors.rows[i].mirrored)
                    if (f.patch == i) own += glm::dvec3(f.share) * glm::dvec3(rho[i]);
                h[i] = glm::vec3(sum / (1.0 - own));
            }
            // end snippet
            solution.residual = residual_of(nullptr);
        } else {
            Irradiance next(count);
            residual_of(&next);
            h = std::move(next);
            solution.residual = residual_of(nullptr);
        }
        ++solution.sweeps;
        const double most = peak();
        solution.residuals.push_back(most > 0.0 ? solution.residual / most : 0.0);
        done = solution.residuals.back() <= double(params.tolerance);
    }
    solution.error_bound = solution.residual / (1.0 - solution.norm);
    return solution;
}

Irradiance radiosity_of(const Patches& patches, const Irradiance& irradiance)
{
    Irradiance radiosity(patches.size());
    for (std::size_t i = 0; i < patches.size(); ++i)
        radiosity[i] = glm::vec3(sent(patches[i], patches[i].rho, irradiance[i]));
    return radiosity;
}

}  // namespace conebook
