// Chapter 04 in the small: shapes whose voxels can be counted by hand, the levels, the view, the program.
#include <gtest/gtest.h>

#include <cmath>

#include "program.hpp"
#include "soup_pipeline.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"
#include "voxel_oracle.hpp"

namespace conebook {
namespace {

std::size_t count_occupied(const std::vector<GLuint>& masks)
{
    std::size_t count = 0;
    for (const GLuint mask : masks) count += mask != 0u;
    return count;
}

TEST(Grid, OutermostSurfacesLieInsideTheOutermostVoxels)
{
    for (const int voxels : {4, 64, 100, 128, 511, 512})
        for (const glm::vec3 extent : {glm::vec3(2.0f), glm::vec3(10.0f, 1.0f, 1.0f), glm::vec3(1.0f, 3.7f, 0.0f)}) {
            const Bounds bounds{glm::vec3(-3.0f), glm::vec3(-3.0f) + extent};
            const shared::GridData grid = make_grid(bounds, {voxels});
            const float side = grid.origin.w;
            EXPECT_NEAR(bounds.longest_side() / side, float(voxels - 1), 1e-3f * float(voxels));
            for (int axis = 0; axis < 3; ++axis) {
                const float low = (bounds.min[axis] - grid.origin[axis]) / side, high = (bounds.max[axis] - grid.origin[axis]) / side;
                EXPECT_NEAR(low, grid.content_min[axis], 1e-3f);
                EXPECT_NEAR(high, grid.content_max[axis], 1e-3f);
                EXPECT_GT(low, 0.3f);  // a third of a voxel from the nearest side at least
                EXPECT_LT(low, 0.9f);
                EXPECT_GT(std::ceil(high) - high, 0.1f);
                EXPECT_LE(std::ceil(high), float(grid.size[axis]));
                EXPECT_LE(grid.size[axis], 512 + 64);
                EXPECT_EQ(grid.size[axis] % (1 << (grid.size.w - 1)), 0);
            }
        }
}

TEST(Grid, NineBitsHoldEveryVoxelOfAScene)
{
    // Lists pack a voxel into 9 bits an axis. The padding beyond 512 is never occupied.
    for (const int voxels : {511, 512}) {
        const shared::GridData grid = make_grid({glm::vec3(0.0f), glm::vec3(1.0f)}, {voxels});
        for (int axis = 0; axis < 3; ++axis) EXPECT_LT(grid.content_max[axis], 512.0f);
    }
}

// Six pyramids side by side are wider than a 3D texture may be. `what` is in the message, and what it offers works.
TEST(Grid, TooManyVoxelsAreRefusedByName)
{
    test_gl();
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    const Bounds bounds{glm::vec3(0.0f), glm::vec3(1.0f)};
    EXPECT_EQ(VoxelGrid(bounds, {512}).size(), glm::ivec3(512));
    const int volumes = most / 512 + 1;
    try {
        VoxelGrid(bounds, {512}, volumes);
        FAIL() << "not refused";
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find("voxels=512: "), 0u) << message;
        EXPECT_NE(message.find(std::to_string(most)), std::string::npos) << message;
        const std::size_t offer = message.rfind("voxels=") + 7;
        const VoxelGrid grid(bounds, {std::stoi(message.substr(offer))}, volumes);
        EXPECT_LE(grid.size().x * volumes, most);
        EXPECT_THROW(VoxelGrid(bounds, {std::stoi(message.substr(offer)) + 1}, volumes), std::runtime_error);
    }
}

TEST(Voxelizer, RectangleInTheMiddleOfVoxels)
{
    for (int axis = 0; axis < 3; ++axis)
        for (const bool flipped : {false, true})
            for (const bool double_sided : {false, true}) {
                SceneBuilder builder;
                Material material = lambert(0.5f);
                material.double_sided = double_sided;
                glm::vec3 corner(3.25f), u(0.0f), v(0.0f);
                corner[axis] = 7.5f;
                u[(axis + 1) % 3] = 5.0f;
                v[(axis + 2) % 3] = 9.0f;
                if (flipped) std::swap(u, v);
                builder.quad(corner, u, v, builder.material(material));
                SoupPipeline pipeline(builder.build(), unit_bounds(32), 32);
                pipeline.voxelize();
                const auto marked = pipeline.occupancy();
                EXPECT_EQ(count_occupied(marked), 6u * 10u);
                const int face = 2 * axis + (flipped ? 0 : 1);  // the direction of cross(u, v)
                const GLuint mask = 1u << face | (double_sided ? 1u << (face ^ 1) : 0u);
                const glm::ivec3 size = pipeline.grid().size();
                for (int z = 0; z < size.z; ++z)
                    for (int y = 0; y < size.y; ++y)
                        for (int x = 0; x < size.x; ++x) {
                            const glm::ivec3 voxel(x, y, z);
                            const int a = voxel[(axis + 1) % 3], b = voxel[(axis + 2) % 3];
                            const bool inside = voxel[axis] == 7 && a >= 3 && a <= 8 && b >= 3 && b <= 12;
                            ASSERT_EQ(marked[std::size_t(x + size.x * (y + size.y * z))], inside ? mask : 0u);
                        }
            }
}

TEST(Voxelizer, ClosedSphereIsTight)
{
    // No ray from outside reaches the centre without crossing a marked voxel, not even through corners: the empty
    // voxels that are connected to the middle by shared sides, edges or corners never touch the grid's border.
    SceneBuilder builder;
    builder.sphere(glm::vec3(0.0f), 1.0f, builder.material(lambert(0.5f)), 32);
    for (const Voxelizer voxelizer : {Voxelizer::raster, Voxelizer::compute})
        for (const int voxels : {16, 61}) {
            const Scene scene = builder.build();
            SoupPipeline pipeline(scene, scene.bounds, voxels, voxelizer);
            pipeline.voxelize();
            const auto marked = pipeline.occupancy();
            const glm::ivec3 size = pipeline.grid().size();
            const auto at = [&](glm::ivec3 v) { return std::size_t(v.x + size.x * (v.y + size.y * v.z)); };
            const glm::ivec3 middle(glm::vec3(0.5f * (pipeline.grid().data().content_min + pipeline.grid().data().content_max)));
            ASSERT_EQ(marked[at(middle)], 0u);
            std::vector<char> seen(marked.size(), 0);
            std::vector<glm::ivec3> open = {middle};
            seen[at(middle)] = 1;
            bool leaks = false;
            while (!open.empty() && !leaks) {
                const glm::ivec3 v = open.back();
                open.pop_back();
                for (int i = 0; i < 27; ++i) {
                    const glm::ivec3 next = v + glm::ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
                    leaks = leaks || glm::any(glm::lessThan(next, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(next, size));
                    if (leaks || seen[at(next)] || marked[at(next)] != 0u) continue;
                    seen[at(next)] = 1;
                    open.push_back(next);
                }
            }
            EXPECT_FALSE(leaks) << voxels;
        }
}

TEST(Voxelizer, CoarserLevelsHoldWhatTheirChildrenHold)
{
    std::mt19937 random(21);
    const Scene scene = triangle_soup(random_triangles(random, 200, unit_bounds(40), 0.1f, 20.0f));
    for (const int voxels : {4, 40}) {
        SoupPipeline pipeline(scene, voxels);
        pipeline.voxelize();
        const gl::Texture& occupancy = pipeline.voxelizer().occupancy();
        for (int level = 1; level < pipeline.grid().levels(); ++level) {
            const glm::ivec3 fine_size = pipeline.grid().size() >> (level - 1), size = pipeline.grid().size() >> level;
            const auto fine = gl::read_uints(occupancy, level - 1), coarse = gl::read_uints(occupancy, level);
            std::vector<GLuint> expected(coarse.size(), 0u);
            for (int z = 0; z < fine_size.z; ++z)
                for (int y = 0; y < fine_size.y; ++y)
                    for (int x = 0; x < fine_size.x; ++x)
                        expected[std::size_t(x / 2 + size.x * (y / 2 + size.y * (z / 2)))] |=
                            fine[std::size_t(x + fine_size.x * (y + fine_size.y * z))];
            EXPECT_EQ(coarse, expected) << level;
            EXPECT_GT(count_occupied(coarse), 0u);
        }
    }
}

TEST(Voxelizer, FragmentsArePairsOfTriangleAndVoxel)
{
    std::mt19937 random(22);
    const Scene scene = triangle_soup(random_triangles(random, 500, unit_bounds(32), 0.1f, 10.0f));
    const GpuScene gpu_scene((test_gl(), scene));
    const VoxelGrid grid(scene.bounds, {32});
    for (const Voxelizer kind : {Voxelizer::raster, Voxelizer::compute}) {
        ConservativeVoxelizer voxelizer(test_gl().shaders);
        voxelizer.run(gpu_scene, grid, {kind, true, true});
        std::size_t sum = 0;
        const auto counts = gl::read_uints(voxelizer.fragment_counts()), masks = gl::read_uints(voxelizer.occupancy());
        for (std::size_t i = 0; i < counts.size(); ++i) {
            sum += counts[i];
            ASSERT_EQ(counts[i] != 0u, masks[i] != 0u);
        }
        EXPECT_EQ(sum, voxelizer.fragments().count());
        EXPECT_GT(sum, 4u * 500u);  // more than the first guess: the list was made longer
        auto listed = std::vector<GLuint>(counts.size(), 0u);
        const auto list = voxelizer.fragments().buffer().read<glm::uvec2>();
        for (std::size_t i = 0; i < sum; ++i) {
            const GLuint p = list[i].y;
            const std::size_t row = (p >> 9 & 511u) + std::size_t(grid.size().y) * (p >> 18 & 511u);
            ++listed[(p & 511u) + std::size_t(grid.size().x) * row];
        }
        EXPECT_EQ(listed, counts);
    }
}

TEST(VoxelView, CubesHaveTheirSize)
{
    // One voxel, (5, 9, 7), seen along -z by a parallel camera of 16 x 16 m: 16 pixels a metre.
    SceneBuilder builder;
    builder.quad({5.2f, 9.2f, 7.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}, builder.material(lambert(0.5f)));
    SoupPipeline pipeline(builder.build(), unit_bounds(16), 16);
    pipeline.voxelize();
    VoxelViewPass view(test_gl().shaders);
    const Camera camera = look_at_orthographic({8, 8, 40}, {8, 8, 0}, 8.0f, 8.0f);
    const gl::Buffer camera_buffer("camera", std::vector{camera_data(camera, {256, 256}, unit_bounds(16))});
    for (const int level : {0, 1, 2}) {
        VoxelViewParams params;
        params.level = level;
        const ImageF image = read_picture(view.run(pipeline.grid(), pipeline.voxelizer().occupancy(), params, camera_buffer, {256, 256}));
        const int side = 16 << level, left = 5 * 16 / side * side, bottom = 9 * 16 / side * side;
        for (int y = 0; y < 256; ++y)
            for (int x = 0; x < 256; ++x) {
                const int up = 255 - y;
                const bool inside = x >= left && x < left + side && up >= bottom && up < bottom + side;
                ASSERT_EQ(image.at(x, y).a, inside ? 1.0f : 0.0f) << level << ": " << x << ", " << up;
            }
    }
}

TEST(Program04, CountsAndHoles)
{
    if (program_folder().empty()) GTEST_SKIP() << "CONEBOOK_BIN is not set";
    const TemporaryFolder folder;
    const auto run = [&](const std::string& set) {
        const ProgramRun result = run_program("04_conservative_voxelization",
                                              "--headless --size 64x64 --set voxels=64 " + set + " --output '" +
                                                  (folder / "a.png").string() + "' --stats '" + (folder / "a.json").string() + "'");
        EXPECT_EQ(result.code, 0) << result.output;
        return read_statistics(folder / "a.json");
    };
    const auto raster = run("voxelizer=raster"), compute = run(""), plain = run("voxelizer=raster conservative=off");
    for (const std::string name : {"occupied voxels", "fragments", "most fragments in a voxel"})
        EXPECT_EQ(count_of(raster, name), count_of(compute, name));
    EXPECT_LT(count_of(plain, "occupied voxels"), count_of(raster, "occupied voxels"));
    EXPECT_GT(count_of(plain, "occupied voxels"), 0.5 * count_of(raster, "occupied voxels"));
    EXPECT_GE(count_of(raster, "most fragments in a voxel"), count_of(raster, "fragments per occupied voxel"));

    const ProgramRun refused = run_program("04_conservative_voxelization",
                                           "--headless --set conservative=off --output '" +
                                               (folder / "b.png").string() + "'");
    EXPECT_GT(refused.code, 0);
    EXPECT_NE(refused.output.find("conservative=off"), std::string::npos) << refused.output;
    EXPECT_FALSE(std::filesystem::exists(folder / "b.png"));
}

}  // namespace
}  // namespace conebook
