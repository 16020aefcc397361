// Form factors against closed forms, the solution against elimination in double precision and against what is known
// of closed rooms, mirrors against their mirror image.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "20_form_factor_radiosity/lamps.hpp"
#include "patch_rig.hpp"

namespace conebook {
namespace {

TEST(BisectedMesh, HasNoCornerInsideAnEdgeAndCoversTheScene)
{
    SceneBuilder b = grey_cube();
    b.triangle({0.1f, 0.2f, 0.3f}, {0.9f, 0.25f, 0.3f}, {0.5f, 0.22f, 0.7f}, 0);
    const Scene scene = b.build();
    BisectedMesh mesh(scene);
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
        for (const FormFactorEntry& f : row.direct)
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

// With closed-form weights only texels at the edge of what is seen err: less, the finer they are. Against the
// closed form of each patch's middle towards each face.
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
            for (const FormFactorEntry& f : factors.rows[i].direct) seen[rig.patches[f.patch].draw] += double(f.share);
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

// Every path of a closed scene ends somewhere: sum_j F^_ij (1 - rho_s,j) = 1. Half of the walls are mirrors of 0.6,
// so that 64 reflections leave nothing.
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
            for (const FormFactorEntry& f : row.direct)
                sum += double(f.share) * (1.0 - double(rig.patches[f.patch].f0.x));
            for (const MirroredFormFactor& f : row.mirrored)
                sum += double(f.share.x) * (1.0 - double(rig.patches[f.patch].f0.x));
            ASSERT_NEAR(sum, 1.0, lost + 2e-3) << int(method);
        }
    }
}

// A ceiling that is a mirror, 1 m above a floor with a disc of radius 0.5 at 2 m: its image hangs 2 m above the
// floor. For offset a and height h the disc fills 1/2 (1 - (h^2 + a^2 - R^2) / sqrt((h^2 + a^2 + R^2)^2 - 4 a^2
// R^2)) of the view.
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
            for (const FormFactorEntry& f : factors.rows[i].direct) EXPECT_NE(rig.patches[f.patch].draw, 1u);
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
