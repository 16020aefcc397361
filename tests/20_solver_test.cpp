// The solution against elimination in double precision and what is known of closed rooms; light between patches.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "20_form_factor_radiosity/lamps.hpp"
#include "patch_rig.hpp"

namespace conebook {
namespace {

// Radiosity of a closed room of one reflectance that emits everywhere: after k sweeps E (1 + rho + ... + rho^k).
TEST(Solver, FurnaceIsExactAtEverySweep)
{
    Rig rig(cube([](int) { return emitter(glm::vec3(1.0f), 0.5f); }).build(), even(300));
    for (const FormFactorMethod method : {FormFactorMethod::embree, FormFactorMethod::hemicube}) {
        FormFactorParams wanted = by(method);
        wanted.samples = 1;
        const Solution solution = solve_radiosity(rig.patches, rig.factors(wanted), {.bounces = 6});
        double expected = 0.0;
        for (int k = 0; k <= 6; ++k) {
            for (const glm::vec3& h : solution.after[std::size_t(k)])
                ASSERT_NEAR(double(h.x), std::numbers::pi * expected, 1e-4 * std::numbers::pi) << k << int(method);
            expected = 1.0 + 0.5 * expected;
        }
    }
}

// Two plates so large that they see nothing but each other.
TEST(Solver, ParallelPlates)
{
    SceneBuilder b;
    b.triangle({0, 0, 0}, {1, 0, 0}, {0, 0, -1}, b.material(emitter(glm::vec3(1.0f), 0.4f)));
    b.triangle({0, 1, 0}, {0, 1, -1}, {1, 1, 0}, b.material(emitter(glm::vec3(3.0f), 0.7f)));
    Rig rig(b.build(), even(1));
    ASSERT_EQ(rig.patches.size(), 2u);
    FormFactors factors;
    factors.rows.resize(2);
    factors.rows[0].direct = {{1, 1.0f}};
    factors.rows[1].direct = {{0, 1.0f}};
    for (const bool gauss_seidel : {true, false}) {
        SolverParams params;
        params.gauss_seidel = gauss_seidel;
        params.tolerance = 1e-6f;
        const Solution solution = solve_radiosity(rig.patches, factors, params);
        const Irradiance radiosity = radiosity_of(rig.patches, solution.irradiance());
        const double pi = std::numbers::pi, first = pi * (1.0 + 0.4 * 3.0) / (1.0 - 0.4 * 0.7);
        EXPECT_NEAR(double(radiosity[0].x), first, 1e-5 * first);
        EXPECT_NEAR(solution.norm, 0.7, 1e-6);
        EXPECT_LE(std::abs(double(radiosity[0].x) - first) / 0.4, solution.error_bound + 1e-5);
    }
}

// x of A x = b by elimination with pivots.
std::vector<double> eliminated(std::vector<std::vector<double>> a, std::vector<double> b)
{
    const std::size_t n = b.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        for (std::size_t i = k + 1; i < n; ++i)
            if (std::abs(a[i][k]) > std::abs(a[pivot][k])) pivot = i;
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = k + 1; i < n; ++i) {
            const double f = a[i][k] / a[k][k];
            if (f == 0.0) continue;
            for (std::size_t j = k; j < n; ++j) a[i][j] -= f * a[k][j];
            b[i] -= f * b[k];
        }
    }
    for (std::size_t k = n; k-- > 0;) {
        for (std::size_t j = k + 1; j < n; ++j) b[k] -= a[k][j] * b[j];
        b[k] /= a[k][k];
    }
    return b;
}

TEST(Solver, FindsWhatEliminationFinds)
{
    PatchParams patch_params = even(150);
    patch_params.fresnel = false;
    Rig rig(room_with_mirror().build(), patch_params);
    const FormFactors factors = rig.factors(by(FormFactorMethod::embree));
    const std::size_t n = rig.patches.size();
    std::vector<std::vector<double>> matrix(n, std::vector<double>(n, 0.0));
    std::vector<double> right(n, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
        matrix[i][i] = 1.0;
        const auto enter = [&](std::uint32_t j, double share) {
            matrix[i][j] -= share * double(rig.patches[j].rho.x);
            right[i] += share * double(rig.patches[j].emitted.x);
        };
        for (const FormFactorEntry& f : factors.rows[i].direct) enter(f.patch, double(f.share));
        for (const MirroredFormFactor& f : factors.rows[i].mirrored) enter(f.patch, double(f.share.x));
    }
    const std::vector<double> exact = eliminated(matrix, right);
    int sweeps[2] = {0, 0};
    for (const bool gauss_seidel : {false, true}) {
        SolverParams params;
        params.gauss_seidel = gauss_seidel;
        params.tolerance = 1e-6f;
        const Solution solution = solve_radiosity(rig.patches, factors, params);
        sweeps[gauss_seidel ? 1 : 0] = solution.sweeps;
        EXPECT_LT(solution.norm, 1.0);
        for (std::size_t i = 0; i < n; ++i) {
            const double error = std::abs(double(solution.irradiance()[i].x) - exact[i]);
            ASSERT_LE(error, solution.error_bound + 1e-6 * exact[i]) << gauss_seidel;
            ASSERT_LE(error, 1e-4 * exact[i]) << gauss_seidel;
        }
    }

    EXPECT_LT(sweeps[1], sweeps[0]);
}

// In a closed room all that is emitted is absorbed in the end: by walls that are no mirrors, 1 - rho of what they
// get; a mirror keeps 1 - rho_s. That holds as far as reciprocity does, which rays know to their noise.
TEST(Solver, WhatIsEmittedIsAbsorbed)
{
    PatchParams patch_params = even(800);
    patch_params.fresnel = false;
    Rig rig(room_with_mirror().build(), patch_params);
    const FormFactors factors = rig.factors(by(FormFactorMethod::embree));
    SolverParams params;
    params.tolerance = 1e-6f;
    const Solution solution = solve_radiosity(rig.patches, factors, params);
    double emitted = 0.0, absorbed = 0.0;
    for (std::size_t i = 0; i < rig.patches.size(); ++i) {
        const Patch& p = rig.patches[i];
        emitted += double(p.area) * double(p.emitted.x);
        absorbed += double(p.area) * double(solution.irradiance()[i].x) * (1.0 - double(p.rho.x) - double(p.f0.x));
    }
    EXPECT_NEAR(absorbed, emitted, 0.01 * emitted);
}

TEST(Solver, RefusesWhatHasNoEnd)
{
    Rig rig(cube([](int) { return emitter(glm::vec3(1.0f), 0.8f); }).build(), even(48));
    FormFactorParams params = by(FormFactorMethod::hemicube);
    params.texel_weights = int(TexelWeights::draft);  // rows of 1.547
    const FormFactors factors = rig.factors(params);
    EXPECT_THROW(solve_radiosity(rig.patches, factors, {}), std::runtime_error);
    EXPECT_NO_THROW(solve_radiosity(rig.patches, factors, {.bounces = 4}));
    // Walls that reflect all light are taken for 0.99, and counted.
    Rig white(cube([](int) { return emitter(glm::vec3(1.0f), 1.0f); }).build(), even(48));
    const Solution solution =
        solve_radiosity(white.patches, white.factors(by(FormFactorMethod::embree)), {.sweeps = 2000});
    EXPECT_EQ(solution.dimmed, white.patches.size());
    EXPECT_NEAR(double(solution.irradiance()[0].x), 100.0 * std::numbers::pi, 0.05 * 100.0 * std::numbers::pi);
}

// A lamp on one side of a wall that stands on the floor, whose edge the floor's patches share: on the other side it
// is dark to the foot of the wall, on this side it is not darker there. And a box on the floor darkens no patch
// around it.
TEST(Reconstruction, LightEndsAtTheFootOfAWall)
{
    SceneBuilder b;
    const int black = b.material(lambert(0.0f)), lamp = b.material(emitter(glm::vec3(5.0f)));
    b.quad({-1, 0, 1}, {1, 0, 0}, {0, 0, -2}, black);
    b.quad({0, 0, 1}, {1, 0, 0}, {0, 0, -2}, black);
    b.quad({0, 0, 1}, {0, 0, -2}, {0, 2, 0}, black);
    b.quad({0, 0, 1}, {0, 2, 0}, {0, 0, -2}, black);
    b.quad({-0.6f, 1.5f, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, lamp);
    for (const bool aim : {true, false}) {
        Rig rig(b.build(), even(600));
        FormFactorParams wanted = by(FormFactorMethod::embree);
        wanted.aim_at_lamps = aim;
        const Solution solution = solve_radiosity(rig.patches, rig.factors(wanted), {.bounces = 1});
        const Surfaces surfaces(rig.patches, {});
        const Irradiance none(rig.patches.size(), glm::vec3(0.0f));
        const CornerValues corners = surfaces.corners(solution.irradiance(), none, Lamps());
        int dark = 0;
        for (std::size_t i = 0; i < rig.patches.size(); ++i) {
            if (rig.patches[i].draw != 1) continue;
            for (const glm::vec3& value : corners[i]) ASSERT_EQ(value.x, 0.0f);
            ++dark;
        }
        EXPECT_GT(dark, 50);
    }
}

TEST(Patches, AreLeftOutUnderABox)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, grey);
    b.box({-0.5f, 0, -0.5f}, {0.5f, 1, 0.5f}, grey);
    Rig rig(b.build(), even(2000));
    double exposed = 0.0;
    for (const Patch& p : rig.patches.all())
        if (p.draw == 0) exposed += double(p.area);
    EXPECT_NEAR(exposed, 3.0, 0.02);  // 2 x 2 m less 1 x 1
}

// What does not change on corners: a linear field is met exactly, at borders too.
TEST(Reconstruction, KeepsALinearField)
{
    SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(lambert(0.5f)));
    Rig rig(b.build(), even(400));
    const auto field = [](const glm::vec3& p) { return glm::vec3(3.0f + p.x, 2.0f + 0.5f * p.z, 4.0f - p.x + p.z); };
    Irradiance values;
    for (const Patch& p : rig.patches.all()) values.push_back(field(p.center));
    const CornerValues corners =
        Surfaces(rig.patches, {}).corners(values, Irradiance(values.size(), glm::vec3(0.0f)), Lamps());
    for (std::size_t i = 0; i < rig.patches.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const PatchNode& node = rig.patches.mesh().nodes()[rig.patches[i].node];
            const glm::vec3 d = corners[i][k] - field(rig.patches.mesh().points()[node.corners[k]]);
            // The weight on small slopes leaves 0.0125 of the 0.05 by which a mean of patches lags at a border.
            ASSERT_LT(std::max({std::abs(d.x), std::abs(d.y), std::abs(d.z)}), 0.02f);
        }
}

}  // namespace
}  // namespace conebook
