// Hard cases "Filtering": what must hold at every level of the pyramids, whatever the filter's formulas.
#include <cmath>

#include <gtest/gtest.h>

#include "voxel_pipeline.hpp"

namespace conebook {
namespace {

// --- Walls ---

// A wall across the whole scene at x = 0, both sides, and two specks that make the bounds deeper than the wall.
Scene wall_scene(const glm::vec3& tilt = glm::vec3(0.0f))
{
    SceneBuilder b;
    Material wall = emitter({2.0f, 1.0f, 0.5f});
    wall.double_sided = true;
    b.quad(glm::vec3(0, -1, -1) - tilt, glm::vec3(0, 2, 0) + 2.0f * tilt, {0, 0, 2}, b.material(wall));
    const int black = b.material(lambert(0.5f));
    b.triangle({-1, -1, -1}, {-1, -0.999f, -1}, {-1, -1, -0.999f}, black);
    b.triangle({1, -1, -1}, {1, -0.999f, -1}, {1, -1, -0.999f}, black);
    return b.build();
}

TEST(Pyramid, WallIsOpaqueAcrossAndTransparentAlong)
{
    const VoxelPipeline pipeline(wall_scene(), 63);  // x = 0 lies within voxel 31
    for (int level = 0; level < pipeline.levels(); ++level) {
        const PyramidLevel stored = pipeline.level(level);
        const int wall_x = 31 >> level;
        for_each_voxel(stored, [&](int direction, const glm::ivec3& v) {
            // Coarse voxels at the ends of x also hold the specks; finer ones are left out there.
            const glm::dvec4 texel = stored.at(direction, v);
            const bool inside_bounds = v.y << level < 63 && v.z << level < 63;
            if (v.x != wall_x || !inside_bounds) return;
            if (direction < 2) {
                EXPECT_NEAR(texel.a, 1.0, 1e-3) << "level " << level;
                EXPECT_NEAR(texel.r, 2.0, 2e-3) << "level " << level;
            } else {
                EXPECT_LT(texel.a, 1e-3) << "level " << level;
            }
        });
    }
}

// A slanted wall shares each column between several voxels: together they cover it once, at every level.
TEST(Pyramid, SlantedWallCoversEachColumnOnce)
{
    const VoxelPipeline pipeline(wall_scene({0.45f, 0, 0}), 64);
    for (int level = 0; level < pipeline.levels(); ++level) {
        const PyramidLevel stored = pipeline.level(level);
        for (int direction = 0; direction < 2; ++direction)
            for (int z = 0; z << level < 64; ++z)
                for (int y = 0; y << level < 64; ++y) {
                    if (((y + 1) << level) <= 2 && ((z + 1) << level) <= 2) continue;  // the specks
                    double covered = 0.0;
                    for (int x = 0; x < stored.size.x; ++x) covered += stored.at(direction, {x, y, z}).a;
                    const bool speck = y == 0 && z == 0;
                    EXPECT_NEAR(covered, 1.0, speck ? 0.02 : 0.005) << "level " << level << " y " << y << " z " << z;
                }
    }
}

// --- Volumes and patterns: one square of one voxel's size in every voxel that `is_full` chooses ---

template <typename Choice>
Scene squares_scene(int n, const glm::vec3& radiance, Choice is_full)
{
    SceneBuilder b;
    const int material = b.material(emitter(radiance));
    const float last = float(n - 1);
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z) {
                if (!is_full(x, y, z)) continue;
                const glm::vec2 low = glm::max(glm::vec2(y, z) - 0.5f, 0.0f), high = glm::min(glm::vec2(y, z) + 0.5f, last);
                b.quad({float(x), low.x, low.y}, {0, high.x - low.x, 0}, {0, 0, high.y - low.y}, material);
            }
    Scene scene = b.build();
    scene.bounds = {glm::vec3(0.0f), glm::vec3(last)};
    return scene;
}

// Every texel of direction +x: `coverage` where `is_compared`, and the radiance of the squares.
template <typename Choice>
void expect_coverage(const VoxelPipeline& pipeline, int first_level, double coverage, Choice is_compared)
{
    for (int level = first_level; level < pipeline.levels(); ++level) {
        const PyramidLevel stored = pipeline.level(level);
        int compared = 0;
        for_each_voxel(stored, [&](int direction, const glm::ivec3& v) {
            const glm::dvec4 texel = stored.at(direction, v);
            if (direction != 1 || !is_compared(v, stored.size)) return;
            ++compared;
            EXPECT_NEAR(texel.a, coverage, 1e-3) << "level " << level;
            EXPECT_NEAR(texel.g, coverage * 3.0, 3e-3) << "level " << level;
        });
        EXPECT_GT(compared, 0) << "level " << level;
    }
}

TEST(Pyramid, OpaqueVolumeStaysOpaque)
{
    const VoxelPipeline pipeline(squares_scene(16, {1, 3, 5}, [](int, int, int) { return true; }), 16);
    expect_coverage(pipeline, 0, 1.0, [](const glm::ivec3&, const glm::ivec3&) { return true; });
}

TEST(Pyramid, CheckerboardWallIsHalfOpaque)
{
    const VoxelPipeline pipeline(squares_scene(32, {1, 3, 5}, [](int x, int y, int z) { return x == 9 && (y + z) % 2 == 0; }), 32);
    for (int level = 1; level < pipeline.levels() - 1; ++level) {
        const PyramidLevel stored = pipeline.level(level);
        for_each_voxel(stored, [&](int direction, const glm::ivec3& v) {
            // The outermost squares are halves, where the share differs.
            const bool border = v.y == 0 || v.z == 0 || v.y == stored.size.y - 1 || v.z == stored.size.z - 1;
            if (direction != 1 || v.x != 9 >> level || border) return;
            EXPECT_NEAR(stored.at(1, v).a, 0.5, 1e-3);
            EXPECT_NEAR(stored.at(1, v).g, 1.5, 2e-3);
        });
    }
}

// In three dimensions each column of two holds one full voxel: opaque from the second level on.
TEST(Pyramid, CheckerboardVolumeIsOpaqueFromTheFirstCoarseLevelOn)
{
    const VoxelPipeline pipeline(squares_scene(16, {1, 3, 5}, [](int x, int y, int z) { return (x + y + z) % 2 == 0; }), 16);
    expect_coverage(pipeline, 1, 1.0, [](const glm::ivec3&, const glm::ivec3&) { return true; });
}

// The front surface hides the one behind it: its light alone arrives.
TEST(Pyramid, FrontHidesBack)
{
    SceneBuilder b;
    b.quad({0, 0, 0}, {0, 15, 0}, {0, 0, 15}, b.material(emitter({0, 1, 0})));
    b.quad({1, 0, 0}, {0, 15, 0}, {0, 0, 15}, b.material(emitter({1, 0, 0})));   // in front for +x
    b.quad({14, 0, 0}, {0, 0, 15}, {0, 15, 0}, b.material(emitter({0, 0, 1})));  // in front for -x
    b.quad({15, 0, 0}, {0, 0, 15}, {0, 15, 0}, b.material(emitter({1, 1, 0})));
    const VoxelPipeline pipeline(b.build(), 16);
    const PyramidLevel level = pipeline.level(1);
    for (int y = 0; y < 8; ++y)
        for (int z = 0; z < 8; ++z) {
            EXPECT_NEAR(glm::distance(level.at(1, {0, y, z}), glm::dvec4(1, 0, 0, 1)), 0.0, 2e-3);
            EXPECT_NEAR(glm::distance(level.at(0, {7, y, z}), glm::dvec4(0, 0, 1, 1)), 0.0, 2e-3);
            EXPECT_EQ(level.at(0, {0, y, z}).a, 0.0);  // backs of one-sided walls do not cover
        }
}

// --- Padding: 10 : 1 : 1, N = 100 ---

TEST(Pyramid, PaddingHoldsNothingAndDarkensNothing)
{
    SceneBuilder b;
    b.box({0, 0, 0}, {10, 1, 1}, b.material(emitter(7.0f)), true);
    const VoxelPipeline pipeline(b.build(), 100);
    const shared::GridData& grid = pipeline.grid();
    EXPECT_LE(grid.size.y, 64);
    int padded = 0;
    for (int level = 0; level < pipeline.levels(); ++level) {
        const PyramidLevel stored = pipeline.level(level);
        for_each_voxel(stored, [&](int direction, const glm::ivec3& v) {
            const glm::dvec4 texel = stored.at(direction, v);
            const glm::vec3 low = glm::vec3(v) * float(1 << level);
            if (glm::any(glm::greaterThan(low, glm::vec3(grid.content_max)))) {
                ++padded;
                ASSERT_EQ(texel, glm::dvec4(0.0));
            }
            if (texel.a > 1e-3) {
                ASSERT_NEAR(texel.r / texel.a, 7.0, 0.02);
            }
            // Walls at the ends of each axis are whole at every level, although half of their coarse voxels lies outside.
            const int axis = direction / 2;
            const int wall = int(direction % 2 == 1 ? grid.content_min[axis] : grid.content_max[axis]) >> level;
            if (v[axis] == wall && glm::all(glm::lessThan(low, glm::vec3(grid.content_max)))) {
                ASSERT_NEAR(texel.a, 1.0, 2e-3) << "level " << level << " direction " << direction;
            }
        });
    }
    EXPECT_GT(padded, 1000);
}

}  // namespace
}  // namespace conebook
