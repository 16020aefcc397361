// Chapter 06: the radiance of voxel faces against closed forms, and their shadows against exact geometry.
#include <algorithm>
#include <cmath>
#include <ostream>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "voxel_pipeline.hpp"

namespace conebook {
namespace {

constexpr double kPiD = 3.14159265358979323846;

VoxelShadingParams shadows(VoxelShadows kind)
{
    VoxelShadingParams params;
    params.voxel_shadows = kind;
    return params;
}

// Middle of the part of the plane y = `height` (scene space) that lies in the voxel: the plane covers the scene's bounds.
glm::dvec3 plane_center(const VoxelPipeline& pipeline, const Bounds& bounds, const glm::ivec3& voxel, double height)
{
    const glm::dvec3 low = glm::max(pipeline.scene_from_grid(glm::dvec3(voxel)), glm::dvec3(bounds.min));
    const glm::dvec3 high = glm::min(pipeline.scene_from_grid(glm::dvec3(voxel) + 1.0), glm::dvec3(bounds.max));
    return {0.5 * (low.x + high.x), height, 0.5 * (low.z + high.z)};
}

// Irradiance of a light on a surface element (KHR_lights_punctual), in double precision; no shadow.
glm::dvec3 irradiance(const Light& light, const glm::dvec3& position, const glm::dvec3& normal)
{
    const glm::dvec3 intensity(light.intensity);
    if (light.type == LightType::directional)
        return intensity * std::max(0.0, -glm::dot(glm::dvec3(light.direction), normal));
    const glm::dvec3 s = glm::dvec3(light.position) - position;
    const double d = glm::length(s);
    double factor = std::max(0.0, glm::dot(s, normal)) / (d * d * d);
    if (light.type == LightType::spot) {
        const double inner = std::cos(double(light.inner_cone_angle)), outer = std::cos(double(light.outer_cone_angle));
        const double c = glm::dot(glm::dvec3(light.direction), -s / d);
        const double edge = std::clamp((c - outer) / std::max(0.001, inner - outer), 0.0, 1.0);
        factor *= edge * edge;
    }
    return intensity * factor;
}

// --- A plane under one light: rho / pi E in the middle of the part of the plane in each voxel ---

struct LitPlane {
    const char* name;
    Light light;
    double steepest_deg;  // angles that the plane sees from this light go up to here at least
};

void PrintTo(const LitPlane& plane, std::ostream* out) { *out << plane.name; }

class KnownPlane : public testing::TestWithParam<LitPlane> {};

TEST_P(KnownPlane, RadianceIsTheClosedForm)
{
    SceneBuilder b;
    const glm::dvec3 rho(0.8, 0.5, 0.2);
    b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, b.material(lambert(glm::vec3(rho))));
    Scene scene = b.build();
    scene.lights = {GetParam().light};
    const VoxelPipeline pipeline(scene, 64);
    double worst = 0.0, steepest = 0.0, least_steep = 90.0;
    for (const LitFace& face : pipeline.faces()) {
        if (face.mean.albedo_area.a < 1e-3f) continue;  // merely touched
        ASSERT_EQ(face.direction, 3);
        const glm::dvec3 p = plane_center(pipeline, scene.bounds, face.voxel, 0.0);
        const Light& light = scene.lights[0];
        const glm::dvec3 to_light = light.type == LightType::directional
                                        ? -glm::dvec3(light.direction)
                                        : glm::normalize(glm::dvec3(light.position) - p);
        const double angle = std::acos(std::clamp(to_light.y, -1.0, 1.0)) * 180.0 / kPiD;
        const glm::dvec3 expected = rho / kPiD * irradiance(light, p, {0, 1, 0});
        steepest = std::max(steepest, angle);
        least_steep = std::min(least_steep, angle);
        for (int c = 0; c < 3; ++c) {
            // What is nearly 0 at the rim of a spot is compared with 1e-4 of the middle.
            const double scale = std::max(expected[c], 1e-4 * double(light.intensity[c]));
            worst = std::max(worst, std::abs(double(face.radiance[c]) - expected[c]) / scale);
        }
    }
    EXPECT_GE(steepest, GetParam().steepest_deg);
    if (GetParam().light.type != LightType::directional) {
        EXPECT_LT(least_steep, 5.0);
    }
    EXPECT_LT(worst, 0.005);
}

Light point(glm::vec3 position)
{
    Light light;
    light.position = position;
    light.intensity = {3.0f, 2.0f, 1.0f};
    return light;
}
Light directional(double angle_deg)
{
    Light light = point({});
    light.type = LightType::directional;
    const double a = angle_deg * kPiD / 180.0;
    light.direction = glm::vec3(std::sin(a), -std::cos(a), 0.0);
    return light;
}
Light spot(glm::vec3 position, double inner_deg, double outer_deg)
{
    Light light = point(position);
    light.type = LightType::spot;
    light.direction = {0, -1, 0};
    light.inner_cone_angle = float(inner_deg * kPiD / 180.0);
    light.outer_cone_angle = float(outer_deg * kPiD / 180.0);
    return light;
}

INSTANTIATE_TEST_SUITE_P(Lights, KnownPlane,
                         testing::Values(LitPlane{"point", point({0.0f, 1.0f, 0.0f}), 60.0},
                                         LitPlane{"point_near", point({0.3f, 0.4f, -0.2f}), 75.0},
                                         LitPlane{"directional_0", directional(0.0), 0.0},
                                         LitPlane{"directional_60", directional(60.0), 59.9},
                                         LitPlane{"directional_80", directional(80.0), 79.9},
                                         LitPlane{"spot", spot({0.0f, 1.5f, 0.0f}, 20.0, 60.0), 60.0}),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(VoxelShading, PlaneLitFromBehindIsBlack)
{
    SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(lambert(0.5f)));
    b.point_light({0, -0.5f, 0}, glm::vec3(10.0f));
    b.directional_light({0, 1, 0}, glm::vec3(10.0f));
    const VoxelPipeline pipeline(b.build(), 32);
    ASSERT_GT(pipeline.faces().size(), 900u);
    for (const LitFace& face : pipeline.faces()) EXPECT_EQ(face.radiance, glm::vec3(0.0f));
}

// Each side of a sheet keeps its own light.
TEST(VoxelShading, SheetIsLitOnOneSide)
{
    SceneBuilder b;
    Material sheet = lambert(0.5f);
    sheet.double_sided = true;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(sheet));
    b.directional_light({0, -1, 0}, glm::vec3(float(kPiD)));
    const VoxelPipeline pipeline(b.build(), 32);
    int upper = 0, lower = 0;
    for (const LitFace& face : pipeline.faces()) {
        if (face.mean.albedo_area.a < 1e-3f) continue;
        EXPECT_NEAR(face.radiance.x, face.direction == 3 ? 0.5f : 0.0f, 1e-4f);
        (face.direction == 3 ? upper : lower) += 1;
    }
    EXPECT_EQ(upper, 32 * 32);
    EXPECT_EQ(lower, 32 * 32);
}

// --- Directional Lambert (Villegas 2016, 4.4): sum over axes of n_a^2 max(sign(n_a) l_a, 0) ---

TEST(VoxelShading, DirectionalLambertIsItsFormula)
{
    SceneBuilder b;
    b.sphere({}, 1.0f, b.material(lambert(0.7f)));
    const glm::vec3 to_light = glm::normalize(glm::vec3(0.3f, 0.9f, -0.4f));
    b.directional_light(-to_light, glm::vec3(2.0f));
    VoxelShadingParams params = shadows(VoxelShadows::none);
    params.voxel_lambert = VoxelLambert::directional;
    const VoxelPipeline pipeline(b.build(), 32, params);
    double differs_from_lambert = 0.0;
    for (const LitFace& face : pipeline.faces()) {
        const glm::dvec3 n(face.mean.normal), l(to_light);
        double cosine = 0.0;
        for (int a = 0; a < 3; ++a) cosine += n[a] * n[a] * std::max((n[a] < 0.0 ? -1.0 : 1.0) * l[a], 0.0);
        EXPECT_NEAR(face.radiance.x, double(face.mean.albedo_area.x) / kPiD * 2.0 * cosine, 1e-6);
        differs_from_lambert = std::max(differs_from_lambert, std::abs(cosine - std::max(glm::dot(n, l), 0.0)));
    }
    EXPECT_GT(differs_from_lambert, 0.1);  // or nothing was tested
}

TEST(VoxelShading, EmissionKeepsItsRange)
{
    SceneBuilder b;
    const float values[] = {1e-3f, 1.0f, 123.4f, 1e4f};
    for (int i = 0; i < 4; ++i)
        b.quad({float(i), 0, 0.5f}, {0.8f, 0, 0}, {0, 0, -1}, b.material(emitter({values[i], 2.0f * values[i], 0.0f}, 0.5f)));
    const VoxelPipeline pipeline(b.build(), 64);
    int seen[4] = {};
    for (const LitFace& face : pipeline.faces()) {
        const double x = pipeline.scene_from_grid(glm::dvec3(face.mean.position)).x;
        const int i = std::clamp(int(std::floor(x + 1e-4)), 0, 3);
        if (face.mean.albedo_area.a < 1e-3f) continue;
        EXPECT_NEAR(face.radiance.x, values[i], 0.001f * values[i]);
        EXPECT_NEAR(face.radiance.y, 2.0f * values[i], 0.002f * values[i]);
        EXPECT_EQ(face.radiance.z, 0.0f);
        ++seen[i];
    }
    for (const int n : seen) EXPECT_GT(n, 100);
}

// --- A square blocker over a floor: which faces of the floor the light sees ---

constexpr float kBlockerHeight = 1.0f;
const glm::vec2 kBlockerLow(-0.6f, -0.5f), kBlockerHigh(0.5f, 0.7f);

struct Misjudged {
    double lit, dark;  // share of the lit and of the shadowed faces that the voxels call the opposite
    int lit_faces, dark_faces;
};

// Faces nearer than `margin` voxels to the exact edge of the shadow are left out.
Misjudged misjudge(const Light& light, VoxelShadows kind, double margin)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);
    b.quad({kBlockerLow.x, kBlockerHeight, kBlockerHigh.y}, {kBlockerHigh.x - kBlockerLow.x, 0, 0},
           {0, 0, kBlockerLow.y - kBlockerHigh.y}, grey);
    Scene scene = b.build();
    scene.lights = {light};
    const VoxelPipeline pipeline(scene, 64, shadows(kind));
    const double voxel = double(pipeline.grid().origin.w);
    Misjudged result{};
    for (const LitFace& face : pipeline.faces()) {
        const glm::dvec3 p = plane_center(pipeline, scene.bounds, face.voxel, 0.0);
        if (face.direction != 3 || face.mean.albedo_area.a < 1e-3f || face.mean.position.y > 4.0f) continue;
        // Where the ray to the light crosses the blocker's plane; distances there shrink by `shrink`.
        glm::dvec3 s = -glm::dvec3(light.direction);
        double t = double(kBlockerHeight) / s.y, shrink = 1.0;
        if (light.type != LightType::directional) {
            s = glm::dvec3(light.position) - p;
            t = double(kBlockerHeight) / s.y;
            shrink = 1.0 - t;
        }
        const glm::dvec3 q = p + t * s;
        const double outside = std::max({double(kBlockerLow.x) - q.x, q.x - double(kBlockerHigh.x),
                                         double(kBlockerLow.y) - q.z, q.z - double(kBlockerHigh.y)});
        if (std::abs(outside) < margin * voxel * shrink) continue;
        if (outside > 0.0) {
            ++result.lit_faces;
            result.lit += face.visibility < 0.5f ? 1.0 : 0.0;
        } else {
            ++result.dark_faces;
            result.dark += face.visibility >= 0.5f ? 1.0 : 0.0;
        }
    }
    result.lit /= std::max(result.lit_faces, 1);
    result.dark /= std::max(result.dark_faces, 1);
    return result;
}

class KnownShadow : public testing::TestWithParam<LitPlane> {};

TEST_P(KnownShadow, MapIsRightBeyondOneVoxelFromTheEdge)
{
    const Misjudged m = misjudge(GetParam().light, VoxelShadows::map, 1.0);
    EXPECT_GT(m.lit_faces, 500);
    EXPECT_GT(m.dark_faces, 200);
    EXPECT_EQ(m.lit, 0.0);
    EXPECT_EQ(m.dark, 0.0);
}

// Rays see cubes: the blocker grows by up to a voxel on each side and by its thickness, seen at a slant.
// They start two voxels from the face, which costs nothing here.
TEST_P(KnownShadow, RaysAreRightBeyondThreeVoxelsFromTheEdge)
{
    const Misjudged hard = misjudge(GetParam().light, VoxelShadows::hard_ray, 3.0);
    EXPECT_EQ(hard.lit, 0.0);
    EXPECT_EQ(hard.dark, 0.0);
    const Misjudged near = misjudge(GetParam().light, VoxelShadows::hard_ray, 1.0);
    RecordProperty("lit_called_dark_percent", std::to_string(100.0 * near.lit));
    EXPECT_EQ(near.dark, 0.0);  // a shadow of cubes is never too small
    EXPECT_LT(near.lit, 0.05);
}

INSTANTIATE_TEST_SUITE_P(Lights, KnownShadow,
                         testing::Values(LitPlane{"point", point({0.2f, 3.0f, 0.1f}), 0},
                                         LitPlane{"point_aside", point({-1.8f, 2.5f, 0.4f}), 0},
                                         LitPlane{"directional_0", directional(0.0), 0},
                                         LitPlane{"directional_45", directional(45.0), 0},
                                         LitPlane{"spot", spot({0.2f, 3.0f, 0.1f}, 50.0, 60.0), 0}),
                         [](const auto& info) { return std::string(info.param.name); });

// A voxel's mean point lies inside a round surface, not on it: the lookup starts half a voxel outside.
TEST(VoxelShadowsMap, RoundSurfacesDoNotShadowThemselves)
{
    SceneBuilder b;
    b.sphere({}, 1.0f, b.material(lambert(0.5f)), 48);
    const glm::vec3 to_light = glm::normalize(glm::vec3(0.3f, 0.9f, -0.4f));
    b.directional_light(-to_light, glm::vec3(1.0f));
    const VoxelPipeline pipeline(b.build(), 32);
    int lit = 0, acne = 0;
    for (const LitFace& face : pipeline.faces()) {
        if (glm::dot(glm::vec3(face.mean.normal), to_light) < 0.1f || face.mean.albedo_area.a < 1e-3f) continue;
        ++lit;
        acne += face.visibility < 0.99f ? 1 : 0;
    }
    EXPECT_GT(lit, 1000);
    EXPECT_EQ(acne, 0);
}

// A soft ray that meets one voxel far away keeps a part of the light: s/t of it is lost.
TEST(VoxelShadowsSoft, FarBlockerShadesLessThanANearOne)
{
    const auto darkest = [](float height) {
        SceneBuilder b;
        const int grey = b.material(lambert(0.5f));
        b.quad({-2, 0, 2}, {4, 0, 0}, {0, 0, -4}, grey);
        b.quad({-0.5f, height, 0.5f}, {1, 0, 0}, {0, 0, -1}, grey);
        b.quad({-2, 3.9f, -1.9f}, {0.2f, 0, 0}, {0, 0, -0.1f}, grey);  // the same bounds for both
        b.directional_light({0, -1, 0}, glm::vec3(1.0f));
        VoxelShadingParams params = shadows(VoxelShadows::soft_ray);
        params.soft_sharpness = 4.0f;
        const VoxelPipeline pipeline(b.build(), 64, params);
        float least = 1.0f;
        for (const LitFace& face : pipeline.faces())
            if (face.direction == 3 && face.mean.position.y < 2.0f) least = std::min(least, face.visibility);
        return least;
    };
    const float near = darkest(0.3f), far = darkest(3.0f);
    EXPECT_EQ(near, 0.0f);
    EXPECT_GT(far, 0.5f);
    EXPECT_LT(far, 0.99f);
}

}  // namespace
}  // namespace conebook
