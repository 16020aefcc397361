// Chapter 07: the filter against the same formulas in double precision on the CPU, level by level from what the GPU
// stored one level below; and the power, which the filter must keep. Walls and padding: hard_cases/filtering_test.cpp.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "voxel_pipeline.hpp"

namespace conebook {
namespace {

// Distance between neighbouring half-float values around `value` (IEEE 754 binary16: 11 bits, smallest 2^-24).
double half_unit(double value)
{
    int exponent;
    std::frexp(std::abs(value), &exponent);
    return std::ldexp(1.0, std::max(exponent - 11, -24));
}

// The stored value is the nearest half or, at worst, the result of a float whose last bits fell to the other side.
constexpr double kHalfUnits = 0.5 + 1e-2;

double inside_share(const shared::GridData& grid, const glm::ivec3& voxel, int axis, int level)
{
    const double size = double(1 << level), low = double(voxel[axis]) * size;
    const double inside = std::min(low + size, double(grid.content_max[axis])) - std::max(low, double(grid.content_min[axis]));
    return std::clamp(inside / size, 1e-6, 1.0);
}
double column_weight(const shared::GridData& grid, const glm::ivec3& voxel, int direction, int level)
{
    const int axis = direction / 2;
    return inside_share(grid, voxel, (axis + 1) % 3, level) * inside_share(grid, voxel, (axis + 2) % 3, level);
}

// --- The same formulas on the CPU ---

PyramidLevel base_on_cpu(const VoxelPipeline& pipeline, bool isotropic)
{
    const glm::ivec3 size(pipeline.grid().size);
    PyramidLevel level{size, std::vector<glm::dvec4>(6 * std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z))};
    for (const LitFace& face : pipeline.faces())
        for (int direction = 0; direction < 6; ++direction) {
            const glm::dvec3 n(face.mean.normal), a = glm::abs(n);
            const double towards = direction % 2 == 1 ? n[direction / 2] : -n[direction / 2];
            const double cosine = isotropic ? std::max({a.x, a.y, a.z}) : std::max(towards, 0.0);
            level.at(direction, face.voxel) +=
                double(face.mean.albedo_area.a) * cosine * glm::dvec4(glm::dvec3(face.radiance), 1.0);
        }
    for_each_voxel(level, [&](int direction, const glm::ivec3& v) {
        glm::dvec4& texel = level.at(direction, v);
        texel /= column_weight(pipeline.grid(), v, direction, 0);
        texel = glm::min(texel / std::max(texel.a, 1.0), glm::dvec4(65504.0));
    });
    return level;
}

PyramidLevel next_on_cpu(const shared::GridData& grid, const PyramidLevel& finer, int level)
{
    const glm::ivec3 size = finer.size / 2;
    PyramidLevel next{size, std::vector<glm::dvec4>(6 * std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z))};
    for_each_voxel(next, [&](int direction, const glm::ivec3& v) {
        const int axis = direction / 2;
        glm::dvec4 sum(0.0);
        double weights = 0.0;
        for (int column = 0; column < 4; ++column) {
            glm::ivec3 lower = 2 * v;
            lower[(axis + 1) % 3] += column % 2;
            lower[(axis + 2) % 3] += column / 2;
            glm::ivec3 upper = lower;
            upper[axis] += 1;
            const glm::dvec4 front = finer.at(direction, direction % 2 == 1 ? upper : lower);
            const glm::dvec4 back = finer.at(direction, direction % 2 == 1 ? lower : upper);
            const double weight = column_weight(grid, lower, direction, level - 1);
            sum += weight * (front + (back.a > 0.0 ? std::min((1.0 - front.a) / back.a, 1.0) : 0.0) * back);
            weights += weight;
        }
        next.at(direction, v) = sum / weights;
    });
    return next;
}

// Largest difference in units of the stored half floats.
double difference_in_units(const PyramidLevel& stored, const PyramidLevel& expected)
{
    double worst = 0.0;
    for (std::size_t i = 0; i < stored.texels.size(); ++i)
        for (int c = 0; c < 4; ++c)
            worst = std::max(worst, std::abs(stored.texels[i][c] - expected.texels[i][c]) / half_unit(expected.texels[i][c]));
    return worst;
}

// Slanted, curved, overlapping, thin, bright and dark surfaces; no side of the scene is a multiple of another.
Scene mixed_scene(float length = 1.0f)
{
    SceneBuilder b;
    const int red = b.material(lambert({0.8f, 0.2f, 0.1f})), grey = b.material(lambert(0.5f));
    Material sheet = lambert({0.2f, 0.6f, 0.3f});
    sheet.double_sided = true;
    b.box({-1.0f * length, -0.7f, -0.8f}, {1.0f * length, 0.7f, 0.8f}, grey, true);
    b.sphere({0.2f, -0.1f, 0.15f}, 0.4f, red, 24);
    b.quad({-0.8f, -0.6f, 0.5f}, {0.9f, 0.5f, -0.3f}, {0.1f, 0.6f, 0.4f}, b.material(sheet));
    b.quad({-0.5f, 0.65f, 0.2f}, {0.3f, 0, 0}, {0, 0, 0.3f}, b.material(emitter({50.0f, 40.0f, 30.0f})));
    b.quad({0.5f, -0.5f, 0.2f}, {0.2f, 0, 0}, {0, 0.2f, 0.1f}, b.material(emitter(1e-3f)));
    b.point_light({0.1f, 0.5f, -0.3f}, glm::vec3(2.0f));
    b.directional_light({-0.3f, -1.0f, 0.2f}, glm::vec3(1.0f));
    return b.build();
}

class Filter : public testing::TestWithParam<bool> {};

TEST_P(Filter, EveryLevelAndDirectionIsTheDoublePrecisionOne)
{
    PyramidParams params;
    params.isotropic = GetParam();
    const VoxelPipeline pipeline(mixed_scene(), 50, {}, params);
    PyramidLevel finer = pipeline.level(0);
    EXPECT_LT(difference_in_units(finer, base_on_cpu(pipeline, params.isotropic)), kHalfUnits);
    ASSERT_EQ(pipeline.levels(), 5);
    for (int level = 1; level < pipeline.levels(); ++level) {
        const PyramidLevel stored = pipeline.level(level);
        ASSERT_EQ(stored.size, finer.size / 2);
        EXPECT_LT(difference_in_units(stored, next_on_cpu(pipeline.grid(), finer, level)), kHalfUnits) << "level " << level;
        finer = stored;
    }
}
INSTANTIATE_TEST_SUITE_P(Pyramids, Filter, testing::Bool(),
                         [](const auto& info) { return info.param ? std::string("isotropic") : std::string("anisotropic"); });

TEST(Pyramid, IsotropicBaseIsTheSameFromAllSides)
{
    PyramidParams params;
    params.isotropic = true;
    SceneBuilder b;
    b.sphere({}, 1.0f, b.material(emitter(2.0f)));
    const VoxelPipeline pipeline(b.build(), 32, {}, params);
    const PyramidLevel base = pipeline.level(0);
    int interior = 0;
    for (const LitFace& face : pipeline.faces()) {
        // Weights differ at the border of the bounds only.
        if (glm::any(glm::lessThan(face.voxel, glm::ivec3(1))) || glm::any(glm::greaterThan(face.voxel, glm::ivec3(30)))) continue;
        ++interior;
        for (int direction = 1; direction < 6; ++direction)
            EXPECT_EQ(base.at(direction, face.voxel), base.at(0, face.voxel));
    }
    EXPECT_GT(interior, 1000);
}

// --- Sum over all voxels of coverage x radiance x area: the power that leaves towards each side ---

glm::dvec4 power(const VoxelPipeline& pipeline, int level, int direction)
{
    const PyramidLevel stored = pipeline.level(level);
    glm::dvec4 sum(0.0);
    for_each_voxel(stored, [&](int d, const glm::ivec3& v) {
        if (d == direction) sum += stored.at(d, v) * column_weight(pipeline.grid(), v, d, level);
    });
    return sum * std::ldexp(1.0, 2 * level);
}

TEST(Pyramid, PowerIsKeptWhereNothingOverlaps)
{
    SceneBuilder b;  // none hides another, seen along any axis
    b.quad({-1.0f, -1.0f, -1.0f}, {0.5f, 0, 0}, {0, 0.4f, 0.4f}, b.material(emitter({1.0f, 0.1f, 3.0f})));
    b.quad({-0.3f, -0.3f, -0.3f}, {0.3f, 0.1f, 0}, {-0.1f, 0.3f, 0.2f}, b.material(emitter({200.0f, 2.0f, 0.01f})));
    b.sphere({0.6f, 0.6f, 0.6f}, 0.4f, b.material(emitter({0.3f, 0.4f, 0.5f})), 32);
    const VoxelPipeline pipeline(b.build(), 64);
    for (int direction = 0; direction < 6; ++direction) {
        // What the faces send that way: sum of projected area times radiance.
        glm::dvec4 sent(0.0);
        for (const LitFace& face : pipeline.faces()) {
            const double n = double(face.mean.normal[direction / 2]);
            sent += double(face.mean.albedo_area.a) * std::max(direction % 2 == 1 ? n : -n, 0.0) *
                    glm::dvec4(glm::dvec3(face.radiance), 1.0);
        }
        for (int level = 0; level < pipeline.levels(); ++level) {
            const glm::dvec4 kept = power(pipeline, level, direction);
            for (int c = 0; c < 4; ++c)
                EXPECT_NEAR(kept[c], sent[c], 0.01 * sent[c]) << "level " << level << " direction " << direction;
        }
    }
}

}  // namespace
}  // namespace conebook
