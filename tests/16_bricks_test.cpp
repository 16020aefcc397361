// Chapter 16's bricks: every voxel of every level against the atlas, bit for bit; look-ups between voxels against the same
// filter in double precision; how many texels there are; and pictures of both storages.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include <gtest/gtest.h>

#include "16_only_what_is_needed/brick_storage.hpp"
#include "image/image.hpp"
#include "lit_scene.hpp"
#include "program.hpp"
#include "scene_builder.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"
#include "walk_oracle.hpp"

namespace conebook {
namespace {

// The programs of the book and those of the tests below one folder.
class ShadersOfTests {
public:
    ShadersOfTests()
    {
        for (const auto& entry : std::filesystem::directory_iterator(TestGl::root() + "/shaders"))
            std::filesystem::create_directory_symlink(entry.path(), folder_ / entry.path().filename().string());
        std::filesystem::create_directory_symlink(TestGl::root() + "/tests/shaders", folder_ / "tests");
        shaders_ = std::make_unique<gl::Shaders>(folder_.path());
    }
    gl::Program load(const std::string& file, const gl::Defines& defines) const { return shaders_->load({file}, defines); }

private:
    TemporaryFolder folder_;
    std::unique_ptr<gl::Shaders> shaders_;
};

struct Place {
    glm::vec4 p;      // xyz: voxels of the level
    glm::ivec4 what;  // x: face, y: level
};

enum Which { light_of_voxel, light_between, coverage_between, emission_of_voxel, emission_between };

// Slanted, curved, thin, bright and dark surfaces, mostly empty; no side of the scene is a multiple of another.
Scene mixed_scene()
{
    SceneBuilder b;
    const int red = b.material(lambert({0.8f, 0.2f, 0.1f})), grey = b.material(lambert(0.5f));
    Material sheet = lambert({0.2f, 0.6f, 0.3f});
    sheet.double_sided = true;
    b.box({-1.0f, -0.45f, -0.8f}, {1.0f, 0.45f, 0.8f}, grey, true);
    b.sphere({0.2f, -0.05f, 0.15f}, 0.35f, red, 24);
    b.quad({-0.8f, -0.4f, 0.3f}, {0.9f, 0.3f, -0.3f}, {0.1f, 0.4f, 0.4f}, b.material(sheet));
    b.quad({-0.5f, 0.4f, 0.2f}, {0.3f, 0, 0}, {0, 0, 0.3f}, b.material(emitter({50.0f, 40.0f, 30.0f})));
    b.quad({0.5f, -0.4f, 0.2f}, {0.2f, 0, 0}, {0, 0.2f, 0.1f}, b.material(emitter(1e-3f)));
    b.point_light({0.1f, 0.35f, -0.3f}, glm::vec3(2.0f));
    return b.build();
}

// A scene with two pyramids, of what its surfaces reflect and emit, in a storage that may change.
struct Stored {
    LitScene lit;
    PyramidParams params;
    BrickLight bricks;
    LightPyramid light, emission;
    ShadersOfTests shaders;

    Stored(const Scene& scene, int voxels, Directions directions = Directions::per_face,
           LightFormat format = LightFormat::rgba16f)
        : lit(scene, voxels),
          bricks(test_gl().shaders, params),
          light(test_gl().shaders, bricks.storage()),
          emission(test_gl().shaders, bricks.storage())
    {
        params.directions = directions;
        params.format = format;
    }
    void store(VoxelStorage storage)
    {
        params.storage = storage;
        PyramidParams of_emission;
        of_emission.storage = storage;
        light.run(lit.grid, lit.faces, lit.shading.radiance(), lit.shading.revision(), params, LightPart::reflected);
        emission.run(lit.grid, lit.faces, lit.shading.radiance(), lit.shading.revision(), of_emission, LightPart::emitted);
    }
    std::vector<glm::vec4> look_up(Which which, const std::vector<Place>& places) const
    {
        const gl::Program program = shaders.load("tests/look_up_light.comp", light.defines());
        const gl::Buffer in("places", places), out("found", places.size() * sizeof(glm::vec4));
        lit.grid.bind();
        light.bind();
        emission.bind_as_emission();
        in.bind(GL_SHADER_STORAGE_BUFFER, 0);
        out.bind(GL_SHADER_STORAGE_BUFFER, 1);
        program.set("which", int(which));
        program.use();
        glDispatchCompute(gl::group_count(places.size(), 64), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        return out.read<glm::vec4>();
    }
    // The middle of every voxel of every level, for all faces.
    std::vector<Place> all_voxels() const
    {
        std::vector<Place> all;
        for (int level = 0; level < lit.grid.levels(); ++level) {
            const glm::ivec3 size = lit.grid.size() >> level;
            for (int z = 0; z < size.z; ++z)
                for (int y = 0; y < size.y; ++y)
                    for (int x = 0; x < size.x; ++x)
                        for (int face = 0; face < 6; ++face)
                            all.push_back({glm::vec4(x, y, z, 0) + 0.5f, {face, level, 0, 0}});
        }
        return all;
    }
};

std::size_t bytes_of(const std::vector<gl::Resource>& resources)
{
    std::size_t sum = 0;
    for (const gl::Resource& resource : resources) sum += resource.bytes;
    return sum;
}

struct Kind {
    const char* name;
    int voxels;
    Directions directions;
    LightFormat format;
};

class Bricks : public testing::TestWithParam<Kind> {};

TEST_P(Bricks, HoldWhatTheAtlasHolds)
{
    Stored stored(mixed_scene(), GetParam().voxels, GetParam().directions, GetParam().format);
    const glm::ivec3 size = stored.lit.grid.size();
    EXPECT_NE(size.x, size.y);
    const std::vector<Place> places = stored.all_voxels();
    stored.store(VoxelStorage::dense);
    const auto light = stored.look_up(light_of_voxel, places), emission = stored.look_up(emission_of_voxel, places);
    const std::size_t dense = bytes_of(stored.light.resources());
    for (int again = 0; again < 2; ++again) {  // there and back
        stored.store(VoxelStorage::bricks);
        EXPECT_EQ(stored.look_up(light_of_voxel, places), light);
        EXPECT_EQ(stored.look_up(emission_of_voxel, places), emission);
        // Lists end with a whole row, which in a small grid is most of them.
        if (GetParam().voxels > 40) {
            EXPECT_LT(bytes_of(stored.light.resources()) + bytes_of(stored.bricks.index().resources()), dense / 4);
        }
        stored.store(VoxelStorage::dense);
        EXPECT_EQ(stored.look_up(light_of_voxel, places), light);
    }
    const auto lit = std::count_if(light.begin(), light.end(), [](const glm::vec4& v) { return v.r > 0.0f; });
    const auto shining = std::count_if(emission.begin(), emission.end(), [](const glm::vec4& v) { return v.r > 0.0f; });
    EXPECT_GT(lit, 400);
    EXPECT_GT(shining, 10);
}

// A texel for each side of a voxel that something covers, and one that is empty: no more.
TEST(BrickIndex, HasAsManyTexelsAsThereAreSides)
{
    Stored stored(mixed_scene(), 50);
    stored.store(VoxelStorage::dense);
    const auto light = stored.look_up(light_of_voxel, stored.all_voxels());
    const auto covered = std::count_if(light.begin(), light.end(), [](const glm::vec4& v) { return v.a > 0.0f; });
    stored.store(VoxelStorage::bricks);
    // Coverage below the smallest half float is rounded to 0, and has its texel all the same: 1 in 500 at most.
    EXPECT_GE(stored.bricks.index().texel_count(), std::size_t(covered) + 1);
    EXPECT_LE(double(stored.bricks.index().texel_count()), 1.002 * double(covered) + 1.0);
}

// Between the middles of voxels, on the sides of bricks and of the grid, and where there is nothing.
TEST_P(Bricks, AreFilteredAsInDoublePrecision)
{
    Stored stored(mixed_scene(), GetParam().voxels, GetParam().directions, GetParam().format);
    stored.store(VoxelStorage::bricks);
    const auto texels = stored.look_up(light_of_voxel, stored.all_voxels());
    const auto emitted = stored.look_up(emission_of_voxel, stored.all_voxels());
    std::vector<std::size_t> begin;  // of each level's texels
    std::size_t count = 0;
    for (int level = 0; level < stored.lit.grid.levels(); ++level) {
        begin.push_back(count);
        const glm::ivec3 size = stored.lit.grid.size() >> level;
        count += 6 * std::size_t(size.x) * std::size_t(size.y) * std::size_t(size.z);
    }
    std::mt19937 random(1);
    std::vector<Place> places;
    for (int i = 0; i < 40000; ++i) {
        const int level = int(random() % unsigned(stored.lit.grid.levels()));
        const glm::vec3 size(stored.lit.grid.size() >> level);
        glm::vec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            std::uniform_real_distribution<float> anywhere(0.5f, size[axis] - 0.5f);
            p[axis] = anywhere(random);
            if (random() % 4 == 0) p[axis] = std::clamp(4.0f * std::round(p[axis] / 4.0f), 0.5f, size[axis] - 0.5f);
            if (random() % 8 == 0) p[axis] = random() % 2 == 0 ? 0.5f : size[axis] - 0.5f;
        }
        places.push_back({glm::vec4(p, 0.0f), {int(random() % 6), level, 0, 0}});
    }
    const auto light = stored.look_up(light_between, places), coverage = stored.look_up(coverage_between, places);
    const auto emission = stored.look_up(emission_between, places);
    double worst = 0.0;
    std::size_t found = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const int face = places[i].what.x, level = places[i].what.y;
        const glm::ivec3 size = stored.lit.grid.size() >> level;
        const glm::dvec3 q = glm::dvec3(places[i].p) - 0.5, low = glm::floor(q);
        glm::dvec4 sum(0.0), of_emission(0.0), largest(0.0);
        for (int k = 0; k < 8; ++k) {
            const glm::dvec3 corner(k & 1, k >> 1 & 1, k >> 2), part = glm::mix(1.0 - (q - low), q - low, corner);
            const glm::ivec3 v = glm::min(glm::ivec3(low + corner), size - 1);  // weight 0 where it is cut off
            const std::size_t texel =
                begin[std::size_t(level)] +
                6 * ((std::size_t(v.z) * std::size_t(size.y) + std::size_t(v.y)) * std::size_t(size.x) + std::size_t(v.x)) +
                std::size_t(face);
            sum += part.x * part.y * part.z * glm::dvec4(texels[texel]);
            of_emission += part.x * part.y * part.z * glm::dvec4(emitted[texel]);
            largest = glm::max(largest, glm::max(glm::dvec4(texels[texel]), glm::dvec4(emitted[texel])));
        }
        for (int c = 0; c < 4; ++c) {
            const double scale = std::max(largest[c], 1e-6);
            worst = std::max({worst, std::abs(sum[c] - double(light[i][c])) / scale,
                              std::abs(of_emission[c] - double(emission[i][c])) / scale});
        }
        worst = std::max(worst, std::abs(sum.a - double(coverage[i].a)) / std::max(largest.a, 1e-6));
        found += sum.a > 0.0 ? 1 : 0;
    }
    EXPECT_GT(found, places.size() / 20);
    // p - 1/2 and three steps of floats round by 2^-24 each, seven times, of what is at most the largest of the eight; p
    // itself is exact.
    EXPECT_LT(worst, 8.0 * std::ldexp(1.0, -23));
    RecordProperty("worst", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(
    Storages, Bricks,
    testing::Values(Kind{"halves", 50, Directions::per_face, LightFormat::rgba16f},
                    Kind{"odd", 37, Directions::per_face, LightFormat::rgba16f},
                    Kind{"few_levels", 9, Directions::per_face, LightFormat::rgba16f},
                    Kind{"eight_bits", 41, Directions::per_face, LightFormat::rgba8},
                    Kind{"two_textures", 41, Directions::per_face, LightFormat::r11g11b10f},
                    Kind{"one_value", 41, Directions::isotropic, LightFormat::rgba16f}),
    [](const auto& info) { return std::string(info.param.name); });

// --- The walk volume ---

// The volume of a scene in both storages.
struct Walks {
    LitScene lit;
    BrickWalk bricks;
    WalkVolume dense, coarse;

    Walks(const Scene& scene, int voxels)
        : lit(scene, voxels),
          bricks(test_gl().shaders),
          dense(test_gl().shaders),
          coarse(test_gl().shaders, bricks.storage())
    {
        dense.run(lit.grid, lit.faces);
        coarse.run(lit.grid, lit.faces, int(VoxelStorage::bricks));
    }
};

TEST(BrickWalk, HasTheSameWordsWhereSomethingIsAndTheLargestEmptyCubesElsewhere)
{
    const Walks walks(mixed_scene(), 75);
    const WalkCells cells(walks.dense);
    const glm::ivec3 size = cells.size(), bricks = (size + 3) / 4;
    const gl::Texture& index = *walks.coarse.index().front().second;
    ASSERT_EQ(index.size(), bricks);
    const auto words = gl::read_uints(index), list = gl::read_uints(walks.coarse.volume());
    const auto at = [&](const glm::ivec3& b) {
        return words[(std::size_t(b.z) * std::size_t(bricks.y) + std::size_t(b.y)) * std::size_t(bricks.x) + std::size_t(b.x)];
    };
    // Whether the bricks low <= b < high hold nothing; what is outside never does.
    const auto is_empty = [&](const glm::ivec3& low, const glm::ivec3& high) {
        const glm::ivec3 from = glm::max(low, 0), to = glm::min(high, bricks);
        for (int z = from.z; z < to.z; ++z)
            for (int y = from.y; y < to.y; ++y)
                for (int x = from.x; x < to.x; ++x)
                    if (at({x, y, z}) >> 31 != 0u) return false;
        return true;
    };
    std::size_t listed = 0, other_words = 0, wrongly_empty = 0, wrong_leaps = 0, of_leap[5] = {};
    for (int z = 0; z < bricks.z; ++z)
        for (int y = 0; y < bricks.y; ++y)
            for (int x = 0; x < bricks.x; ++x) {
                const glm::ivec3 b(x, y, z);
                const GLuint word = at(b);
                const bool is_listed = word >> 31 != 0u;
                listed += is_listed ? 1 : 0;
                for (int i = 0; i < 64; ++i) {
                    const glm::ivec3 c = 4 * b + glm::ivec3(i & 3, i >> 2 & 3, i >> 4);
                    if (!cells.holds(c)) continue;
                    if (!is_listed && cells.occupied(c)) ++wrongly_empty;
                    if (is_listed && list[64 * (word & 0x7fffffffu) + GLuint(i)] != cells.word(c)) ++other_words;
                }
                for (int octant = 0; octant < 8 && !is_listed; ++octant) {
                    const glm::ivec3 up(octant & 1, octant >> 1 & 1, octant >> 2);
                    int largest = 0;
                    while (largest < 4) {
                        const int side = 2 << largest;
                        const glm::ivec3 low = b - (1 - up) * (side - 1);
                        if (!is_empty(low, low + side)) break;
                        ++largest;
                    }
                    if (int(word >> (3 * octant) & 7u) != largest) ++wrong_leaps;
                    ++of_leap[largest];
                }
            }
    EXPECT_EQ(other_words, 0u);
    EXPECT_EQ(wrongly_empty, 0u);
    EXPECT_EQ(wrong_leaps, 0u);
    EXPECT_EQ(listed, walks.bricks.listed_bricks());
    for (const std::size_t count : of_leap) EXPECT_GT(count, 0u);
}

struct Ray {
    glm::vec4 origin, direction;  // xyz: grid space; unit
};

TEST(BrickWalk, RaysEndWhereTheyDoInTheVolume)
{
    const Walks walks(mixed_scene(), 75);
    const ShadersOfTests shaders;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    std::vector<Ray> rays;
    const glm::vec3 low(walks.lit.grid.data().content_min), high(walks.lit.grid.data().content_max);
    while (rays.size() < 20000) {
        const glm::vec3 d = 2.0f * glm::vec3(unit(random), unit(random), unit(random)) - 1.0f;
        if (glm::length(d) > 1.0f || glm::length(d) < 0.1f) continue;
        const glm::vec3 from = low + 2.0f + (high - low - 4.0f) * glm::vec3(unit(random), unit(random), unit(random));
        rays.push_back({glm::vec4(from, float(random() % 16)), glm::vec4(glm::normalize(d), 0.0f)});
    }
    const gl::Buffer in("rays", rays);
    const auto ends_in = [&](const WalkVolume& walk) {
        gl::Defines defines = walk.defines();
        defines["MARCH"] = "0";
        const gl::Program program = shaders.load("tests/walk_rays.comp", defines);
        const gl::Buffer out("ends", rays.size() * sizeof(glm::vec2));
        walks.lit.grid.bind();
        walks.lit.pyramid.bind();
        walk.bind();
        in.bind(GL_SHADER_STORAGE_BUFFER, 0);
        out.bind(GL_SHADER_STORAGE_BUFFER, 1);
        program.use();
        glDispatchCompute(gl::group_count(rays.size(), 64), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        return out.read<glm::vec2>();
    };
    const auto expected = ends_in(walks.dense), found = ends_in(walks.coarse);
    std::size_t other = 0, stopped = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        stopped += expected[i].x > 0.0f ? 1 : 0;
        // Voxels; distances to sides of cells are rounded to 2^-24 of some 100.
        if (expected[i].x != found[i].x || std::abs(expected[i].y - found[i].y) > 1e-3f) ++other;
    }
    EXPECT_GT(stopped, rays.size() / 2);
    // A ray that passes an edge between cells within 1e-3, to which it is moved into the cell that it enters, may meet
    // one cell more or less when it comes there in other steps.
    EXPECT_LT(double(other) / double(rays.size()), 2e-3);
    RecordProperty("other", int(other));
}

// --- Pictures ---

std::filesystem::path picture_of(const TemporaryFolder& folder, const std::string& scene, const std::string& storage)
{
    const auto picture = folder / (scene + "_" + storage + ".exr");
    const ProgramRun run = run_program("16_only_what_is_needed", "--headless --size 96x96 --scene " + asset(scene).string() +
                                                                     " --set voxels=50 storage=" + storage + " --output " +
                                                                     picture.string());
    EXPECT_EQ(run.code, 0) << run.output;
    return picture;
}

TEST(Pictures, OfBothStoragesAreTheSameToRounding)
{
    TemporaryFolder folder;
    for (const char* scene : {"colonnade", "cornell_area"}) {
        const ImageF dense = read_exr(picture_of(folder, scene, "dense"));
        const ImageF bricks = read_exr(picture_of(folder, scene, "bricks"));
        double squares = 0.0, largest = 0.0, sum = 0.0;
        for (std::size_t i = 0; i < dense.pixels.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const double a = double(dense.pixels[i][c]), b = double(bricks.pixels[i][c]);
                squares += (a - b) * (a - b);
                sum += a * a;
                largest = std::max(largest, std::abs(a - b) / std::max(std::abs(a), 1e-3));
            }
        // Few pixels have a ray that ends elsewhere (see above): cornell_area 8e-5 of the mean at 64 voxels and 256 x 256. And
        // GL_LINEAR takes its weights from a coordinate over the whole atlas, 6 x 64 texels wide: 2^-24 of that is 2e-5 of a
        // texel. Where a texel is 100 times as bright as its neighbour that is 2e-3 of the darker one.
        EXPECT_LT(std::sqrt(squares / sum), 5e-4) << scene;
        RecordProperty(std::string(scene) + "_largest", std::to_string(largest));
        RecordProperty(std::string(scene) + "_rmse", std::to_string(std::sqrt(squares / sum)));
    }
}

}  // namespace
}  // namespace conebook
