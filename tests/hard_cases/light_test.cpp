// Hard cases "Light", on voxels: lights inside a wall's voxel, very near, without power, and a spot at its cutoff.
#include <cmath>

#include <gtest/gtest.h>

#include "voxel_pipeline.hpp"

namespace conebook {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr int kVoxels = 32;
constexpr float kVoxel = 2.0f / (kVoxels - 1);  // m

Scene room_with(const Light& light, bool inward = true)
{
    SceneBuilder b;
    b.box(glm::vec3(-1), glm::vec3(1), b.material(lambert(0.5f)), inward);
    Scene scene = b.build();
    scene.lights = {light};
    return scene;
}

Light point(glm::vec3 position, float intensity = 1.0f)
{
    Light light;
    light.position = position;
    light.intensity = glm::vec3(intensity);
    return light;
}

void expect_finite(const VoxelPipeline& pipeline)
{
    for (const LitFace& face : pipeline.faces())
        for (int c = 0; c < 3; ++c) {
            ASSERT_TRUE(std::isfinite(face.radiance[c]));
            ASSERT_GE(face.radiance[c], 0.0f);
        }
    for (int level = 0; level < pipeline.levels(); ++level)
        for (const glm::dvec4& texel : pipeline.level(level).texels)
            for (int c = 0; c < 4; ++c) ASSERT_TRUE(std::isfinite(texel[c])) << "level " << level;
}

class NearLight : public testing::TestWithParam<float> {};

// The other walls, three voxels and more away, are lit as if nothing were special.
TEST_P(NearLight, IsFiniteAndTheRestIsExact)
{
    const glm::vec3 position(0.13f, -1.0f + GetParam(), 0.21f);
    const VoxelPipeline pipeline(room_with(point(position)), kVoxels);
    expect_finite(pipeline);
    int compared = 0;
    for (const LitFace& face : pipeline.faces()) {
        const glm::dvec3 p = pipeline.scene_from_grid(glm::dvec3(face.mean.position));
        const glm::dvec3 s = glm::dvec3(position) - p, n(face.mean.normal);
        const double d = glm::length(s), cosine = glm::dot(s, n) / d;
        // Voxels in edges and corners of the room hold parts of walls that the others hide from the half voxel's step.
        const glm::dvec3 a = glm::abs(p);
        const bool corner = (a.x > 1.0 - 2.0 * kVoxel) + (a.y > 1.0 - 2.0 * kVoxel) + (a.z > 1.0 - 2.0 * kVoxel) > 1;
        if (d < 3.0 * kVoxel || cosine < 0.05 || corner || face.mean.albedo_area.a < 1e-3f) continue;
        ++compared;
        EXPECT_NEAR(face.radiance.x, 0.5 / kPiD * cosine / (d * d), 0.005 * 0.5 / kPiD * cosine / (d * d));
    }
    EXPECT_GT(compared, 3000);
}
INSTANTIATE_TEST_SUITE_P(Distance, NearLight, testing::Values(0.3f * kVoxel, 0.02f * kVoxel, 1e-4f));

// At the very point where a face is lit, where the distance is 0; and in an edge and a corner of the room.
TEST(VoxelLight, OnTheSurfaceItselfIsFinite)
{
    const VoxelPipeline dark(room_with(point({0, 0, 0}, 0.0f)), kVoxels);
    const std::vector<LitFace> faces = dark.faces();
    for (const std::size_t i : {faces.size() / 5, faces.size() / 2, faces.size() - 40}) {
        const glm::vec3 position = glm::vec3(faces[i].mean.position) * dark.grid().origin.w + glm::vec3(dark.grid().origin);
        expect_finite(VoxelPipeline(room_with(point(position)), kVoxels));
    }
    for (const glm::vec3 position : {glm::vec3(0, -1, -1), glm::vec3(-1, -1, -1)})
        expect_finite(VoxelPipeline(room_with(point(position)), kVoxels));
}

TEST(VoxelLight, HugeIntensityStaysFiniteInThePyramid)
{
    expect_finite(VoxelPipeline(room_with(point({0, -1 + 1e-4f, 0}, 1e6f)), kVoxels));
}

TEST(VoxelLight, ZeroIntensityIsBlackForEveryType)
{
    for (const LightType type : {LightType::directional, LightType::point, LightType::spot}) {
        Light light = point({0, 0.5f, 0}, 0.0f);
        light.type = type;
        light.direction = {0, -1, 0};
        const VoxelPipeline pipeline(room_with(light), kVoxels);
        ASSERT_GT(pipeline.faces().size(), 5000u);
        for (const LitFace& face : pipeline.faces()) ASSERT_EQ(face.radiance, glm::vec3(0.0f));
    }
}

// Over the cutoff the light goes to 0 without a step, even where inner and outer cone are the same.
TEST(VoxelLight, SpotEndsContinuouslyAtItsCutoff)
{
    Light light = point({0, 0.9f, 0});
    light.type = LightType::spot;
    light.direction = {0, -1, 0};
    light.inner_cone_angle = 0.2f;
    light.outer_cone_angle = 0.45f;
    SceneBuilder b;
    b.quad({-1, -1, 1}, {2, 0, 0}, {0, 0, -2}, b.material(lambert(0.5f)));
    Scene scene = b.build();
    scene.lights = {light};
    const double middle = 0.5 / kPiD / (1.9 * 1.9), radius = 1.9 * std::tan(0.45);
    double at_edge = 0.0, beyond = 0.0, inside = 0.0;
    const VoxelPipeline pipeline(scene, 128);
    const double voxel = double(pipeline.grid().origin.w);
    for (const LitFace& face : pipeline.faces()) {
        const glm::dvec3 p = pipeline.scene_from_grid(glm::dvec3(face.mean.position));
        const double r = std::hypot(p.x, p.z), value = double(face.radiance.x) / middle;
        if (r > radius) beyond = std::max(beyond, value);
        if (r <= radius && r > radius - voxel) at_edge = std::max(at_edge, value);
        if (r < voxel) inside = std::max(inside, value);
    }
    // The falloff is the square of (cos - cos_outer) / (cos_inner - cos_outer): one voxel inside, that is under 0.5 %.
    const double c = std::cos(std::atan((radius - voxel) / 1.9));
    const double edge = (c - std::cos(0.45)) / (std::cos(0.2) - std::cos(0.45));
    EXPECT_EQ(beyond, 0.0);
    EXPECT_LE(at_edge, edge * edge);
    EXPECT_GT(at_edge, 0.0);
    EXPECT_NEAR(inside, 1.0, 0.005);

    light.inner_cone_angle = light.outer_cone_angle = 0.45f;
    scene.lights = {light};
    expect_finite(VoxelPipeline(scene, kVoxels));
}

}  // namespace
}  // namespace conebook
