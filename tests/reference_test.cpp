// The path tracer against closed forms: lights, bounces, leaks, noise.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <glm/gtc/matrix_transform.hpp>

#include "reference_helpers.hpp"

namespace conebook {
namespace {

TEST(PunctualLights, PointOnAxisAndAtSixtyDegrees)
{
    for (const double angle : {0.0, kPiD / 3.0}) {
        const glm::vec3 light(2.0 * std::sin(angle), 2.0 * std::cos(angle), 0.0);
        const Scene scene = floor_with([&](SceneBuilder& b) { b.point_light(light, {10, 20, 30}); });
        const auto m = measure(scene, at_point({0.5f, 1, 1}, {0, 0, 0}), options(0));
        expect_radiance(m, 0.5 / kPiD * 10.0 * std::cos(angle) / 4.0);
    }
}

TEST(PunctualLights, PointWithRangeWindow)
{
    const Scene scene = floor_with([&](SceneBuilder& b) { b.point_light({0, 2, 0}, glm::vec3(10), 3.0f); });
    const double window = 1.0 - std::pow(2.0 / 3.0, 4);
    expect_radiance(measure(scene, at_point({0.5f, 1, 1}, {0, 0, 0}), options(0)), 0.5 / kPiD * 10.0 / 4.0 * window);
    const Scene beyond = floor_with([&](SceneBuilder& b) { b.point_light({0, 2, 0}, glm::vec3(10), 1.9f); });
    EXPECT_EQ(measure(beyond, at_point({0.5f, 1, 1}, {0, 0, 0}), options(0)).mean, 0.0);
}

TEST(PunctualLights, SpotInsideEdgeAndOutside)
{
    const double inner = 0.2, outer = 0.6;
    const Scene scene = floor_with([&](SceneBuilder& b) {
        b.spot_light({0, 2, 0}, {0, -1, 0}, glm::vec3(10), float(inner), float(outer));
    });
    for (const double angle : {0.0, 0.15, 0.3, 0.5, 0.7}) {
        const double x = 2.0 * std::tan(angle), c = std::cos(angle);
        const double edge = std::clamp((c - std::cos(outer)) / (std::cos(inner) - std::cos(outer)), 0.0, 1.0);
        const auto m = measure(scene, at_point({float(x), 1, 1}, {float(x), 0, 0}), options(0));
        if (edge == 0.0)
            EXPECT_EQ(m.mean, 0.0);
        else  // the picture is 2.4 mm wide: the edge's curvature inside it is under 1e-4
            expect_radiance(m, 0.5 / kPiD * 10.0 * edge * edge * c * c * c / 4.0, 0.005, 1e-4);
    }
}

TEST(PunctualLights, DirectionalAndItsShadow)
{
    const glm::vec3 d(std::sin(kPiD / 3), -std::cos(kPiD / 3), 0);
    const Scene scene = floor_with([&](SceneBuilder& b) {
        b.directional_light(d, glm::vec3(3));
        b.quad({-3, 1, 1}, {2, 0, 0}, {0, 0, -2}, b.material(lambert(0.5f)));  // shades x from -1.27 to 0.73
    });
    expect_radiance(measure(scene, at_point({2, 1, 1}, {2, 0, 0}), options(0)), 0.5 / kPiD * 3.0 * 0.5);
    EXPECT_EQ(measure(scene, at_point({0, 0.5f, 1}, {0, 0, 0}), options(0)).mean, 0.0);
}

TEST(PunctualLights, VeryNearAndBlackLightsStayFinite)
{
    const Scene scene = floor_with([&](SceneBuilder& b) {
        b.point_light({0, 1e-4f, 0}, glm::vec3(1e-6f));
        b.point_light({0, 0, 0}, glm::vec3(1));
        b.point_light({0, 1, 0}, glm::vec3(0));
    });
    const auto m = measure(scene, at_point({0, 1, 1}, {0, 0, 0}), options(0));
    EXPECT_TRUE(std::isfinite(m.mean));
}

// rho = Le = 0.5 everywhere: L after k bounces is 1 - 0.5^(k+1).
TEST(Furnace, DeficitPerBounceStraightAndRotated)
{
    for (const float angle : {0.0f, 0.7853982f, 1.0f}) {
        SceneBuilder b;
        b.box({-1, -1, -1}, {1, 1, 1}, b.material(emitter(0.5f, 0.5f)), true);
        b.transform(glm::mat3(glm::rotate(glm::mat4(1.0f), angle, glm::normalize(glm::vec3(1, 2, 0.5f)))));
        const Scene scene = b.build();
        const Camera camera = look_at({0.1f, 0.2f, 0.3f}, {0.6f, -0.4f, -0.3f}, 1.2f);
        for (const int k : {0, 1, 2, 4})
            expect_radiance(measure(scene, camera, options(k)), 1.0 - std::pow(0.5, k + 1));
        expect_radiance(measure(scene, camera, options(-1)), 1.0);
    }
}

TEST(AreaLights, DiscAbovePlane)
{
    for (const double height : {0.05, 0.5, 2.0}) {
        const double radius = 0.5, radiance = 3.0;
        const Scene scene = floor_with(
            [&](SceneBuilder& b) {
                b.disc({0, float(height), 0}, {0, -1, 0}, float(radius), b.material(emitter(float(radiance))));
            },
            glm::vec3(0.8f));
        const double irradiance = kPiD * radiance * radius * radius / (radius * radius + height * height);
        // Between floor and disc, almost straight down.
        const Camera camera = at_point({0.001f, 0.8f * float(height), 0}, {0, 0, 0});
        expect_radiance(measure(scene, camera, options(1, 256)), 0.8 / kPiD * irradiance);
        EXPECT_EQ(measure(scene, camera, options(0)).mean, 0.0) << "light of emitters begins with the first bounce";
    }
}

// Floor point at distance x from a wall of half width W and height H, whose foot is on the floor (Howell, Catalog of
// Radiation Heat Transfer Configuration Factors, B-4, twice): at contact it tends to E = pi L / 2.
TEST(AreaLights, PerpendicularWallAtContact)
{
    const double x = 1e-3, w = 20.0, h = 20.0;
    SceneBuilder b;
    b.quad({0, 0, 5}, {5, 0, 0}, {0, 0, -10}, b.material(lambert(1.0f)));
    b.quad({0, 0, float(w)}, {0, 0, -2 * float(w)}, {0, float(h), 0}, b.material(emitter(1.0f)));
    const double r = std::sqrt(x * x + h * h);
    const double factor = 2.0 / (2.0 * kPiD) * (std::atan(w / x) - x / r * std::atan(w / r));
    EXPECT_NEAR(factor, 0.5, 1e-3);
    const auto m = measure(b.build(), look_at({float(x), 0.5f, 0}, {float(x), 0, 0}, 1e-4f), options(1));
    expect_radiance(m, factor);
}

TEST(AreaLights, UnitCubeWithOneEmittingFace)
{
    SceneBuilder b;
    const int grey = b.material(lambert(1.0f));
    for (int face = 0; face < 5; ++face) b.box_face({0, 0, 0}, {1, 1, 1}, face, grey, true);
    b.box_face({0, 0, 0}, {1, 1, 1}, 5, b.material(emitter(1.0f)), true);
    const Scene scene = b.build();
    // Form factors of the cube: Howell, C-11 and C-14, with a = b = c.
    const double opposite =
        2.0 / kPiD *
        (std::log(std::sqrt(4.0 / 3.0)) + 2.0 * std::sqrt(2.0) * std::atan(1.0 / std::sqrt(2.0)) - kPiD / 2.0);
    const double adjacent = (1.0 - opposite) / 4.0;
    EXPECT_NEAR(opposite, 0.199825, 1e-6);
    EXPECT_NEAR(adjacent, 0.200044, 1e-6);
    const glm::vec3 middle(0.5f);
    const auto onto = [&](const glm::vec3& d) { return look_at_orthographic(middle, middle + d, 0.5f, 0.5f); };
    expect_radiance(measure(scene, onto({0, 0, -1}), options(1, 128)), opposite);
    expect_radiance(measure(scene, onto({-1, 0, 0}), options(1, 128)), adjacent);
    expect_radiance(measure(scene, onto({0, 1, 0}), options(1, 128)), adjacent);
}

// In a sphere every point sees every element dA with the form factor dA / (4 pi R^2), so the light is constant.
TEST(AreaLights, SphereInteriorWithBrightCap)
{
    const double rho = 0.6;
    SceneBuilder b;
    b.sphere({}, 1.0f, b.material(lambert(float(rho))), 96, true, true, -1.0f, 0.7f);
    b.sphere({}, 1.0f, b.material(emitter(2.0f)), 96, true, true, 0.7f, 1.0f);
    const Scene scene = b.build();
    double area[2] = {0.0, 0.0};
    for (int d = 0; d < 2; ++d)
        for (std::uint32_t t = 0; t < scene.draws[d].index_count; t += 3) {
            const auto p = [&](int k) {
                return glm::dvec3(scene.vertices[scene.indices[scene.draws[d].first_index + t + k]].position);
            };
            area[d] += 0.5 * glm::length(glm::cross(p(1) - p(0), p(2) - p(0)));
        }
    const double cap = area[1] / (area[0] + area[1]);
    const double one = rho * cap * 2.0, all = one / (1.0 - rho * (1.0 - cap));
    for (const glm::vec3& d :
         {glm::vec3(0, 0, -1), glm::vec3(1, 0, 0), glm::vec3(-0.3f, 0.6f, -0.4f), glm::vec3(0.6f, -0.5f, 0.5f)}) {
        const Camera camera = look_at({0.05f, 0, 0}, glm::normalize(d), 0.05f);
        // The facets are 1.9 degrees wide; facet and sphere differ by its square, 1e-3.
        expect_radiance(measure(scene, camera, options(1, 128)), one, 0.005, 1e-3);
        expect_radiance(measure(scene, camera, options(-1, 128)), all, 0.005, 1e-3);
    }
}

// Two rooms side by side; all light is in the left one. Nothing may pass a wall of zero thickness.
Scene two_rooms(bool two_sided, bool swap_faces)
{
    SceneBuilder b;
    b.box({-1, 0, -1}, {1, 1, 1}, b.material(lambert(0.8f)), true);
    b.disc({-0.5f, 0.99f, 0}, {0, -1, 0}, 0.3f, b.material(emitter(10.0f)));
    b.point_light({-0.5f, 0.5f, 0.3f}, glm::vec3(5));
    Material wall = lambert(0.8f);
    wall.double_sided = two_sided;
    const int w = b.material(wall);
    for (int side = 0; side < (two_sided ? 1 : 2); ++side) {
        const float z = (side == 0) != swap_faces ? 1.0f : -1.0f;  // 1: faces +x
        b.quad({0, 0, z}, {0, 0, -2 * z}, {0, 1, 0}, w);
    }
    return b.build();
}

TEST(Leaks, ZeroThicknessWallLeaksNothing)
{
    Measured lit[3];
    for (int i = 0; i < 3; ++i) {
        const Scene scene = two_rooms(i == 0, i == 2);
        const auto dark =
            path_trace(scene, look_at({0.9f, 0.5f, 0.9f}, {0, 0.3f, 0}, 1.3f), options(-1, 64, 48)).pictures[0];
        for (const glm::vec4& p : dark.pixels) ASSERT_EQ(glm::vec3(p), glm::vec3(0.0f));
        lit[i] = measure(scene, look_at({-0.9f, 0.5f, 0.9f}, {0, 0.3f, 0}, 1.3f), options(-1, 64, 48));
        EXPECT_LT(lit[i].error, 0.005 * lit[i].mean);
        // Two single-sided quads at one place reflect like one double-sided quad, whichever the traversal meets first.
        EXPECT_NEAR(lit[i].mean, lit[0].mean, 3.0 * std::hypot(lit[i].error, lit[0].error));
    }
}

TEST(Tracer, PartsAddUpAndBouncesAreSplitByTheFirstLobe)
{
    SceneBuilder b;
    Material glossy = lambert(0.5f);
    glossy.specular = 1.0f;
    glossy.roughness = 0.3f;
    b.box({-1, -1, -1}, {1, 1, 1}, b.material(glossy), true);
    b.disc({0, 0.9f, 0}, {0, -1, 0}, 0.4f, b.material(emitter(5.0f)));
    b.point_light({0.3f, 0.2f, 0.1f}, {1, 2, 3});
    PathTraceOptions o = options(3, 8, 24);
    o.parts = {Part::final, Part::direct, Part::indirect_diffuse, Part::indirect_specular, Part::emission};
    const auto r = path_trace(b.build(), look_at({0, 0, 0.9f}, {0, 0.1f, -1}, 1.2f), o);
    for (std::size_t i = 0; i < r.pictures[0].pixels.size(); ++i) {
        glm::vec3 sum(0.0f);
        for (int p = 1; p < 5; ++p) sum += glm::vec3(r.pictures[p].pixels[i]);
        const glm::vec3 whole(r.pictures[0].pixels[i]);
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(sum[c], whole[c], 1e-5f * whole[c] + 1e-7f);
    }
    for (int p = 0; p < 5; ++p) EXPECT_GT(mean_radiance(r.pictures[p], r.errors[p]).mean.x, 1e-4) << p;
}

TEST(Tracer, SamePictureForAnyNumberOfThreadsAndOtherForOtherSeeds)
{
    SceneBuilder b;
    b.box({-1, -1, -1}, {1, 1, 1}, b.material(emitter(0.5f, 0.5f)), true);
    const Scene scene = b.build();
    const Camera camera = look_at({0, 0, 0.5f}, {0, 0, -1}, 1.0f);
    PathTraceOptions o = options(-1, 20, 40);
    o.threads = 1;
    const auto one = path_trace(scene, camera, o);
    o.threads = 3;
    EXPECT_EQ(one.pictures[0].pixels, path_trace(scene, camera, o).pictures[0].pixels);
    o.seed = 1;
    EXPECT_NE(one.pictures[0].pixels, path_trace(scene, camera, o).pictures[0].pixels);
}

// Two independent pictures differ by sqrt(2) standard errors on average.
TEST(Tracer, StandardErrorPredictsTheScatter)
{
    SceneBuilder b;
    b.box({-1, -1, -1}, {1, 1, 1}, b.material(lambert(0.7f)), true);
    b.disc({0, 0.9f, 0}, {0, -1, 0}, 0.4f, b.material(emitter(5.0f)));
    const Scene scene = b.build();
    const Camera camera = look_at({0, -0.5f, 0.9f}, {0, -0.5f, -1}, 1.0f);
    PathTraceOptions o = options(2, 64, 48);
    const auto a = path_trace(scene, camera, o);
    o.seed = 7;
    const auto c = path_trace(scene, camera, o);
    double sum = 0.0, expected = 0.0;
    for (std::size_t i = 0; i < a.pictures[0].pixels.size(); ++i) {
        const double d = double(a.pictures[0].pixels[i].x) - c.pictures[0].pixels[i].x;
        sum += d * d;
        expected += std::pow(a.errors[0].pixels[i].x, 2) + std::pow(c.errors[0].pixels[i].x, 2);
    }
    // 2304 pixels: the ratio of variances scatters by sqrt(2 / 2304) = 3 %; heavier tails of the paths double it.
    EXPECT_NEAR(sum / expected, 1.0, 0.12);
}

TEST(Tracer, AlphaIsCoverageAndSkyShowsWhereThereIsNothing)
{
    SceneBuilder b;
    b.quad({0, 0, 1}, {1, 0, 0}, {0, 0, -1}, b.material(lambert(0.5f)));
    PathTraceOptions o = options(0, 16, 16);
    o.sky = glm::vec3(0.25f);
    const auto r = path_trace(b.build(), look_at_orthographic({0, 1, 0.5f}, {0, 0, 0.5f}, 0.5f, 0.5f), o);
    EXPECT_EQ(r.pictures[0].at(2, 8), glm::vec4(0.25f, 0.25f, 0.25f, 0.0f));
    EXPECT_EQ(r.pictures[0].at(13, 8), glm::vec4(0, 0, 0, 1));
}

TEST(Tracer, RefusesImpossibleOptions)
{
    const Scene scene = floor_with([](SceneBuilder&) {});
    const Camera camera = look_at({0, 1, 1}, {}, 1.0f);
    PathTraceOptions o = options(0);
    o.spp = 0;
    EXPECT_THROW(path_trace(scene, camera, o), std::runtime_error);
    o = options(0, 1, 0);
    EXPECT_THROW(path_trace(scene, camera, o), std::runtime_error);
    o = options(0);
    o.sky = glm::vec3(NAN);
    EXPECT_THROW(path_trace(scene, camera, o), std::runtime_error);
    EXPECT_THROW(part_from_name("diffuse"), std::runtime_error);
}

}  // namespace
}  // namespace conebook
