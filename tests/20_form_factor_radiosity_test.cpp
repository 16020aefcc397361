// Form factors against closed forms, the solution against elimination in double precision and against what is known of
// closed rooms, mirrors against their mirror image.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "20_form_factor_radiosity/lamps.hpp"
#include "20_form_factor_radiosity/radiosity.hpp"
#include "scene_builder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

// A scene, its patches, and rows by any method.
struct Rig {
    Scene scene;
    SceneTracer tracer;
    Patches patches;
    Hemicubes hemicubes;

    Rig(Scene source, const PatchParams& params)
        : scene(std::move(source)),
          tracer(scene),
          patches(make_patches(tracer, params, scene.lights)),
          hemicubes(test_gl().shaders, scene)
    {
        patches.light(scene.lights);
    }

    FormFactors factors(FormFactorParams params)
    {
        return params.form_factors == int(FormFactorMethod::embree) ? trace_form_factors(patches, params)
                                                                    : render_form_factors(hemicubes, patches, params);
    }

    // Mean over the patches of draw a of their form factors to draw b, weighted by area.
    double between(const FormFactors& factors, std::uint32_t a, std::uint32_t b) const
    {
        double sum = 0.0, area = 0.0;
        for (std::size_t i = 0; i < patches.size(); ++i) {
            if (patches[i].draw != a) continue;
            area += double(patches[i].area);
            for (const FormFactor& f : factors.rows[i].direct)
                if (patches[f.patch].draw == b) sum += double(patches[i].area) * double(f.share);
        }
        return sum / area;
    }
};

PatchParams even(int patches)
{
    PatchParams params;
    params.patches = patches;
    params.adaptive = false;
    return params;
}

FormFactorParams by(FormFactorMethod method)
{
    FormFactorParams params;
    params.form_factors = int(method);
    params.samples = 4;
    params.rays = 1024;
    return params;
}

constexpr FormFactorMethod kMethods[] = {FormFactorMethod::hemicube, FormFactorMethod::embree,
                                         FormFactorMethod::hybrid};

// Unit cube seen from inside, a draw a face: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z.
SceneBuilder cube(const std::function<Material(int)>& material_of)
{
    SceneBuilder b;
    for (int face = 0; face < 6; ++face) b.box_face({0, 0, 0}, {1, 1, 1}, face, b.material(material_of(face)), true);
    return b;
}
SceneBuilder grey_cube()
{
    return cube([](int) { return lambert(0.5f); });
}

double row_sum(const FormFactorRow& row)
{
    double sum = 0.0;
    for (const FormFactor& f : row.direct) sum += double(f.share);
    return sum;
}

TEST(PatchMesh, HasNoCornerInsideAnEdgeAndCoversTheScene)
{
    SceneBuilder b = grey_cube();
    b.triangle({0.1f, 0.2f, 0.3f}, {0.9f, 0.25f, 0.3f}, {0.5f, 0.22f, 0.7f}, 0);
    const Scene scene = b.build();
    PatchMesh mesh(scene);
    double before = 0.0, after = 0.0;
    for (const std::uint32_t leaf : mesh.leaves()) before += mesh.area(leaf);
    // Much finer near one corner of the cube.
    mesh.refine(2000, 0.0, [&](std::uint32_t n) {
        const glm::vec3 p = mesh.points()[mesh.nodes()[n].corners[0]];
        return mesh.area(n) / (0.001 + double(glm::dot(p, p)));
    });
    std::vector<bool> is_corner(mesh.points().size(), false);
    for (const std::uint32_t leaf : mesh.leaves()) {
        after += mesh.area(leaf);
        for (const std::uint32_t c : mesh.nodes()[leaf].corners) is_corner[c] = true;
    }
    EXPECT_NEAR(after, before, 1e-6 * before);
    EXPECT_GE(mesh.leaf_count(), 2000u);
    for (const std::uint32_t leaf : mesh.leaves())
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& c = mesh.nodes()[leaf].corners;
            const glm::vec3 middle =
                glm::vec3(0.5 * (glm::dvec3(mesh.points()[c[k]]) + glm::dvec3(mesh.points()[c[(k + 1) % 3]])));
            for (std::size_t p = 0; p < mesh.points().size(); ++p)
                ASSERT_FALSE(is_corner[p] && mesh.points()[p] == middle) << "leaf " << leaf;
        }
    // The place of a point gives the point back.
    for (int i = 0; i < 1000; ++i) {
        const glm::vec3 w = triangle_weights(sequence_02(std::uint32_t(i), 0, 0));
        const auto t = std::uint32_t(i) % std::uint32_t(scene.triangle_count());
        const auto at = [&](const std::array<std::uint32_t, 3>& c, const glm::vec3& weights) {
            return weights.x * mesh.points()[c[0]] + weights.y * mesh.points()[c[1]] + weights.z * mesh.points()[c[2]];
        };
        const PatchPlace place = mesh.find(t, {w.y, w.z});
        const glm::vec3 wanted = at(mesh.nodes()[t].corners, w),
                        found = at(mesh.nodes()[place.node].corners, place.weights);
        ASSERT_LT(glm::length(wanted - found), 2e-6f);
        ASSERT_GE(std::min({place.weights.x, place.weights.y, place.weights.z}), -1e-5f);
    }
}

// Cohen & Greenberg's top and sides in closed form; the densities' integrals over them.
TEST(Hemicube, WeightsAddUpToOneAtEveryResolution)
{
    for (const int resolution : {8, 32, 64, 128}) {
        const HemicubeLayout layout{resolution};
        const std::vector<float> weights = hemicube_weights(resolution, TexelWeights::exact);
        double top = 0.0, all = 0.0;
        for (int t = 0; t < layout.texels(); ++t) {
            all += double(weights[std::size_t(t)]);
            if (t % layout.size().x < resolution) top += double(weights[std::size_t(t)]);
        }
        EXPECT_NEAR(all, 1.0, 1e-6) << resolution;
        EXPECT_NEAR(top, 0.554126, 1e-6) << resolution;
        EXPECT_NEAR((all - top) / 4.0, 0.111468, 1e-6) << resolution;
    }
    const auto sum = [](int resolution, TexelWeights kind) {
        double all = 0.0;
        for (const float w : hemicube_weights(resolution, kind)) all += double(w);
        return all;
    };
    // At its middle the integrand is not its mean; at 8 texels that is seen. With exponent 1 it is another integral.
    EXPECT_GT(std::abs(sum(8, TexelWeights::density) - 1.0), 1e-3);
    EXPECT_NEAR(sum(512, TexelWeights::density), 1.0, 1e-4);
    EXPECT_NEAR(sum(512, TexelWeights::draft), 1.547, 1e-3);
}

// Opposite faces 0.199825, adjacent ones 0.200044 (Howell's catalogue, C-11 and C-14).
TEST(FormFactors, OfTheClosedCube)
{
    Rig rig(grey_cube().build(), even(768));
    // Without mirrors hybrid is hemicube.
    for (const FormFactorMethod method : {FormFactorMethod::hemicube, FormFactorMethod::embree}) {
        const FormFactors factors = rig.factors(by(method));
        EXPECT_NEAR(rig.between(factors, 0, 1), 0.199825, 0.01 * 0.199825) << int(method);
        EXPECT_NEAR(rig.between(factors, 0, 2), 0.200044, 0.01 * 0.200044) << int(method);
        for (std::uint32_t a = 0; a < 6; ++a)  // all areas are 1
            for (std::uint32_t b = 0; b < a; ++b)
                EXPECT_NEAR(rig.between(factors, a, b), rig.between(factors, b, a), 0.01 * 0.2) << int(method);
        for (const FormFactorRow& row : factors.rows) ASSERT_NEAR(row_sum(row), 1.0, 0.005) << int(method);
    }
}

// The failure that samples all over the patch avoid: from the centre alone the opposite face looks 20 % too large.
TEST(FormFactors, FromTheCentreOfAFaceAloneAreTooLarge)
{
    Rig rig(grey_cube().build(), even(12));
    const auto centre = [&](int resolution) {
        SurfaceHit point;
        point.position = {0.0f, 0.5f, 0.5f};
        point.geometric_normal = {1, 0, 0};
        std::uint32_t patch = 0;
        while (rig.patches[patch].draw != 0) ++patch;
        const FormFactorRow row = hemicube_row(rig.hemicubes, rig.patches, hemicube_view(rig.patches, patch, point),
                                               resolution, TexelWeights::exact);
        double sum = 0.0;
        for (const FormFactor& f : row.direct)
            if (rig.patches[f.patch].draw == 1) sum += double(f.share);
        return sum;
    };
    // Four quarters, each seen from below its corner (Howell, C-11's element).
    const double a = 0.5 / std::sqrt(1.25);
    const double exact = 4.0 * 2.0 * a * std::atan(a) / (2.0 * std::numbers::pi);
    EXPECT_NEAR(exact, 0.2395, 1e-4);
    EXPECT_NEAR(centre(256), exact, 0.005 * exact);
    EXPECT_GT(centre(256) / 0.199825, 1.19);
}

// F21 = (r1 / r2)^2, F22 = 1 - F21 for a sphere r1 in a sphere r2 (Howell, C-140). Both are polyhedra here, with the
// areas of 12 rings, so the ratio of their areas stands for that of the radii.
TEST(FormFactors, OfConcentricSpheres)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.sphere({0, 0, 0}, 0.5f, grey, 12, false, true);
    b.sphere({0, 0, 0}, 1.0f, grey, 12, true, true);
    Rig rig(b.build(), even(1));
    FormFactorParams params = by(FormFactorMethod::embree);
    params.rays = 128;
    for (const FormFactorMethod method : {FormFactorMethod::embree, FormFactorMethod::hemicube}) {
        params.form_factors = int(method);
        params.samples = 1;
        params.resolution = 32;
        const FormFactors factors = rig.factors(params);
        EXPECT_NEAR(rig.between(factors, 0, 1), 1.0, 0.01) << int(method);
        EXPECT_NEAR(rig.between(factors, 1, 0), 0.25, 0.01 * 0.25) << int(method);
        EXPECT_NEAR(rig.between(factors, 1, 1), 0.75, 0.01 * 0.75) << int(method);
    }
}

// Root mean square over the 30 pairs of faces of the cube, as a share of their form factor.
double error_of_faces(const Rig& rig, const FormFactors& factors)
{
    double squared = 0.0;
    for (std::uint32_t a = 0; a < 6; ++a)
        for (std::uint32_t c = 0; c < 6; ++c) {
            const double exact = a / 2 == c / 2 ? 0.199825 : 0.200044;
            if (a != c) squared += std::pow(rig.between(factors, a, c) / exact - 1.0, 2.0);
        }
    return std::sqrt(squared / 30.0);
}

// The error falls with the number of rays, at least as fast as that of independent ones, 1 / sqrt(n).
TEST(FormFactors, ErrorFallsWithTheRays)
{
    Rig rig(grey_cube().build(), even(48));
    std::vector<double> logs;
    for (const int rays : {64, 256, 1024, 4096, 16384}) {
        FormFactorParams params = by(FormFactorMethod::embree);
        params.rays = rays;
        const double error = error_of_faces(rig, rig.factors(params));
        RecordProperty("error_percent_" + std::to_string(rays), std::to_string(100.0 * error));
        logs.push_back(std::log2(error));
    }
    const double slope = (logs.back() - logs.front()) / 8.0;
    RecordProperty("slope", std::to_string(slope));
    EXPECT_LT(slope, -0.45);
}

// With closed-form weights only texels at the edge of what is seen err: less, the finer they are. Against the closed form
// of each patch's middle towards each face.
TEST(FormFactors, ErrorFallsWithTheTexels)
{
    Rig rig(grey_cube().build(), even(48));
    std::vector<double> errors;
    for (const int resolution : {32, 64, 128, 256, 512}) {
        FormFactorParams params = by(FormFactorMethod::hemicube);
        params.samples = 1;
        params.resolution = resolution;
        const FormFactors factors = rig.factors(params);
        double squared = 0.0;
        int count = 0;
        for (std::size_t i = 0; i < rig.patches.size(); ++i) {
            std::array<double, 6> seen{}, exact{};
            for (const FormFactor& f : factors.rows[i].direct) seen[rig.patches[f.patch].draw] += double(f.share);
            for (const Patch& p : rig.patches.all()) {
                if (p.draw == rig.patches[i].draw) continue;
                std::array<glm::dvec3, 3> corners;
                const PatchNode& node = rig.patches.mesh().nodes()[p.node];
                for (std::size_t k = 0; k < 3; ++k)
                    corners[k] = glm::dvec3(rig.patches.mesh().points()[node.corners[k]]);
                exact[p.draw] +=
                    point_to_triangle(glm::dvec3(rig.patches[i].center), glm::dvec3(rig.patches[i].normal), corners);
            }
            for (std::size_t face = 0; face < 6; ++face) {
                if (exact[face] == 0.0) continue;
                squared += std::pow(seen[face] / exact[face] - 1.0, 2.0);
                ++count;
            }
        }
        errors.push_back(std::sqrt(squared / count));
        RecordProperty("error_percent_" + std::to_string(resolution), std::to_string(100.0 * errors.back()));
    }
    EXPECT_LT(errors[1], 0.02);
    EXPECT_LT(errors.back(), 0.25 * errors.front());
}

// Every path of a closed scene ends somewhere: sum_j F^_ij (1 - rho_s,j) = 1. Half of the walls are mirrors of 0.6, so
// that 64 reflections leave nothing.
TEST(Mirrors, WhatIsNotReflectedStays)
{
    PatchParams params = even(96);
    params.fresnel = false;
    Rig rig(cube([](int face) { return face % 2 == 0 ? metal(glm::vec3(0.6f), 0.0f) : lambert(0.5f); }).build(),
            params);
    ASSERT_TRUE(rig.patches.has_mirrors());
    for (const FormFactorMethod method : kMethods) {
        FormFactorParams wanted = by(method);
        wanted.reflections = method == FormFactorMethod::hemicube ? 8 : 64;
        wanted.rays = 256;
        wanted.samples = 1;
        wanted.resolution = 32;
        const FormFactors factors = rig.factors(wanted);
        // Eight reflections leave at most 0.6^9 of the light on its way.
        const double lost = method == FormFactorMethod::hemicube ? std::pow(0.6, 9) : 1e-4;
        for (const FormFactorRow& row : factors.rows) {
            double sum = 0.0;
            for (const FormFactor& f : row.direct) sum += double(f.share) * (1.0 - double(rig.patches[f.patch].f0.x));
            for (const MirroredFormFactor& f : row.mirrored)
                sum += double(f.share.x) * (1.0 - double(rig.patches[f.patch].f0.x));
            ASSERT_NEAR(sum, 1.0, lost + 2e-3) << int(method);
        }
    }
}

// A ceiling that is a mirror, 1 m above a floor with a disc of radius 0.5 at 2 m: its image hangs 2 m above the floor. For
// offset a and height h the disc fills 1/2 (1 - (h^2 + a^2 - R^2) / sqrt((h^2 + a^2 + R^2)^2 - 4 a^2 R^2)) of the view.
TEST(Mirrors, ShowADiscAsItsMirrorImage)
{
    const double h = 2.0, a = 2.0, r = 0.5, s = h * h + a * a + r * r;
    const double disc = 0.5 * (1.0 - (h * h + a * a - r * r) / std::sqrt(s * s - 4.0 * a * a * r * r));
    EXPECT_NEAR(disc, 0.015861, 1e-6);
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f)), mirror = b.material(metal(glm::vec3(0.5f), 0.0f));
    const float e = 0.005f;
    b.quad({-e, 0, e}, {2 * e, 0, 0}, {0, 0, -2 * e}, grey);
    b.disc({2, 0, 0}, {0, 1, 0}, 0.5f, grey, 24);
    b.quad({-5, 1, -5}, {10, 0, 0}, {0, 0, 10}, mirror);
    PatchParams params = even(1);
    params.fresnel = false;
    Rig rig(b.build(), params);
    for (const FormFactorMethod method : kMethods) {
        FormFactorParams wanted = by(method);
        wanted.rays = 16384;
        wanted.resolution = 128;
        const FormFactors factors = rig.factors(wanted);
        double sum = 0.0;
        int rows = 0;
        for (std::size_t i = 0; i < rig.patches.size(); ++i) {
            if (rig.patches[i].draw != 0) continue;
            ++rows;
            for (const FormFactor& f : factors.rows[i].direct) EXPECT_NE(rig.patches[f.patch].draw, 1u);
            for (const MirroredFormFactor& f : factors.rows[i].mirrored)
                if (rig.patches[f.patch].draw == 1 && f.reflections == 1) sum += double(f.share.x);
        }
        RecordProperty("share_of_exact_" + std::to_string(int(method)), std::to_string(sum / rows / (0.5 * disc)));
        EXPECT_NEAR(sum / rows, 0.5 * disc, 0.02 * 0.5 * disc) << int(method);
    }
}

// Exercise 1: a disc of radius R right above, at height h, fills R^2 / (R^2 + h^2).
TEST(Exercises, DiscRightAbove)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-0.005f, 0, 0.005f}, {0.01f, 0, 0}, {0, 0, -0.01f}, grey);
    b.disc({0, 1, 0}, {0, -1, 0}, 0.5f, grey, 48);
    Rig rig(b.build(), even(1));
    for (const FormFactorMethod method : {FormFactorMethod::hemicube, FormFactorMethod::embree}) {
        FormFactorParams params = by(method);
        params.resolution = 128;
        params.rays = 4096;
        EXPECT_NEAR(rig.between(rig.factors(params), 0, 1), 0.25 / 1.25, 0.01 * 0.2) << int(method);
    }
}

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

// A room with a lamp, a mirror and walls of several greys.
SceneBuilder room_with_mirror()
{
    return cube([](int face) {
        if (face == 0) return metal(glm::vec3(0.8f), 0.0f);
        if (face == 3) return emitter(glm::vec3(2.0f), 0.3f);
        return lambert(0.15f + 0.15f * float(face));
    });
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
        for (const FormFactor& f : factors.rows[i].direct) enter(f.patch, double(f.share));
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
    RecordProperty("jacobi_sweeps", std::to_string(sweeps[0]));
    RecordProperty("gauss_seidel_sweeps", std::to_string(sweeps[1]));
    EXPECT_LT(sweeps[1], sweeps[0]);
}

// In a closed room all that is emitted is absorbed in the end: by walls that are no mirrors, 1 - rho of what they get; a
// mirror keeps 1 - rho_s. That holds as far as reciprocity does, which rays know to their noise.
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

// A lamp on one side of a wall that stands on the floor, whose edge the floor's patches share: on the other side it is
// dark to the foot of the wall, on this side it is not darker there. And a box on the floor darkens no patch around it.
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

TEST(FormFactors, AreTheSameBitsInEveryRun)
{
    Rig rig(room_with_mirror().build(), even(200));
    for (const FormFactorMethod method : kMethods) {
        FormFactorParams params = by(method);
        params.samples = 1;
        const FormFactors first = rig.factors(params), second = rig.factors(params);
        for (std::size_t i = 0; i < first.rows.size(); ++i) {
            ASSERT_EQ(first.rows[i].direct.size(), second.rows[i].direct.size());
            for (std::size_t e = 0; e < first.rows[i].direct.size(); ++e) {
                ASSERT_EQ(first.rows[i].direct[e].patch, second.rows[i].direct[e].patch);
                ASSERT_EQ(std::bit_cast<std::uint32_t>(first.rows[i].direct[e].share),
                          std::bit_cast<std::uint32_t>(second.rows[i].direct[e].share));
            }
            ASSERT_EQ(first.rows[i].mirrored.size(), second.rows[i].mirrored.size());
            for (std::size_t e = 0; e < first.rows[i].mirrored.size(); ++e)
                ASSERT_EQ(first.rows[i].mirrored[e].share, second.rows[i].mirrored[e].share);
        }
    }
}

}  // namespace
}  // namespace conebook
