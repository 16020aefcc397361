// Shadows by cones, maps and the kept visibility: widths of penumbrae, planes that do not shadow themselves, walls that
// let no light through.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>

#include "light_pipeline.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

constexpr int kVoxels = 128;

SoftShadowParams light_of_radius(float radius_m)
{
    SoftShadowParams params;
    params.light_radius = radius_m;
    return params;
}
SoftShadowParams light_of_angle(float full_angle_deg)
{
    SoftShadowParams params;
    params.light_angle = full_angle_deg;
    return params;
}

// Share of a disc of radius 1 on the side x < u of a straight edge.
double disc_share(double u)
{
    u = std::clamp(u, -1.0, 1.0);
    return 0.5 + (u * std::sqrt(1.0 - u * u) + std::asin(u)) / std::numbers::pi;
}
// Where that share is `share`, by bisection.
double disc_edge(double share)
{
    double low = -1.0, high = 1.0;
    for (int i = 0; i < 60; ++i) (disc_share(0.5 * (low + high)) < share ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}

// First place, in pixels, where a row that rises from dark to lit passes `value`.
double crossing(const ImageF& image, int row, double value)
{
    for (int x = 1; x < image.width; ++x) {
        const double a = double(image.at(x - 1, row).r), b = double(image.at(x, row).r);
        if (a < value && b >= value) return x - 1 + 0.5 + (value - a) / (b - a);
    }
    return NAN;
}

// A sheet over the half x < 0 of a floor of 4 x 4 m, 1 m above it, and a small one that lifts the scene's bounds.
SceneBuilder half_covered_floor()
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);
    b.quad({-2, 1, -2}, {2, 0, 0}, {0, 0, 4}, grey);
    b.quad({-2, 1.3f, -2}, {0.1f, 0, 0}, {0, 0, 0.1f}, grey);
    return b;
}
// Straight down on the floor, below the sheet (its near plane): x from -0.8 to 0.8 in 256 pixels.
constexpr float kHalfWidth = 0.8f;
Camera below_the_sheet(float half_height = kHalfWidth)
{
    return look_at_orthographic({0, 0.9f, 0}, {0, 0, 0}, kHalfWidth, half_height);
}

// The edge of the sheet halves the way from floor to light, so its shadow is as wide as the light: the floor at x sees
// the part of the light beyond -x. Between 10 % and 90 % lie 0.687 radii on both sides of the middle.
TEST(SoftShadows, PenumbraIsAsWideAsTheLightMakesIt)
{
    for (const float radius : {0.08f, 0.16f, 0.32f}) {
        SceneBuilder b = half_covered_floor();
        b.point_light({0, 2.0f, 0}, glm::vec3(10.0f));
        LightPipeline pipeline(b.build(), below_the_sheet(0.02f), {256, 4}, kVoxels);
        const ImageF visible = pipeline.visibility(ShadowMethod::cone, light_of_radius(radius));
        const double metres_per_pixel = 2.0 * double(kHalfWidth) / 256.0;
        const double width = (crossing(visible, 2, 0.9) - crossing(visible, 2, 0.1)) * metres_per_pixel;
        const double exact = 2.0 * double(radius) * disc_edge(0.9);
        EXPECT_NEAR(width, exact, 0.2 * exact) << "radius " << radius;
        const double middle = crossing(visible, 2, 0.5) * metres_per_pixel - double(kHalfWidth);
        EXPECT_NEAR(middle, 0.0, 0.2 * exact) << "radius " << radius;
    }
}

TEST(SoftShadows, PenumbraOfASlantedSun)
{
    // From 30 degrees off the vertical, perpendicular to the edge and along it; the edge's shadow is stretched by the slope.
    for (const float angle : {5.0f, 10.0f, 20.0f})
        for (const bool across : {true, false}) {
            SceneBuilder b = half_covered_floor();
            const float slope = 1.0f / std::sqrt(3.0f);
            b.directional_light(across ? glm::vec3(slope, -1, 0) : glm::vec3(0, -1, slope), glm::vec3(1.0f));
            const float x = across ? slope : 0.0f;  // where the edge's shadow falls
            const Camera camera = look_at_orthographic({x, 0.9f, 0}, {x, 0, 0}, kHalfWidth, 0.02f);
            LightPipeline pipeline(b.build(), camera, {256, 4}, kVoxels);
            const ImageF visible = pipeline.visibility(ShadowMethod::cone, light_of_angle(angle));
            const double metres_per_pixel = 2.0 * double(kHalfWidth) / 256.0;
            const double width = (crossing(visible, 2, 0.9) - crossing(visible, 2, 0.1)) * metres_per_pixel;
            // A direction u radii off the centre: across the slope tan(30 deg + u a), along it tan(u a) / cos 30 deg.
            const double a = double(glm::radians(0.5f * angle)), tilt = std::numbers::pi / 6.0, u = disc_edge(0.9);
            const double exact =
                across ? std::tan(tilt + u * a) - std::tan(tilt - u * a) : 2.0 * std::tan(u * a) / std::cos(tilt);
            EXPECT_NEAR(width, exact, 0.2 * exact) << "angle " << angle << " across " << across;
        }
}

// A floor tilted by `tilt` round z under a sun that is `incidence` off its normal, turned by `azimuth` round it.
double share_of_self_shadow(float tilt_deg, float incidence_deg, float azimuth_deg, ShadowMethod method)
{
    SceneBuilder b;
    const float t = glm::radians(tilt_deg), i = glm::radians(incidence_deg), a = glm::radians(azimuth_deg);
    const glm::vec3 u(std::cos(t), std::sin(t), 0), v(0, 0, -1), n = glm::cross(u, v);
    b.quad(-u - v, 2.0f * u, 2.0f * v, b.material(lambert(0.5f)));
    b.directional_light(-(std::cos(i) * n + std::sin(i) * (std::cos(a) * u + std::sin(a) * v)), glm::vec3(1.0f));
    LightPipeline pipeline(b.build(), look_at(2.0f * n, {0, 0, 0}, 0.8f), {64, 64}, kVoxels);
    const ImageF visible = pipeline.visibility(method, light_of_angle(2.0f));
    double dark = 0.0, seen = 0.0;
    for (const glm::vec4& pixel : visible.pixels) {
        seen += pixel.a > 0.5f ? 1.0 : 0.0;
        dark += pixel.a > 0.5f && pixel.r < 0.99f ? 1.0 : 0.0;
    }
    EXPECT_GT(seen, 2000.0);
    return dark / seen;
}

TEST(SoftShadows, PlanesDoNotShadowThemselves)
{
    for (const float tilt : {0.0f, 7.0f, 23.0f, 45.0f})
        for (const float incidence : {0.0f, 30.0f, 60.0f, 80.0f})
            for (const float azimuth : {20.0f, 180.0f})
                EXPECT_LE(share_of_self_shadow(tilt, incidence, azimuth, ShadowMethod::cone), 0.001)
                    << "tilt " << tilt << " incidence " << incidence << " azimuth " << azimuth;
}

TEST(SoftShadows, NothingIsSeenOfALightBehindAWall)
{
    // A wall of one side, of two sides and of zero thickness, and a box, straight and turned.
    for (const int kind : {0, 1, 2})
        for (const float turn : {0.0f, 20.0f, 45.0f}) {
            SceneBuilder b;
            Material sheet = lambert(0.5f);
            sheet.double_sided = kind == 1;
            const int grey = b.material(lambert(0.5f)), wall = b.material(sheet);
            b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);
            const float a = glm::radians(turn);
            const glm::vec3 u(std::cos(a), 0, std::sin(a)), n(-std::sin(a), 0, std::cos(a));
            b.quad(-1.8f * u, 3.6f * u, {0, 1.5f, 0}, wall);
            if (kind == 2) b.quad(1.8f * u - 0.15f * n, -3.6f * u, {0, 1.5f, 0}, wall);
            b.point_light({-0.1f, 0.7f, -0.9f}, glm::vec3(5.0f));
            LightPipeline pipeline(b.build(), look_at_orthographic({0.3f, 1, 1.2f}, {0.3f, 0, 1.2f}, 0.25f, 0.25f),
                                   {32, 32}, kVoxels);
            for (const float radius : {0.001f, 0.1f}) {
                const Spread seen = spread_of(pipeline.visibility(ShadowMethod::cone, light_of_radius(radius)));
                EXPECT_LT(seen.high, 0.01) << "kind " << kind << " turned " << turn << " radius " << radius;
            }
        }
}

// Contact: the shadow of a box begins where the box stands.
TEST(SoftShadows, NoLightAtTheFootOfABox)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);
    b.box({-0.6f, 0, -0.6f}, {0, 1, 0.6f}, grey);
    b.directional_light({1, -1, 0}, glm::vec3(1.0f));
    LightPipeline pipeline(b.build(), look_at_orthographic({0.2f, 0.9f, 0}, {0.2f, 0, 0}, 0.2f, 0.2f), {128, 128},
                           kVoxels);
    const ImageF visible = pipeline.visibility(ShadowMethod::cone, light_of_angle(0.53f));
    double leak_m = 0.0;
    for (int x = 0; x < 128; ++x) leak_m += double(visible.at(x, 64).r) * 0.4 / 128.0;
    EXPECT_LT(leak_m, 1.5 * double(pipeline.grid().voxel_size_m()));
    for (const glm::vec4& pixel : pipeline.visibility(ShadowMethod::map, light_of_angle(0.53f)).pixels)
        EXPECT_EQ(pixel.r, 0.0f);  // all of this floor is in the shadow
}

TEST(SoftShadows, TheThreeShadowsAgreeFarFromEdges)
{
    SceneBuilder b = half_covered_floor();
    b.point_light({0.3f, 2.0f, 0.2f}, glm::vec3(10.0f));
    LightPipeline pipeline(b.build(), below_the_sheet(), {128, 128}, kVoxels);
    const ImageF map = pipeline.visibility(ShadowMethod::map, light_of_radius(0.05f));
    const ImageF cone = pipeline.visibility(ShadowMethod::cone, light_of_radius(0.05f));
    const ImageF volume = pipeline.visibility(ShadowMethod::volume, light_of_radius(0.05f));
    const double v = double(pipeline.grid().voxel_size_m());
    int compared = 0;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x) {
            const double edge_m = std::abs((x + 0.5) / 64.0 * double(kHalfWidth) - double(kHalfWidth) + 0.3);
            if (edge_m < 0.05 + 3.0 * v) continue;
            ASSERT_NEAR(cone.at(x, y).r, map.at(x, y).r, 0.01) << x << " " << y;
            ASSERT_NEAR(volume.at(x, y).r, map.at(x, y).r, 0.01) << x << " " << y;
            ++compared;
        }
    EXPECT_GT(compared, 5000);
}

TEST(SoftShadows, LightNearerThanItsRadiusIsFinite)
{
    SceneBuilder b = half_covered_floor();
    b.point_light({0.2f, 0.05f, 0}, glm::vec3(0.01f));
    LightPipeline pipeline(b.build(), below_the_sheet(), {64, 64}, 64);
    for (const float radius : {0.05f, 0.5f, 10.0f}) {
        for (const glm::vec4& pixel : pipeline.direct(ShadowMethod::cone, light_of_radius(radius)).pixels)
            ASSERT_TRUE(std::isfinite(pixel.r) && pixel.r >= 0.0f) << radius;
        const Spread seen = spread_of(pipeline.visibility(ShadowMethod::cone, light_of_radius(radius)));
        EXPECT_GE(seen.low, 0.0);
        EXPECT_LE(seen.high, 1.0);
    }
}

TEST(SoftShadows, MeaninglessParametersAreRefused)
{
    const TemporaryFolder folder;
    const std::filesystem::path picture = folder / "picture.png";
    for (const char* wrong : {"light_radius=0", "shadow_cones=0", "light_radius=-1", "light_radius=nan",
                              "light_angle=0", "light_angle=180", "shadows=none", "shadow_radius=1"}) {
        const ProgramRun run = run_program("10_soft_shadows", std::string("--headless --size 16x16 --output '") +
                                                                  picture.string() + "' --set " + wrong);
        EXPECT_NE(run.code, 0) << wrong;
        EXPECT_LT(run.code, 128) << wrong;
        const std::string name = std::string(wrong).substr(0, std::string(wrong).find('='));
        EXPECT_NE(run.output.find(name), std::string::npos) << run.output;
        EXPECT_FALSE(std::filesystem::exists(picture)) << wrong;
    }
}

}  // namespace
}  // namespace conebook
