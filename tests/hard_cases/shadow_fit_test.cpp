// Chapter 03: maps are fitted to where shadows fall. The box of the shadows against closed forms, and shadows of lights far
// away and on floors of kilometres against exact geometry.
#include "shadow_geometry.hpp"

#include <random>

#include <glm/ext/matrix_clip_space.hpp>
#include <glm/ext/matrix_transform.hpp>

#include "03_shadow_map/shadowed_box.hpp"

namespace conebook {
namespace {

// A parallel view of 40 x 40 m from 30 m away, depth 1 at the light and 0 at 60 m.
glm::dmat4 parallel_view(const glm::dvec3& towards_light)
{
    return glm::orthoRH_ZO(-20.0, 20.0, -20.0, 20.0, 60.0, 0.0) *
           glm::lookAtRH(30.0 * towards_light, glm::dvec3(0.0), glm::dvec3(0.3, 0.1, 1.0));
}

std::optional<NdcBox> box_of(const SceneBuilder& b, const glm::dmat4& view)
{
    test_gl();  // the context comes first
    const Scene scene = b.build();
    return shadowed_box(view, GpuScene(scene).triangles(), glm::length(scene.bounds.extent()));
}

glm::dvec3 ndc_of(const glm::dmat4& view, const glm::dvec3& point)
{
    const glm::dvec4 clip = view * glm::dvec4(point, 1.0);
    return glm::dvec3(clip) / clip.w;
}

// Shadow and what throws it are one in the light's view: the silhouette of the box, whose extremes are corners.
void expect_silhouette(const std::optional<NdcBox>& found, const glm::dmat4& view, const glm::dmat3& turn)
{
    ASSERT_TRUE(found);
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 p = ndc_of(view, turn * glm::dvec3(Bounds{kBoxLow, kBoxHigh}.corner(i)));
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    for (int axis = 0; axis < 2; ++axis) {
        EXPECT_NEAR(found->low[axis], low[axis], 1e-6);
        EXPECT_NEAR(found->high[axis], high[axis], 1e-6);
    }
    EXPECT_GE(found->high.z, high.z - 1e-6);
    EXPECT_LE(found->low.z, low.z + 1e-6);
}

TEST(ShadowedBox, OfABoxIsItsSilhouetteWhateverTheFloorIsMadeOf)
{
    const glm::vec3 towards = direction_to_light(50, 27);
    const glm::mat3 turn(glm::rotate(glm::mat4(1.0f), 0.4f, glm::normalize(glm::vec3(0.3f, 0.2f, 1.0f))));
    const glm::dmat4 view = parallel_view(turn * towards);
    for (const char* floor :
         {"two triangles", "a grid", "a disc", "a slab", "a double-sided sheet", "two sheets, back to back"}) {
        SceneBuilder b;
        const std::string kind = floor;
        Material m = lambert(0.5f);
        const int grey = b.material(m);
        m.double_sided = true;
        const int both = b.material(m);
        if (kind == "a disc")
            b.disc({0, 0, 0}, {0, 1, 0}, 9.0f, grey);
        else if (kind == "a slab")
            b.box({-9, -0.5f, -9}, {9, 0, 9}, grey);
        else
            b.quad({-9, 0, 9}, {18, 0, 0}, {0, 0, -18}, kind == "a double-sided sheet" ? both : grey,
                   kind == "a grid" ? 64 : 1);
        if (kind == "two sheets, back to back") b.quad({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}, grey);
        SCOPED_TRACE(kind);
        SceneBuilder empty = b;
        empty.transform(turn);
        EXPECT_FALSE(box_of(empty, view));
        b.box(kBoxLow, kBoxHigh, grey);
        b.transform(turn);
        expect_silhouette(box_of(b, view), view, glm::dmat3(turn));
    }
}

TEST(ShadowedBox, RoundThingsShadowThemselvesOnlyWithTwoSides)
{
    for (const bool double_sided : {false, true}) {
        SceneBuilder b;
        Material m = lambert(0.5f);
        m.double_sided = double_sided;
        b.sphere({0, 0, 0}, 1.0f, b.material(m), 16);
        EXPECT_EQ(box_of(b, parallel_view({0, 1, 0})).has_value(), double_sided);
    }
}

TEST(ShadowedBox, WhatIsOutsideTheViewDoesNotCount)
{
    SceneBuilder b = box_on_floor(9.0f);
    b.box({6, 0, 6}, {7, 1, 7}, 0);
    // A cone of 0.2 rad, 0.6 m beside a corner of the first box: its edge cuts the box, the other box is outside, as is one
    // behind the light.
    b.box({0.4f, 5, 0.2f}, {0.6f, 6, 0.4f}, 0);
    const glm::dmat4 view = glm::perspectiveRH_ZO(0.4, 1.0, 20.0, 1e-5) *
                            glm::lookAtRH(glm::dvec3(1.1, 3.8, 0.9), glm::dvec3(1.1, 0.0, 0.9), glm::dvec3(0, 0, 1));
    const std::optional<NdcBox> found = box_of(b, view);
    ASSERT_TRUE(found);
    // x of the picture is the scene's -x: from the corner on the floor, which is nearer to the middle than the one above it,
    // to the edge of the view, in both directions.
    const glm::dvec3 corner = ndc_of(view, {0.5, 0.0, 0.3});
    EXPECT_NEAR(found->low.x, corner.x, 1e-6);
    EXPECT_NEAR(found->high.x, 1.0, 1e-12);
    EXPECT_NEAR(found->low.y, -1.0, 1e-12);
    EXPECT_NEAR(found->high.y, corner.y, 1e-6);
    EXPECT_NEAR(found->high.z, ndc_of(view, {0.5, 0.8, 0.3}).z, 1e-9);
    EXPECT_NEAR(found->low.z, corner.z, 1e-9);
}

// Triangles at random, against a grid of rays.
TEST(ShadowedBox, HoldsAllShadowsAndNoMore)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-1.0f, 1.0f);
    const auto point = [&] { return glm::vec3(uniform(random), uniform(random), uniform(random)); };
    const glm::dmat4 view = parallel_view({0, 1, 0});
    constexpr int kRays = 400;  // a side; the middle 3 m of the view
    int with_shadow = 0;
    double excess = 0.0;
    for (int k = 0; k < 60; ++k) {
        SceneBuilder b;
        Material m = lambert(0.5f);
        const int one = b.material(m);
        m.double_sided = true;
        const int two = b.material(m);
        for (int t = 0; t < 5; ++t) {
            const glm::vec3 center = point();
            b.triangle(center + 0.5f * point(), center + 0.5f * point(), center + 0.5f * point(), t % 2 ? one : two);
        }
        const Scene scene = b.build();
        const std::vector<Triangle> triangles = GpuScene(scene).triangles();
        const std::optional<NdcBox> found = box_of(b, view);
        glm::dvec2 low(INFINITY), high(-INFINITY);  // of the rays that find a shadow
        for (int y = 0; y < kRays; ++y)
            for (int x = 0; x < kRays; ++x) {
                const glm::dvec2 ndc = 0.075 * (2.0 * (glm::dvec2(x, y) + 0.5) / double(kRays) - 1.0);
                double nearest = -INFINITY, farthest_lit = INFINITY;
                for (const Triangle& triangle : triangles) {
                    glm::dvec3 c[3];
                    for (int i = 0; i < 3; ++i) c[i] = ndc_of(view, glm::dvec3(triangle.corners[std::size_t(i)]));
                    const auto cross = [](glm::dvec2 a, glm::dvec2 b) { return a.x * b.y - a.y * b.x; };
                    const double area = cross(glm::dvec2(c[1] - c[0]), glm::dvec2(c[2] - c[0]));
                    glm::dvec3 weight;
                    for (int i = 0; i < 3; ++i)
                        weight[i] = cross(glm::dvec2(c[(i + 1) % 3]) - ndc, glm::dvec2(c[(i + 2) % 3]) - ndc) / area;
                    if (weight.x < 0.0 || weight.y < 0.0 || weight.z < 0.0) continue;
                    const double depth = weight.x * c[0].z + weight.y * c[1].z + weight.z * c[2].z;
                    nearest = std::max(nearest, depth);
                    if (area > 0.0 || triangle.double_sided) farthest_lit = std::min(farthest_lit, depth);
                }
                if (!(farthest_lit < nearest)) continue;
                low = glm::min(low, ndc);
                high = glm::max(high, ndc);
            }
        if (low.x > high.x) continue;  // a shadow may be thinner than the rays are apart
        ++with_shadow;
        ASSERT_TRUE(found) << k;
        const double apart = 0.15 / kRays;
        for (int axis = 0; axis < 2; ++axis) {
            EXPECT_LE(found->low[axis], low[axis]) << k;
            EXPECT_GE(found->high[axis], high[axis]) << k;
            excess += (low[axis] - found->low[axis] + found->high[axis] - high[axis]) / apart;
        }
    }
    EXPECT_GT(with_shadow, 30);
    // No ray is in the last bit of a shadow's corner, which may be sharp (20 rays long, of those of these triangles); of most
    // it is a ray or two.
    EXPECT_LT(excess / (4.0 * with_shadow), 4.0) << "rays between the box's sides and the outermost rays in shadow";
}

// Far away a point light is a directional one, and one map that holds the scene sees more than six that do not look at it.
TEST(ShadowFit, LightsFarAwayKeepTheirShadow)
{
    for (const double distance : {8.0, 200.0, 1.0e3, 1.0e6}) {
        const glm::vec3 towards = direction_to_light(40, 27), intensity(float(3.0 * distance * distance));
        for (const bool spot : {false, true}) {
            SceneBuilder b = box_on_floor();
            if (spot)
                b.spot_light(float(distance) * towards, -towards, intensity, 0.5f, 0.75f);
            else
                b.point_light(float(distance) * towards, intensity);
            const Scene scene = b.build();
            EXPECT_EQ(maps_of(scene, scene.lights[0]).size(), 1u);
            expect_clean(scene, towards, 200, (spot ? "spot, m: " : "point, m: ") + std::to_string(distance));
        }
    }
}

// The map of a light shows where shadows fall, not how large the floor is.
class LargeFloor : public testing::TestWithParam<float> {};

TEST_P(LargeFloor, ASmallThingOnItHasItsShadow)
{
    const glm::vec3 towards = direction_to_light(50, 27);
    for (const char* light : {"directional", "spot", "point", "far point"}) {
        SceneBuilder b = box_on_floor(GetParam());
        const std::string kind = light;
        if (kind == "directional") b.directional_light(-towards, glm::vec3(3.0f));
        if (kind == "spot") b.spot_light(0.7f * GetParam() * towards, -towards, glm::vec3(1e9f), 1.0f, 1.2f);
        if (kind == "point") b.point_light(3.0f * towards, glm::vec3(30.0f));
        if (kind == "far point") b.point_light(20.0f * GetParam() * towards, glm::vec3(1e12f));
        expect_clean(b.build(), towards, 200, kind);
    }
}

INSTANTIATE_TEST_SUITE_P(Metres, LargeFloor, testing::Values(20.0f, 2.0e3f, 2.0e4f),
                         [](const auto& info) { return std::to_string(int(info.param)); });

TEST(ShadowFit, NoOpenGlFaults) { EXPECT_EQ(test_gl().log.faults(), std::vector<std::string>{}); }

}  // namespace
}  // namespace conebook
