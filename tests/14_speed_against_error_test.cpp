// Chapter 14: counted fetches against a walk on the CPU, what the formats of the pyramids may cost, and what the
// program writes. The report's own tests: 14_report_test.py.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "09_specular_cones/specular_cones.hpp"
#include "lit_scene.hpp"
#include "program.hpp"
#include "robustness/gltf_builder.hpp"
#include "temporary_folder.hpp"
#include "voxel_pipeline.hpp"
#include "walk_oracle.hpp"

namespace conebook {
namespace {

// --- Fetches ---

// A wide floor seen from straight above, with nothing over it but a scrap in a corner that gives the bounds their
// height: every cone leaves through the top, and meets nothing.
std::filesystem::path write_open_floor(const std::filesystem::path& folder, double roughness, float height_m)
{
    test::GltfBuilder gltf;
    const auto add = [&](const std::vector<float>& corners, int material) {
        const int position = gltf.add_floats(corners, 3);
        const int mesh = gltf.add_mesh({{"attributes", {{"POSITION", position}}}, {"material", material}});
        gltf.add_node({{"mesh", mesh}});
    };
    for (const double rough : {roughness, 1.0})
        gltf.append("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 1.0}, {"roughnessFactor", rough}}}});
    add({-6, 0, 6, 6, 0, 6, 6, 0, -6, -6, 0, 6, 6, 0, -6, -6, 0, -6}, 0);
    add({5.9f, height_m, 6, 6, height_m, 6, 6, height_m, 5.9f}, 1);
    gltf.append("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 0.0017}, {"znear", 0.01}}}});
    const double half_turn = std::sqrt(0.5);  // looks down
    gltf.add_node({{"camera", 0}, {"translation", {0.03, 0.8, 0.03}}, {"rotation", {-half_turn, 0.0, 0.0, half_turn}}});
    gltf.root["scenes"][0]["nodes"] = {0, 1, 2};
    return test::write_file(folder / "open_floor.glb", gltf.glb());
}

// The walk volume of a file, and how many of its texels a ray looks at on its way through nothing.
class OpenFloor {
public:
    OpenFloor(const std::filesystem::path& file, int voxels) : lit_(load_scene(file), voxels), walk_(test_gl().shaders)
    {
        walk_.run(lit_.grid, lit_.faces);
        cells_ = WalkCells(walk_);
    }

    // From above the floor's voxels by `offset`, in double precision; one more to see whether the bounds are closed.
    int texels(double offset, const glm::dvec3& direction) const
    {
        const shared::GridData& grid = lit_.grid.data();
        const glm::dvec3 floor_point = (glm::dvec3(0.03, 0.0, 0.03) - glm::dvec3(grid.origin)) / double(grid.origin.w);
        const glm::dvec3 start(floor_point.x, std::floor(floor_point.y + 0.01) + 0.5 + offset, floor_point.z);
        return cells_.texels(start, direction, cells_.exit_distance(grid, start, direction) - 1e-3) + 1;
    }

private:
    LitScene lit_;
    WalkVolume walk_;
    WalkCells cells_;
};

double value_of(const nlohmann::json& stats, const std::string& name)
{
    for (const auto& count : stats.at("counts"))
        if (count.at("name") == name) return count.at("value");
    throw std::runtime_error("no count " + name);
}

nlohmann::json counted(const std::filesystem::path& scene, const std::string& set)
{
    const TemporaryFolder folder;
    const std::string file = (folder / "stats.json").string();
    const ProgramRun run =
        run_program("14_speed_against_error", "--headless --size 8x8 --scene '" + scene.string() + "' --stats '" + file +
                                                  "' --set count_fetches=on bounces=1 " + set);
    if (run.code != 0) throw std::runtime_error(run.output);
    return nlohmann::json::parse(std::ifstream(file));
}

TEST(Fetches, OfOneNarrowConeAreThoseOfItsLeaps)
{
    const TemporaryFolder folder;
    for (const float height_m : {1.0f, 1.5f, 3.0f}) {  // a mirror: the cone goes straight up
        const std::filesystem::path file = write_open_floor(folder.path(), 0.0, height_m);
        const OpenFloor floor(file, 96);
        const nlohmann::json stats = counted(file, "voxels=96");
        EXPECT_EQ(value_of(stats, "walk steps per pixel, specular"),
                  floor.texels(double(SpecularConeParams{}.specular_start), {0.0, 1.0, 0.0}))
            << height_m;
        EXPECT_EQ(value_of(stats, "fetches per pixel, specular"), 0.0) << "there is no light to read";
    }
}

// In a closed room every cone ends once, where it reads the three faces that look against it, of rgba in one texel or of
// coverage and light apart.
TEST(Fetches, OfAClosedRoomAreThreeFacesACone)
{
    for (const int cones : {5, 16}) {
        const std::string set = "voxels=32 cones=" + std::to_string(cones);
        EXPECT_EQ(value_of(counted(asset("white_furnace"), set), "fetches per point, diffuse"), 3.0 * cones);
        EXPECT_EQ(value_of(counted(asset("white_furnace"), set + " format=r11g11b10f"), "fetches per point, diffuse"),
                  2.0 * 3.0 * cones);
    }
}

// --- Formats ---

Scene shining_scene()
{
    SceneBuilder b;
    b.box({-1.0f, -0.7f, -0.8f}, {1.0f, 0.7f, 0.8f}, b.material(lambert({0.7f, 0.5f, 0.3f})), true);
    b.sphere({0.2f, -0.1f, 0.15f}, 0.4f, b.material(emitter({3.0f, 2.0f, 0.5f}, 0.4f)), 24);
    b.point_light({-0.5f, 0.5f, 0.3f}, glm::vec3(2.0f));
    return b.build();
}

VoxelPipeline with_format(LightFormat format)
{
    PyramidParams params;
    params.format = format;
    return VoxelPipeline(shining_scene(), 40, {}, params);
}

TEST(Formats, EightBitsAreWithinHalfAUnitOfTheBrightestFace)
{
    const VoxelPipeline exact = with_format(LightFormat::rgba16f), coarse = with_format(LightFormat::rgba8);
    double scale = 0.0;
    for (const LitFace& face : exact.faces())
        for (int c = 0; c < 3; ++c) scale = std::max(scale, double(face.radiance[c]));
    ASSERT_GT(scale, 3.0);
    const PyramidLevel a = exact.level(0), b = coarse.level(0);
    double largest = 0.0, worst = 0.0;
    for (std::size_t i = 0; i < a.texels.size(); ++i)
        for (int c = 0; c < 4; ++c) {
            const double unit = c == 3 ? 1.0 : scale;
            // Half a unit of the eight bits, and half a unit of the half floats that it is compared with.
            const double allowed = unit * 0.5 / 255.0 + a.texels[i][c] * std::ldexp(1.0, -11) + 1e-6;
            worst = std::max(worst, std::abs(unit * b.texels[i][c] - a.texels[i][c]) / allowed);
            largest = std::max(largest, b.texels[i][c]);
        }
    EXPECT_LT(worst, 1.01);
    EXPECT_GT(worst, 0.5) << "nothing was rounded: is this another format?";
    EXPECT_LE(largest, 1.0);
}

TEST(Formats, ShortFloatsRoundToTheNearest)
{
    const VoxelPipeline exact = with_format(LightFormat::rgba16f), coarse = with_format(LightFormat::r11g11b10f);
    PyramidParams params;
    params.format = LightFormat::r11g11b10f;
    const LitScene lit(shining_scene(), 40, {}, params);
    ASSERT_TRUE(bool(lit.pyramid.coverage()));
    for (int level = 0; level < exact.levels(); ++level) {
        const PyramidLevel a = exact.level(level), b = coarse.level(level);
        const std::vector<float> coverage = gl::read_floats(lit.pyramid.coverage(), level, 1);
        double worst = 0.0;
        glm::dvec3 sum_a(0.0), sum_b(0.0);
        for (std::size_t i = 0; i < a.texels.size(); ++i) {
            sum_a += glm::dvec3(a.texels[i]);
            sum_b += glm::dvec3(b.texels[i]);
            if (level > 0) continue;
            EXPECT_NEAR(double(coverage[i]), a.texels[i].a, 0.5 / 255.0 + std::ldexp(1.0, -11));
            for (int c = 0; c < 3; ++c) {
                // 6 or 5 bits of mantissa: half a unit is at most 2^-7 or 2^-6 of the value.
                const double half_unit = std::ldexp(1.0, c == 2 ? -6 : -7) + std::ldexp(1.0, -11);
                worst =
                    std::max(worst, std::abs(b.texels[i][c] - a.texels[i][c]) / (a.texels[i][c] * half_unit + 1e-5));
            }
        }
        EXPECT_LT(worst, 1.01);
        // Rounding to the nearest leaves sums alone: cutting off would lose a half unit, 0.4 to 1.6 %, at each level.
        // Coverage in eight bits moves what the front hides of the back, hence not less than this.
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(sum_b[c], sum_a[c], 0.006 * sum_a[c]) << "level " << level << " channel " << c;
    }
}

// --- The program ---

class Program : public testing::Test {
protected:
    std::string run(const std::string& name, const std::string& options)
    {
        const ProgramRun result =
            run_program("14_speed_against_error", "--headless --size 64x64 --output " + file(name) + " --stats " +
                                                      file(name) + ".json " + options);
        EXPECT_EQ(result.code, 0) << result.output;
        return file(name);
    }
    nlohmann::json stats(const std::string& name) { return nlohmann::json::parse(std::ifstream(file(name) + ".json")); }
    std::string file(const std::string& name) { return (folder_.path() / name).string(); }

private:
    TemporaryFolder folder_;
};

std::string scene_of(const std::string& name) { return "--scene " + asset(name).string() + " --set voxels=32"; }
const std::string kGlossyRoom = scene_of("glossy_room"), kEmissiveBox = scene_of("cornell_area");

TEST_F(Program, CountingChangesNoPictureAndAgreesWithItsView)
{
    const ImageF plain = read_exr(run("plain.exr", kGlossyRoom));
    const ImageF counted = read_exr(run("counted.exr", kGlossyRoom + " count_fetches=on"));
    EXPECT_TRUE(plain.pixels == counted.pixels);
    // A pixel is shown what its point looked up: each point of 2 x 2 pixels four times.
    const ImageF view = read_exr(run("view.exr", kGlossyRoom + " --view fetches"));
    double diffuse = 0.0, specular = 0.0, covered = 0.0, lobes = 0.0;
    for (const glm::vec4& pixel : view.pixels) {
        if (pixel.a == 0.0f) continue;
        covered += 1.0;
        diffuse += double(pixel.r);
        specular += double(pixel.g);
        lobes += pixel.g > 0.0f ? 1.0 : 0.0;
        EXPECT_EQ(pixel.b, pixel.r + pixel.g);
    }
    ASSERT_EQ(covered, 64.0 * 64.0) << "every pixel of a room shows a surface, and every point gathers";
    for (const std::string name : {"counted.exr", "view.exr"}) {
        const auto both = [&](const std::string& kind) {
            const std::string of = kind == "diffuse" ? " per point, " : " per pixel, ";
            return value_of(stats(name), "walk steps" + of + kind) + value_of(stats(name), "fetches" + of + kind);
        };
        EXPECT_NEAR(both("diffuse"), diffuse / covered, 1e-6 * diffuse / covered);
        EXPECT_NEAR(both("specular"), specular / lobes, 1e-6 * specular / lobes);
        EXPECT_EQ(value_of(stats(name), "points that gather, per pixel"), 0.25);
    }
    EXPECT_GT(specular, 0.0);
}

TEST_F(Program, ItsPartsAddUpAndThePictureStays)
{
    const ImageF asked = read_exr(run("asked.exr", kGlossyRoom + " write_parts=on"));
    const ImageF sum = read_exr(file("asked_final.exr"));
    const ImageF direct = read_exr(file("asked_direct.exr")), diffuse = read_exr(file("asked_indirect_diffuse.exr"));
    const ImageF specular = read_exr(file("asked_indirect_specular.exr"));
    EXPECT_TRUE(asked.pixels == sum.pixels);
    double light = 0.0, specular_light = 0.0;
    for (std::size_t i = 0; i < sum.pixels.size(); ++i) {  // nothing in this scene emits
        const glm::vec3 added =
            glm::vec3(direct.pixels[i]) + glm::vec3(diffuse.pixels[i]) + glm::vec3(specular.pixels[i]);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(added[c], sum.pixels[i][c], 1e-6f + 1e-5f * sum.pixels[i][c]);
        light += double(sum.pixels[i].g);
        specular_light += double(specular.pixels[i].g);
    }
    EXPECT_GT(light, 0.0);
    EXPECT_GT(specular_light, 0.0);
}

TEST_F(Program, FormatsShowTheSameRoom)
{
    // With an emitter, whose light is kept apart in half floats, and without.
    for (const std::string& scene : {kEmissiveBox, kGlossyRoom}) {
        const ImageF exact = read_exr(run("rgba16f.exr", scene + " shadows=cone"));
        for (const std::string format : {"rgba8", "r11g11b10f"}) {
            const ImageF coarse = read_exr(run(format + ".exr", scene + " shadows=cone format=" + format));
            double sum = 0.0, difference = 0.0;
            for (std::size_t i = 0; i < exact.pixels.size(); ++i)
                for (int c = 0; c < 3; ++c) {
                    sum += double(exact.pixels[i][c]);
                    difference += std::abs(double(coarse.pixels[i][c] - exact.pixels[i][c]));
                }
            EXPECT_LT(difference / sum, 0.02) << scene << " " << format;
            EXPECT_GT(difference, 0.0) << format << " was not used";
        }
    }
    const auto pyramid_bytes = [&](const std::string& name) {
        std::size_t bytes = 0;
        for (const auto& resource : stats(name).at("resources"))
            if (resource.at("name") == "light pyramid" || resource.at("name") == "coverage pyramid")
                bytes += resource.at("bytes").get<std::size_t>();
        return bytes;
    };
    EXPECT_EQ(2 * pyramid_bytes("rgba8.exr"), pyramid_bytes("rgba16f.exr"));
    EXPECT_EQ(8 * pyramid_bytes("r11g11b10f.exr"), 5 * pyramid_bytes("rgba16f.exr"));
}

}  // namespace
}  // namespace conebook
