// Chapter 05 in the small: the lists, means that can be written down, the view, the program.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "05_atomic_averaging/naive_average.hpp"
#include "program.hpp"
#include "soup_pipeline.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

TEST(Lists, HoldEveryOccupiedVoxelOnce)
{
    std::mt19937 random(31);
    for (const int voxels : {4, 7, 33, 64}) {
        Material material = lambert(0.5f);
        material.double_sided = voxels == 33;
        const Scene scene = triangle_soup(random_triangles(random, 300, unit_bounds(voxels), 0.1f, 0.3f * float(voxels)), material);
        SoupPipeline pipeline(scene, voxels);
        for (int frame = 0; frame < 2; ++frame) {
            pipeline.average();
            const auto masks = pipeline.occupancy(), entries = gl::read_uints(pipeline.voxel_faces().face_index());
            const glm::ivec3 size = pipeline.grid().size();
            auto voxel_list = pipeline.voxel_faces().voxel_list().read<GLuint>();
            const auto face_list = pipeline.face_list();
            std::size_t occupied = 0, faces = 0;
            for (const GLuint mask : masks) {
                occupied += mask != 0u;
                faces += std::size_t(std::popcount(mask));
            }
            ASSERT_EQ(pipeline.voxel_faces().voxel_count(), occupied);
            ASSERT_EQ(pipeline.voxel_faces().face_count(), faces);
            voxel_list.resize(occupied);
            std::vector<char> seen(masks.size(), 0);
            std::size_t place = 0;
            for (const GLuint packed : voxel_list) {
                const glm::ivec3 v(packed & 511u, packed >> 9 & 511u, packed >> 18 & 511u);
                const std::size_t i = std::size_t(v.x + size.x * (v.y + size.y * v.z));
                ASSERT_NE(masks[i], 0u);
                ASSERT_EQ(seen[i]++, 0);
                ASSERT_EQ(entries[i], GLuint(place << 6) | masks[i]);  // faces in the order of the voxels
                for (GLuint face = 0; face < 6; ++face) {
                    if ((masks[i] & 1u << face) == 0u) continue;
                    ASSERT_EQ(face_list[place++], packed | face << 27);
                }
            }
            EXPECT_EQ(place, faces);
            for (std::size_t i = 0; i < masks.size(); ++i) ASSERT_TRUE(masks[i] != 0u || entries[i] == 0u);
            // Indirect dispatches cover the lists.
            EXPECT_EQ(pipeline.voxel_faces().face_groups().read<GLuint>(), (std::vector<GLuint>{GLuint(faces + 63) / 64, 1, 1}));
            EXPECT_EQ(pipeline.voxel_faces().voxel_groups().read<GLuint>(), (std::vector<GLuint>{GLuint(occupied + 63) / 64, 1, 1}));
        }
    }
}

// 511 x 511 m in as many sheets as it takes to have more faces than a storage block holds sums for.
TEST(Lists, MoreFacesThanAStorageBlockHoldsAreRefusedByName)
{
    test_gl();
    GLint64 most = 0;
    glGetInteger64v(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &most);
    const std::size_t faces = std::size_t(most) / (2 * shared::kSumCount * sizeof(GLuint));
    const std::size_t sheets = faces / (510 * 510) + 1;
    if (sheets > 30) GTEST_SKIP() << "storage blocks of this driver are too large to fill";
    std::vector<std::array<glm::vec3, 3>> soup;
    for (std::size_t i = 0; i < sheets; ++i) {
        const float y = 1.5f + 2.0f * float(i);
        soup.push_back({glm::vec3(0.5f, y, 0.5f), glm::vec3(0.5f, y, 511.5f), glm::vec3(511.5f, y, 0.5f)});
        soup.push_back({glm::vec3(511.5f, y, 511.5f), glm::vec3(511.5f, y, 0.5f), glm::vec3(0.5f, y, 511.5f)});
    }
    SoupPipeline pipeline(triangle_soup(soup), 512);
    try {
        pipeline.average();
        FAIL() << "not refused: " << pipeline.voxel_faces().face_count() << " faces, limit " << faces;
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find("faces"), std::string::npos) << error.what();
        EXPECT_NE(std::string(error.what()).find("voxels="), std::string::npos) << error.what();
    }
}

// Rows of work groups: places beyond 65,535 groups of 64.
TEST(Dispatch, RowsCoverEveryItem)
{
    for (const std::size_t items : {std::size_t(0), std::size_t(1), std::size_t(64), std::size_t(65535) * 64,
                                    std::size_t(65535) * 64 + 1, std::size_t(1) << 26}) {
        const glm::uvec3 groups = gl::group_counts(items, 64);
        EXPECT_LE(groups.x, 65535u);
        EXPECT_LE(groups.y, 65535u);
        EXPECT_GE(std::size_t(groups.x) * groups.y * 64, items);
        EXPECT_LT(std::size_t(groups.x) * groups.y * 64, items + 64 * (groups.y + 1));
    }
    // What shaders make of it: every triangle is met once.
    Scene scene;
    const int side = 2100;  // 4,410,000 triangles without area, more than 65,535 x 64
    scene.materials.push_back(lambert(0.5f));
    scene.vertices.push_back({glm::vec3(0.5f), glm::vec3(0, 1, 0), glm::vec4(1, 0, 0, 1), {}, {}, glm::vec4(1.0f)});
    scene.indices.assign(std::size_t(side) * side * 3, 0u);
    scene.draws.push_back({0, std::uint32_t(scene.indices.size()), 0, ""});
    scene.bounds = unit_bounds(4);
    SoupPipeline pipeline(scene, unit_bounds(4), 4);
    pipeline.voxelize();
    EXPECT_EQ(pipeline.statistics().degenerate, GLuint(side) * GLuint(side));
}

TEST(Means, WeighByArea)
{
    // Two patches in one voxel, areas 0.3 and 0.1.
    SceneBuilder builder;
    builder.quad({4.1f, 4.1f, 4.3f}, {0.5f, 0, 0}, {0, 0.6f, 0}, builder.material(lambert(glm::vec3(1.0f, 0.2f, 0.0f))));
    builder.quad({4.1f, 4.1f, 4.7f}, {0.5f, 0, 0}, {0, 0.2f, 0}, builder.material(lambert(glm::vec3(0.0f, 0.6f, 0.4f))));
    SoupPipeline pipeline(builder.build(), unit_bounds(16), 16);
    pipeline.average();
    ASSERT_EQ(pipeline.faces().size(), 1u);
    const shared::VoxelFace face = pipeline.faces()[0];
    EXPECT_NEAR(face.albedo_area.a, 0.4f, 1e-6f);
    EXPECT_NEAR(face.albedo_area.r, 0.75f, 1e-6f);
    EXPECT_NEAR(face.albedo_area.g, 0.3f, 1e-6f);
    EXPECT_NEAR(face.albedo_area.b, 0.1f, 1e-6f);
    EXPECT_NEAR(face.position.x, 4.35f, 1e-5f);
    EXPECT_NEAR(face.position.y, 0.75f * 4.4f + 0.25f * 4.2f, 1e-5f);
    EXPECT_NEAR(face.position.z, 0.75f * 4.3f + 0.25f * 4.7f, 1e-5f);
    EXPECT_NEAR(face.normal.z, 1.0f, 1e-6f);
}

TEST(Means, SideOfASlantedPlane)
{
    // z = 0.25 x cuts the unit voxel at (0, 0, 0) from side to side: area sqrt(1 + 1/16).
    SceneBuilder builder;
    const glm::vec3 a(-3, -3, -0.75f), b(5, -3, 1.25f), c(5, 5, 1.25f), d(-3, 5, -0.75f);
    const int material = builder.material(lambert(0.25f));
    const glm::vec3 corner(4, 4, 4);
    builder.triangle(corner + a, corner + b, corner + c, material);
    builder.triangle(corner + a, corner + c, corner + d, material);
    SoupPipeline pipeline(builder.build(), unit_bounds(16), 16);
    pipeline.average();
    const auto faces = pipeline.faces_by_voxel();
    const shared::VoxelFace face = faces.at({{4, 4, 4}, 5});
    EXPECT_NEAR(face.albedo_area.a, std::sqrt(1.0f + 1.0f / 16.0f), 1e-5f);
    EXPECT_NEAR(face.position.x, 4.5f, 1e-5f);
    EXPECT_NEAR(face.position.z, 4.125f, 1e-5f);
    // (4, 4, 4) has z from 0 to 0.25; the column at x = 8 has z from 1 to 1.25.
    EXPECT_NEAR(faces.at({{8, 4, 5}, 5}).albedo_area.a, std::sqrt(1.0f + 1.0f / 16.0f), 1e-5f);
}

TEST(Means, MaterialsAsTheSurfaceShadersSeeThem)
{
    SceneBuilder builder;
    Material unlit = lambert(glm::vec3(0.3f, 0.6f, 0.9f));
    unlit.unlit = true;
    Material red = lambert(glm::vec3(0.9f, 0.1f, 0.1f));
    red.emission = {5.0f, 0.0f, 1.0f};
    builder.quad({2.1f, 2.1f, 2.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}, builder.material(unlit));
    builder.quad({6.1f, 2.1f, 2.5f}, {0.5f, 0, 0}, {0, 0.5f, 0}, builder.material(red));
    SoupPipeline pipeline(builder.build(), unit_bounds(16), 16);
    pipeline.average();
    const auto faces = pipeline.faces_by_voxel();
    const auto expect_near = [](const glm::vec4& value, const glm::vec3& expected) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(value[c], expected[c], 1e-5f);
    };
    expect_near(faces.at({{2, 2, 2}, 5}).albedo_area, glm::vec3(0.0f));  // shines with its colour
    expect_near(faces.at({{2, 2, 2}, 5}).emission, {0.3f, 0.6f, 0.9f});
    expect_near(faces.at({{6, 2, 2}, 5}).albedo_area, {0.9f, 0.1f, 0.1f});
    expect_near(faces.at({{6, 2, 2}, 5}).emission, {5.0f, 0.0f, 1.0f});
}

TEST(Means, RasterAndComputeAgree)
{
    std::mt19937 random(32);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    Scene scene = triangle_soup(random_triangles(random, 1000, unit_bounds(32), 0.1f, 20.0f), lambert(1.0f));
    for (Vertex& v : scene.vertices) v.color = glm::vec4(unit(random), unit(random), unit(random), 1.0f);
    SoupPipeline raster(scene, 32, Voxelizer::raster), compute(scene, 32, Voxelizer::compute);
    raster.average();
    compute.average();
    ASSERT_EQ(raster.face_list(), compute.face_list());
    const auto a = raster.faces(), b = compute.faces();
    ASSERT_EQ(a.size(), b.size());
    // The same list in another order: the same sums.
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0);
}

TEST(Means, NaiveOnesAreNearWhereFragmentsAreFew)
{
    // One fragment a voxel: nothing to average, so all three ways agree to half a unit of 8 bits.
    SceneBuilder builder;
    builder.quad({2.2f, 2.2f, 5.5f}, {9, 0, 0}, {0, 9, 0}, builder.material(lambert(glm::vec3(0.3f, 0.5f, 0.7f))));
    SoupPipeline pipeline(builder.build(), unit_bounds(16), 16);
    pipeline.average();
    for (const Averaging averaging : {Averaging::compare_and_swap, Averaging::racing_store}) {
        NaiveAverage naive(test_gl().shaders);
        naive.run(pipeline.scene(), pipeline.grid(), pipeline.voxelizer(), averaging);
        EXPECT_LE(rms_error(naive, pipeline.voxel_faces()), 0.5 / 255.0);
        EXPECT_GT(rms_error(naive, pipeline.voxel_faces()), 0.0);  // 0.3 * 255 is no whole number
    }
}

TEST(FaceView, ShowsTheFaceTowardsTheCamera)
{
    SceneBuilder builder;
    builder.quad({2, 2, 8.6f}, {12, 0, 0}, {0, 12, 0}, builder.material(lambert(glm::vec3(0.9f, 0.1f, 0.1f))));
    builder.quad({2, 2, 8.4f}, {0, 12, 0}, {12, 0, 0}, builder.material(lambert(glm::vec3(0.1f, 0.1f, 0.9f))));
    SoupPipeline pipeline(builder.build(), unit_bounds(16), 16);
    pipeline.average();
    FaceViewPass view(test_gl().shaders);
    const FaceQuantity albedo{&pipeline.voxel_faces().faces(), int(sizeof(shared::VoxelFace) / sizeof(glm::vec4)), 0, 0, nullptr};
    for (const float side : {1.0f, -1.0f}) {
        const Camera camera = look_at_orthographic({8, 8, 8 + side * 30}, {8, 8, 8}, 4.0f, 4.0f);
        const gl::Buffer camera_buffer("camera", std::vector{camera_data(camera, {16, 16}, unit_bounds(16))});
        const ImageF image = read_picture(view.run(pipeline.grid(), pipeline.voxelizer().occupancy(), pipeline.voxel_faces(),
                                                   albedo, camera_buffer, {16, 16}));
        for (const glm::vec4& pixel : image.pixels) {
            EXPECT_NEAR(pixel.r, side > 0.0f ? 0.9f : 0.1f, 1e-3f);
            EXPECT_NEAR(pixel.b, side > 0.0f ? 0.1f : 0.9f, 1e-3f);
            EXPECT_EQ(pixel.a, 1.0f);
        }
    }
}

TEST(Program05, SumsDoNotChangeFromFrameToFrame)
{
    if (program_folder().empty()) GTEST_SKIP() << "CONEBOOK_BIN is not set";
    const TemporaryFolder folder;
    for (const std::string averaging : {"sums", "compare_and_swap", "racing_store"}) {
        const ProgramRun result = run_program(
            "05_atomic_averaging", "--headless --size 64x64 --frames 6 --scene '" + TestGl::root() +
                                       "/assets/colonnade.glb' --set voxels=64 count_changes=on averaging=" + averaging +
                                       " --output '" + (folder / "a.png").string() + "' --stats '" +
                                       (folder / "a.json").string() + "'");
        ASSERT_EQ(result.code, 0) << result.output;
        const auto stats = read_statistics(folder / "a.json");
        if (averaging == "sums") {
            EXPECT_EQ(count_of(stats, "values that changed between frames"), 0.0);
        } else {
            EXPECT_GT(count_of(stats, "RMS error of the naive mean"), 0.0);
        }
        EXPECT_GE(count_of(stats, "fragments"), count_of(stats, "occupied faces"));
    }
}

}  // namespace
}  // namespace conebook
