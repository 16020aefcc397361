// Means of many fragments in one voxel against means in double precision, whatever the fragments' number and order.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include "05_atomic_averaging/naive_average.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"
#include "voxel_oracle.hpp"
#include "soup_pipeline.hpp"

namespace conebook {
namespace {

constexpr double kHalfUnit = 0.5 / 255.0;  // of 8 bits, which is what the volumes of most implementations store

// Random triangles with the corners of a cloud of points on one slanted plane inside voxel (1, 1, 1), each corner with
// its own colour: any number of fragments in one face of one voxel. No needles: their normals are rounding errors.
Scene crowd(int triangles, unsigned seed, float size = 0.8f)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    Scene scene;
    scene.materials.push_back(lambert(1.0f));
    for (int i = 0; i < 2000; ++i) {
        const float x = 1.5f + size * (unit(random) - 0.5f), y = 1.5f + size * (unit(random) - 0.5f);
        const glm::vec4 color(unit(random), unit(random) * unit(random), 0.1f * unit(random), 1.0f);
        scene.vertices.push_back({{x, y, 1.4f + 0.1f * (x - 1.0f)}, glm::normalize(glm::vec3(-0.1f, 0, 1)),
                                  glm::vec4(1, 0, 0, 1), glm::vec2(0.0f), glm::vec2(0.0f), color});
    }
    while (scene.indices.size() < 3 * std::size_t(triangles)) {
        const std::array<std::uint32_t, 3> c = {std::uint32_t(random() % 2000), std::uint32_t(random() % 2000),
                                                std::uint32_t(random() % 2000)};
        const glm::vec3 p = scene.vertices[c[0]].position, u = scene.vertices[c[1]].position - p,
                        v = scene.vertices[c[2]].position - p;
        if (glm::cross(u, v).z > 0.05f * std::max(glm::dot(u, u), glm::dot(v, v)))
            scene.indices.insert(scene.indices.end(), c.begin(), c.end());
    }
    scene.draws.push_back({0, std::uint32_t(scene.indices.size()), 0, ""});
    return scene;
}

struct Mean {
    double area = 0.0;
    glm::dvec3 albedo{0.0}, position{0.0};
};
Mean mean_of(const Scene& scene)
{
    Mean mean;
    for (std::size_t i = 0; i < scene.indices.size(); i += 3) {
        oracle::Triangle t;
        glm::dvec3 color(0.0);
        for (std::size_t c = 0; c < 3; ++c) {
            t[c] = glm::dvec3(scene.vertices[scene.indices[i + c]].position);
            color += glm::dvec3(glm::vec3(scene.vertices[scene.indices[i + c]].color)) / 3.0;
        }
        const double area = oracle::area_of(t);
        mean.area += area;
        mean.albedo += area * color;
        mean.position += area * (t[0] + t[1] + t[2]) / 3.0;
    }
    mean.albedo /= mean.area;
    mean.position /= mean.area;
    return mean;
}

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

TEST(Averaging, AnyNumberOfFragmentsInOneVoxel)
{
    for (const int count : {1, 2, 255, 256, 100000, 1000000}) {
        const Scene scene = crowd(count, 11u);
        SoupPipeline pipeline(scene, unit_bounds(8), 8);
        pipeline.average();
        ASSERT_EQ(pipeline.voxel_faces().voxel_count(), 1u);
        ASSERT_EQ(pipeline.voxel_faces().face_count(), 1u);
        EXPECT_EQ(pipeline.fragment_count(), std::size_t(count));
        const shared::VoxelFace face = pipeline.faces()[0];
        const Mean exact = mean_of(scene);
        const double albedo_error = largest(glm::dvec3(glm::vec3(face.albedo_area)) - exact.albedo);
        const double area_error = double(face.albedo_area.a) / exact.area - 1.0;
        std::printf("%7d fragments: albedo off by %.1e, area by %.1e\n", count, albedo_error, area_error);
        EXPECT_LE(albedo_error, 0.02 * kHalfUnit);
        EXPECT_LE(std::abs(area_error), 1e-5);
        EXPECT_LE(largest(glm::dvec3(glm::vec3(face.position)) - exact.position), 1e-5);
        EXPECT_NEAR(face.normal.x, -0.1 / std::sqrt(1.01), 1e-5);
    }
}

TEST(Averaging, MillionTinyFragments)
{
    // 10^6 triangles of about 1e-6 voxel sides squared each: every one is rounded to 2^-30.
    const Scene scene = crowd(1000000, 12u, 0.004f);
    SoupPipeline pipeline(scene, unit_bounds(8), 8);
    pipeline.average();
    ASSERT_EQ(pipeline.voxel_faces().face_count(), 1u);
    const Mean exact = mean_of(scene);
    const shared::VoxelFace face = pipeline.faces()[0];
    const double error = largest(glm::dvec3(glm::vec3(face.albedo_area)) - exact.albedo);
    std::printf("tiny fragments: albedo off by %.1e, area by %.1e\n", error, double(face.albedo_area.a) / exact.area - 1.0);
    EXPECT_LE(error, kHalfUnit);
}

// Fragments of all sizes and shapes, cut by voxels in all ways.
TEST(Averaging, FacesOfASoup)
{
    std::mt19937 random(13);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    Scene scene = triangle_soup(random_triangles(random, 3000, unit_bounds(32), 0.05f, 20.0f), lambert(1.0f));
    for (Vertex& v : scene.vertices) v.color = glm::vec4(unit(random), unit(random), unit(random), 1.0f);
    SoupPipeline pipeline(scene, 32);
    pipeline.average();
    std::map<std::pair<std::array<int, 3>, int>, Mean> exact;
    double total = 0.0;
    for (std::size_t i = 0; i < scene.triangle_count(); ++i) {
        oracle::Triangle t;
        for (std::size_t c = 0; c < 3; ++c)
            t[c] = (glm::dvec3(scene.vertices[scene.indices[3 * i + c]].position) -
                    glm::dvec3(glm::vec3(pipeline.grid().data().origin))) / double(pipeline.grid().voxel_size_m());
        if (oracle::area_of(t) == 0.0) continue;
        total += oracle::area_of(t);
        oracle::for_each_voxel(t, pipeline.grid().size(), 0.0, [&](glm::ivec3 v) {
            const oracle::Part part = oracle::part_in_voxel(t, v);
            if (part.area <= 0.0) return;
            Mean& mean = exact[{{v.x, v.y, v.z}, oracle::face_of(oracle::normal_of(t))}];
            const glm::dvec3 b = oracle::barycentric(t, part.center);
            for (std::size_t c = 0; c < 3; ++c)
                mean.albedo += part.area * b[int(c)] *
                               glm::dvec3(glm::vec3(scene.vertices[scene.indices[3 * i + c]].color));
            mean.position += part.area * part.center;
            mean.area += part.area;
        });
    }
    double worst_area = 0.0, worst_albedo = 0.0, worst_position = 0.0;
    std::size_t compared = 0;
    const auto faces = pipeline.faces_by_voxel();
    for (auto& [key, mean] : exact) {
        const auto found = faces.find(key);
        ASSERT_TRUE(found != faces.end() || mean.area < 1e-6);
        if (found == faces.end()) continue;
        const shared::VoxelFace& face = found->second;
        worst_area = std::max(worst_area, std::abs(double(face.albedo_area.a) - mean.area));
        if (mean.area < 1e-3) continue;
        ++compared;
        worst_albedo = std::max(worst_albedo, largest(glm::dvec3(glm::vec3(face.albedo_area)) - mean.albedo / mean.area));
        worst_position = std::max(worst_position, largest(glm::dvec3(glm::vec3(face.position)) - mean.position / mean.area));
    }
    for (const auto& [key, face] : faces)
        EXPECT_TRUE(exact.count(key) || face.albedo_area.a < 1e-5f);  // merely touched
    std::printf("%zu faces: area off by %.1e, albedo %.1e, position %.1e; total area %.1e\n", compared, worst_area,
                worst_albedo, worst_position, pipeline.total_area_voxels() / total - 1.0);
    EXPECT_GT(compared, 10000u);
    EXPECT_LE(worst_area, 2e-5);
    EXPECT_LE(worst_albedo, kHalfUnit);
    EXPECT_LE(worst_position, 2e-3);
    EXPECT_NEAR(pipeline.total_area_voxels() / total, 1.0, 1e-4);
}

// A mesh as it is usual: shared edges that run through voxels.
TEST(Averaging, AreasOfAMeshAddUp)
{
    for (const float radius : {0.9f, 1.0f}) {
        SceneBuilder builder;
        builder.sphere({0.1f, 0.2f, 0.3f}, radius, builder.material(lambert(0.5f)), 40);
        const Scene scene = builder.build();
        for (const Voxelizer voxelizer : {Voxelizer::raster, Voxelizer::compute})
            for (const int voxels : {16, 50, 128}) {
                SoupPipeline pipeline(scene, scene.bounds, voxels, voxelizer);
                pipeline.average();
                double exact = 0.0;
                for (const auto& t : oracle::triangles_of(scene, pipeline.grid().data())) exact += oracle::area_of(t);
                EXPECT_NEAR(pipeline.total_area_voxels() / exact, 1.0, 1e-4) << voxels;
            }
    }
}

TEST(Averaging, QuadOnAVoxelSideCountsOnce)
{
    for (int axis = 0; axis < 3; ++axis) {
        SceneBuilder builder;
        glm::vec3 corner(4.25f), u(0.0f), v(0.0f);
        corner[axis] = 9.0f;
        u[(axis + 1) % 3] = 8.0f;
        v[(axis + 2) % 3] = 6.0f;
        builder.quad(corner, u, v, builder.material(lambert(0.5f)));
        SoupPipeline pipeline(builder.build(), unit_bounds(32), 32);
        pipeline.average();
        EXPECT_NEAR(pipeline.total_area_voxels(), 48.0, 1e-4);
        int with_area = 0;
        for (const auto& [key, face] : pipeline.faces_by_voxel()) {
            EXPECT_TRUE(key.first[std::size_t(axis)] == 8 || key.first[std::size_t(axis)] == 9);
            with_area += face.albedo_area.a > 1e-6f;
            EXPECT_TRUE(key.first[std::size_t(axis)] == 9 || face.albedo_area.a < 1e-6f);  // the other is only touched
        }
        EXPECT_EQ(with_area, 9 * 7);
    }
}

std::vector<std::byte> bytes_of(const std::vector<shared::VoxelFace>& faces)
{
    std::vector<std::byte> bytes(faces.size() * sizeof faces[0]);
    std::memcpy(bytes.data(), faces.data(), bytes.size());
    return bytes;
}

TEST(Averaging, TwentyRunsAndShuffledTrianglesGiveTheSameBits)
{
    std::mt19937 random(14);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    Scene scene = triangle_soup(random_triangles(random, 20000, unit_bounds(16), 0.05f, 3.0f), lambert(1.0f));
    for (Vertex& v : scene.vertices) v.color = glm::vec4(unit(random), unit(random), unit(random), 1.0f);
    SoupPipeline pipeline(scene, 16);
    pipeline.average();
    const auto first = bytes_of(pipeline.faces());
    const auto occupancy = pipeline.occupancy();
    for (int run = 1; run < 20; ++run) {
        pipeline.average();
        ASSERT_EQ(bytes_of(pipeline.faces()), first) << run;
        ASSERT_EQ(pipeline.occupancy(), occupancy) << run;
    }
    std::vector<std::array<std::uint32_t, 3>> triangles(scene.triangle_count());
    std::memcpy(triangles.data(), scene.indices.data(), scene.indices.size() * sizeof scene.indices[0]);
    for (int shuffle = 0; shuffle < 3; ++shuffle) {
        std::shuffle(triangles.begin(), triangles.end(), random);
        std::memcpy(scene.indices.data(), triangles.data(), scene.indices.size() * sizeof scene.indices[0]);
        SoupPipeline shuffled(scene, 16);
        shuffled.average();
        ASSERT_EQ(bytes_of(shuffled.faces()), first);
    }
}

std::string contents(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

TEST(Averaging, OneAndTwoDriverThreadsGiveTheSameBits)
{
    if (program_folder().empty()) GTEST_SKIP() << "CONEBOOK_BIN is not set";
    const TemporaryFolder folder;
    const std::string scene = TestGl::root() + "/assets/colonnade.glb";
    for (const std::string view : {"final", "normal", "area"}) {
        std::string first;
        for (const std::string threads : {"1", "2"}) {
            const auto file = folder / (view + threads + ".exr");
            setenv("LP_NUM_THREADS", threads.c_str(), 1);
            const ProgramRun run = run_program("05_atomic_averaging", "--headless --size 192x128 --set voxels=64 --view " +
                                                                          view + " --scene '" + scene + "' --output '" +
                                                                          file.string() + "'");
            unsetenv("LP_NUM_THREADS");
            ASSERT_EQ(run.code, 0) << run.output;
            const std::string bytes = contents(file);
            ASSERT_GT(bytes.size(), 1000u);
            if (first.empty()) first = bytes;
            EXPECT_TRUE(bytes == first) << view;
        }
    }
}

// Both sides of a sheet in the same voxels.
TEST(Averaging, ThinSheetsKeepTheirSidesApart)
{
    for (const bool one_material : {true, false}) {
        SceneBuilder builder;
        if (one_material) {
            Material m = lambert(glm::vec3(0.8f, 0.2f, 0.1f));
            m.double_sided = true;
            builder.quad({4, 4, 8.5f}, {8, 0, 0}, {0, 8, 0}, builder.material(m));
        } else {
            builder.quad({4, 4, 8.5f}, {8, 0, 0}, {0, 8, 0}, builder.material(lambert(glm::vec3(0.8f, 0.2f, 0.1f))));
            builder.quad({4, 4, 8.4f}, {0, 8, 0}, {8, 0, 0}, builder.material(lambert(glm::vec3(0.1f, 0.3f, 0.9f))));
        }
        SoupPipeline pipeline(builder.build(), unit_bounds(32), 32);
        pipeline.average();
        int front = 0, back = 0;
        for (const auto& [key, face] : pipeline.faces_by_voxel()) {
            const bool is_front = key.second == 5;
            ASSERT_TRUE(is_front || key.second == 4);
            (is_front ? front : back) += 1;
            const glm::vec3 rho = is_front || one_material ? glm::vec3(0.8f, 0.2f, 0.1f) : glm::vec3(0.1f, 0.3f, 0.9f);
            // The sheet ends on voxel sides: the voxels beyond are touched and have a trace of it.
            const float tolerance = face.albedo_area.a > 1e-3f ? 1e-5f : 1.0f / 256.0f;
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(face.albedo_area[c], rho[c], tolerance);
            EXPECT_NEAR(face.normal.z, is_front ? 1.0f : -1.0f, 1e-5f);
        }
        EXPECT_EQ(front, 100);  // 8 x 8 and the ring that touches
        EXPECT_EQ(back, 100);
        EXPECT_NEAR(pipeline.total_area_voxels(), 128.0, 1e-3);
    }
    // Shading normals that cancel within one face leave the face's own direction.
    Scene scene = crowd(1, 15u);
    for (std::size_t c = 0; c < 3; ++c) {
        Vertex opposite = scene.vertices[scene.indices[c]];
        opposite.normal = -opposite.normal;
        scene.indices.push_back(std::uint32_t(scene.vertices.size()));
        scene.vertices.push_back(opposite);
    }
    scene.draws[0].index_count = 6;
    SoupPipeline pipeline(scene, unit_bounds(8), 8);
    pipeline.average();
    const auto faces = pipeline.faces_by_voxel();
    ASSERT_EQ(faces.size(), 1u);
    EXPECT_EQ(faces.begin()->second.normal, glm::vec4(0, 0, 1, 0));
}

TEST(Averaging, BlackIsOccupied)
{
    SceneBuilder builder;
    builder.quad({4.2f, 4.2f, 8.5f}, {8, 0, 0}, {0, 8, 0}, builder.material(lambert(0.0f)));
    SoupPipeline pipeline(builder.build(), unit_bounds(32), 32);
    pipeline.average();
    EXPECT_EQ(pipeline.voxel_faces().voxel_count(), 81u);
    for (const auto& face : pipeline.faces()) {
        EXPECT_EQ(glm::vec3(face.albedo_area), glm::vec3(0.0f));
        EXPECT_GT(face.albedo_area.a, 0.01f);
    }
}

TEST(Averaging, EmissionFromDimToBright)
{
    // Every radiance alone in a voxel, and the dimmest and the brightest together in one.
    SceneBuilder builder;
    std::vector<float> radiances;
    for (float radiance = 1e-3f; radiance < 1.1e4f; radiance *= 10.0f) radiances.push_back(radiance);
    const auto patch = [&](float x, float y, float side, float radiance) {
        builder.quad({x, y, 8.5f}, {side, 0, 0}, {0, side, 0},
                     builder.material(emitter(glm::vec3(radiance, 0.5f * radiance, 0.1f * radiance))));
    };
    for (std::size_t i = 0; i < radiances.size(); ++i) {
        patch(2.1f + 2.0f * float(i), 4.1f, 0.7f, radiances[i]);
        patch(2.1f + 2.0f * float(i), 8.1f, 0.05f, radiances[i]);
    }
    patch(2.1f, 12.1f, 0.8f, 1e-3f);
    patch(2.2f, 12.2f, 0.01f, 1e4f);
    SoupPipeline pipeline(builder.build(), unit_bounds(32), 32);
    pipeline.average();
    const auto faces = pipeline.faces_by_voxel();
    for (std::size_t i = 0; i < radiances.size(); ++i)
        for (const int row : {4, 8}) {
            const glm::vec3 emission = glm::vec3(faces.at({{2 + 2 * int(i), row, 8}, 5}).emission);
            EXPECT_NEAR(emission.r / radiances[i], 1.0f, 0.01f) << radiances[i];
            EXPECT_NEAR(emission.g / radiances[i], 0.5f, 0.01f);
            EXPECT_NEAR(emission.b / radiances[i], 0.1f, 0.01f);
        }
    const double both = (0.64 * 1e-3 + 1e-4 * 1e4) / (0.64 + 1e-4);
    EXPECT_NEAR(double(faces.at({{2, 12, 8}, 5}).emission.r) / both, 1.0, 0.01);
}

// The running mean of 8 bits on the CPU, one value after the other; in 255ths.
int running_mean(const std::vector<double>& values, bool truncating)
{
    int mean = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
        mean = int((mean * double(i) + 255.0 * values[i]) / double(i + 1) + (truncating ? 0.0 : 0.5));
    return mean;
}

// Why the book does not average in 8 bits: n grey levels spread evenly over 0..1, whose mean is 0.5, on n equal
// triangles in one voxel. What the running mean makes of them depends on their order, which is the threads'. Cut off, as
// published, it is too dark in every order; rounded, it is right only where dark and bright ones come in turn.
TEST(Averaging, RunningMeansOfEightBitsStick)
{
    std::mt19937 random(16);
    for (const int count : {50, 200, 255}) {
        const std::array<glm::vec3, 3> triangle = {glm::vec3(4.2f, 4.2f, 4.5f), glm::vec3(4.8f, 4.2f, 4.5f),
                                                   glm::vec3(4.2f, 4.8f, 4.5f)};
        Scene scene = triangle_soup(std::vector(std::size_t(count), triangle), lambert(1.0f));
        std::vector<double> values;
        for (int i = 0; i < count; ++i) {
            values.push_back((i + 0.5) / count);
            for (std::size_t k = 0; k < 3; ++k)
                scene.vertices[3 * std::size_t(i) + k].color = glm::vec4(glm::vec3(float(values.back())), 1.0f);
        }
        SoupPipeline pipeline(scene, unit_bounds(8), 8);
        pipeline.average();
        EXPECT_NEAR(pipeline.faces()[0].albedo_area.r, 0.5, 1e-6);
        for (const bool truncating : {false, true}) {
            // What orders can make of it: rising, falling, and many others.
            std::vector<double> order(values.rbegin(), values.rend());
            const int rising = running_mean(values, truncating), falling = running_mean(order, truncating);
            int low = std::min(rising, falling), high = std::max(rising, falling);
            double shuffled = 0.0;
            for (int i = 0; i < 1000; ++i) {
                std::shuffle(order.begin(), order.end(), random);
                const int mean = running_mean(order, truncating);
                low = std::min(low, mean);
                high = std::max(high, mean);
                shuffled += mean / 1000.0;
            }
            NaiveAverage naive(test_gl().shaders);
            naive.run(pipeline.scene(), pipeline.grid(), pipeline.voxelizer(),
                      truncating ? Averaging::compare_and_swap_truncating : Averaging::compare_and_swap);
            int found = 0;
            for (const GLuint texel : gl::read_uints(naive.color()))
                if (texel != 0u) found = int(texel & 255u);
            std::printf("%d values, %s: rising %.3f, falling %.3f, mean of 1000 orders %.3f, here %.3f\n", count,
                        truncating ? "cut off" : "rounded", rising / 255.0, falling / 255.0, shuffled / 255.0,
                        found / 255.0);
            EXPECT_GE(found, low - 1);
            EXPECT_LE(found, high + 1);
            if (truncating) {
                EXPECT_LT(high / 255.0, 0.5 - 0.0005 * count);  // in every order
            } else if (count == 200) {
                EXPECT_GT(std::abs(rising / 255.0 - 0.5), 0.1);
            }
        }
    }
}

}  // namespace
}  // namespace conebook
