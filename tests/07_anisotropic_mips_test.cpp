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

// What a direction of the finest level sees of a face: its projected area. Where the six hold the same, it is that of the
// direction that the face looks to most.
PyramidLevel base_on_cpu(const VoxelPipeline& pipeline, Directions directions)
{
    const glm::ivec3 size(pipeline.grid().size);
    PyramidLevel level{size, std::vector<glm::dvec4>(6 * std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z))};
    for (const LitFace& face : pipeline.faces())
        for (int direction = 0; direction < 6; ++direction) {
            const glm::dvec3 n(face.mean.normal), a = glm::abs(n);
            const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
            const int seen_from = directions == Directions::per_face ? direction : 2 * axis + (n[axis] > 0.0 ? 1 : 0);
            const double cosine = std::max(seen_from % 2 == 1 ? n[seen_from / 2] : -n[seen_from / 2], 0.0);
            level.at(direction, face.voxel) += double(face.mean.albedo_area.a) * cosine /
                                               column_weight(pipeline.grid(), face.voxel, seen_from, 0) *
                                               glm::dvec4(glm::dvec3(face.radiance), 1.0);
        }
    for_each_voxel(level, [&](int direction, const glm::ivec3& v) {
        glm::dvec4& texel = level.at(direction, v);
        texel /= std::max(texel.a, 1.0);
    });
    return level;
}

// The mean of the eight children, weighted with what of them lies within the bounds.
PyramidLevel mean_of_eight_on_cpu(const shared::GridData& grid, const PyramidLevel& finer, int level)
{
    const glm::ivec3 size = finer.size / 2;
    PyramidLevel next{size, std::vector<glm::dvec4>(6 * std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z))};
    for_each_voxel(next, [&](int direction, const glm::ivec3& v) {
        glm::dvec4 sum(0.0);
        double weights = 0.0;
        for (int i = 0; i < 8; ++i) {
            const glm::ivec3 child = 2 * v + glm::ivec3(i % 2, i / 2 % 2, i / 4);
            double weight = 1.0;
            for (int axis = 0; axis < 3; ++axis) weight *= inside_share(grid, child, axis, level - 1);
            sum += weight * finer.at(direction, child);
            weights += weight;
        }
        next.at(direction, v) = sum / weights;
    });
    return next;
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

class Filter : public testing::TestWithParam<Directions> {};

TEST_P(Filter, EveryLevelAndDirectionIsTheDoublePrecisionOne)
{
    PyramidParams params;
    params.directions = GetParam();
    const VoxelPipeline pipeline(mixed_scene(), 50, {}, params);
    PyramidLevel finer = pipeline.level(0);
    EXPECT_LT(difference_in_units(finer, base_on_cpu(pipeline, GetParam())), kHalfUnits);
    ASSERT_EQ(pipeline.levels(), 5);
    for (int level = 1; level < pipeline.levels(); ++level) {
        const PyramidLevel stored = pipeline.level(level);
        ASSERT_EQ(stored.size, finer.size / 2);
        const PyramidLevel expected = GetParam() == Directions::isotropic
                                          ? mean_of_eight_on_cpu(pipeline.grid(), finer, level)
                                          : next_on_cpu(pipeline.grid(), finer, level);
        EXPECT_LT(difference_in_units(stored, expected), kHalfUnits) << "level " << level;
        finer = stored;
    }
}
INSTANTIATE_TEST_SUITE_P(Pyramids, Filter,
                         testing::Values(Directions::per_face, Directions::anisotropic, Directions::isotropic),
                         [](const auto& info) {
                             return std::string(info.param == Directions::per_face      ? "per_face"
                                                : info.param == Directions::anisotropic ? "anisotropic"
                                                                                        : "isotropic");
                         });

// anisotropic: the six directions agree at the finest level and nowhere else; isotropic: at all levels.
class OneValue : public testing::TestWithParam<Directions> {};

TEST_P(OneValue, IsTheSameFromAllSides)
{
    PyramidParams params;
    params.directions = GetParam();
    const VoxelPipeline pipeline(mixed_scene(), 50, {}, params);
    for (int level = 0; level < pipeline.levels() - 1; ++level) {
        const PyramidLevel stored = pipeline.level(level);
        std::size_t covered = 0, different = 0;
        for_each_voxel(stored, [&](int direction, const glm::ivec3& v) {
            if (stored.at(0, v).a > 0.0) ++covered;
            if (stored.at(direction, v) != stored.at(0, v)) ++different;
        });
        EXPECT_GT(covered, 0u);
        EXPECT_EQ(different > 0, GetParam() == Directions::anisotropic && level > 0) << "level " << level;
    }
}
INSTANTIATE_TEST_SUITE_P(Pyramids, OneValue, testing::Values(Directions::anisotropic, Directions::isotropic),
                         [](const auto& info) {
                             return std::string(info.param == Directions::isotropic ? "isotropic" : "anisotropic");
                         });

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
