// Chapter 14: counted fetches against a march on the CPU, what the formats of the pyramids may cost, and what the
// program writes. The report's own tests: 14_report_test.py.
#include <algorithm>
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "11_emissives/emitters.hpp"
#include "14_speed_against_error/fetch_counter.hpp"
#include "cone_pipeline.hpp"
#include "lit_scene.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"
#include "voxel_pipeline.hpp"

namespace conebook {
namespace {

// --- Fetches ---

// Steps of a cone through nothing (shaders/common/cone.glsl): as long as it is wide, at least a voxel, until `end`.
int steps_of(double end, double tan_half, double step_factor)
{
    int steps = 0;
    for (double t = 0.0; t < end; ++steps)
        t += std::min(std::max(2.0 * t * tan_half, 1.0) * step_factor, end - t + 1e-3);
    return steps;
}

// A wide floor seen from straight above, with nothing over it but a scrap in a corner that gives the bounds their
// height: every cone leaves through the top, and meets nothing.
class EmptyGrid {
public:
    EmptyGrid(float roughness, float height_m) : lit_(make_scene(roughness, height_m), 96) {}

    FetchCounts count(const LitPixelParams& params, LightFormat format = LightFormat::rgba16f)
    {
        gl::Shaders& shaders = test_gl().shaders;
        PyramidParams pyramid_params;
        pyramid_params.format = int(format);
        LightPyramid pyramid(shaders, lit_.grid, pyramid_params);
        pyramid.prepare(lit_.grid, lit_.faces);
        pyramid.run(lit_.grid, lit_.faces, lit_.shading.radiance());
        GBuffer g_buffer(shaders, {8, 8});
        g_buffer.draw(lit_.scene, 
                      camera_data(at_point({0.03f, 0.8f, 0.03f}, {0.03f, 0.0f, 0.03f}), g_buffer.size(), lit_.scene.bounds()));
        const SpecularCones specular(shaders);
        const Emitters emitters(shaders, {}, lit_.grid, lit_.voxelizer, {});
        FetchCounter counter(shaders, emitters.are_apart());
        counter.run(g_buffer, lit_.grid, pyramid, emitters, DiffuseConeUniforms(params.cones), &specular, params);
        return counter.counts(g_buffer);
    }

    // From where cones with this offset start to the top of the bounds, in voxels along the normal.
    double height(double offset) const
    {
        const double floor_y = (0.0 - double(lit_.grid.data().origin.y)) / double(lit_.grid.data().origin.w);
        const double voxel_middle = std::floor(floor_y + 0.01) + 0.5;
        return double(lit_.grid.data().content_max.y) - (voxel_middle + offset);
    }

private:
    static Scene make_scene(float roughness, float height_m)
    {
        SceneBuilder b;
        b.quad({-6, 0, 6}, {12, 0, 0}, {0, 0, -12}, b.material(metal(glm::vec3(0.9f), roughness)));
        b.quad({5.9f, height_m, 6}, {0.1f, 0, 0}, {0, 0, -0.1f}, b.material(lambert(0.5f)));
        b.point_light({0, 1, 0}, glm::vec3(1.0f));
        return b.build();
    }
    LitScene lit_;
};

// Two levels with three faces each. Where a cone starts and where it leaves the bounds it reads a few texels more, the
// same number under a low ceiling and under a high one: it drops out of their difference.
constexpr int kFetchesPerStep = 2 * 3;
constexpr float kLow_m = 1.0f, kHigh_m = 1.5f;  // 8 and 12 voxels
constexpr double kMostBesideSteps = 40.0;       // of one cone

TEST(Fetches, OfOneNarrowConeAreThoseOfItsSteps)
{
    EmptyGrid low(0.0f, kLow_m), high(0.0f, kHigh_m);  // a mirror: the cone goes straight up and has no width
    for (const float step : {0.25f, 0.5f, 1.0f, 2.0f}) {
        LitPixelParams params;
        params.cones.step = step;
        const auto steps = [&](const EmptyGrid& empty) {
            const double end = empty.height(params.specular.specular_start) + 1.0;  // a voxel beyond the bounds
            const int count = steps_of(end, 0.0, step);
            EXPECT_NEAR(count, end / step, 1.0);
            return count;
        };
        const double counted_low = low.count(params).specular, counted_high = high.count(params).specular;
        EXPECT_EQ(counted_high - counted_low, kFetchesPerStep * (steps(high) - steps(low))) << "step " << step;
        const double beside = counted_low - kFetchesPerStep * steps(low);
        EXPECT_GE(beside, 1.0);
        EXPECT_LE(beside, kMostBesideSteps);
    }
}

TEST(Fetches, OfASetOfConesAreTheSumOfTheirs)
{
    EmptyGrid low(0.5f, kLow_m), high(0.5f, kHigh_m);
    for (const float aperture_deg : {1.0f, 5.0f}) {
        LitPixelParams params;
        params.cones.interleave = int(Interleave::off);
        params.cones.aperture = aperture_deg;
        const ConeSet set = make_cone_set(6, ConeTable::tilted, glm::radians(double(aperture_deg)));
        const double tan_half = std::tan(double(set.half_angle_rad));
        const auto steps = [&](const EmptyGrid& empty) {
            int count = 0;
            for (const glm::vec4& cone : set.cones) {
                const double exit = empty.height(params.cones.start_offset) / double(cone.z);
                const double end = exit + std::max(2.0 * exit * tan_half, 1.0) / double(cone.z);
                EXPECT_LT(end * std::sqrt(1.0 - double(cone.z * cone.z)), 48.0) << "leaves by a side";
                count += steps_of(end, tan_half, params.cones.step);
            }
            return count;
        };
        const double expected = kFetchesPerStep * (steps(high) - steps(low));
        EXPECT_EQ(high.count(params).diffuse - low.count(params).diffuse, expected) << "aperture " << aperture_deg;
        // Coverage apart: two fetches for each.
        const LightFormat apart = LightFormat::r11g11b10f;
        EXPECT_EQ(high.count(params, apart).diffuse - low.count(params, apart).diffuse, 2.0 * expected);
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
    params.format = int(format);
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
    params.format = int(LightFormat::r11g11b10f);
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

double value_of(const nlohmann::json& stats, const std::string& name)
{
    for (const auto& count : stats.at("counts"))
        if (count.at("name") == name) return count.at("value");
    throw std::runtime_error("no count " + name);
}

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

std::string asset(const std::string& name)
{
    const char* root = std::getenv("CONEBOOK_ROOT");
    return "--scene " + std::string(root ? root : "") + "/assets/" + name + ".glb --set voxels=32";
}
const std::string kGlossyRoom = asset("glossy_room"), kEmissiveBox = asset("cornell_area");

TEST_F(Program, CountingChangesNoPictureAndAgreesWithItsView)
{
    const ImageF plain = read_exr(run("plain.exr", kGlossyRoom));
    const ImageF counted = read_exr(run("counted.exr", kGlossyRoom + " count_fetches=on"));
    EXPECT_TRUE(plain.pixels == counted.pixels);
    const ImageF view = read_exr(run("view.exr", kGlossyRoom + " --view fetches"));
    double diffuse = 0.0, specular = 0.0, largest = 0.0, covered = 0.0;
    for (const glm::vec4& pixel : view.pixels) {
        if (pixel.a == 0.0f) continue;
        covered += 1.0;
        diffuse += double(pixel.r);
        specular += double(pixel.g);
        largest = std::max(largest, double(pixel.b));
    }
    for (const std::string name : {"counted.exr", "view.exr"}) {
        EXPECT_NEAR(value_of(stats(name), "fetches per pixel, diffuse"), diffuse / covered, 1e-6 * diffuse / covered);
        EXPECT_NEAR(value_of(stats(name), "fetches per pixel, specular"), specular / covered,
                    1e-6 * specular / covered);
        EXPECT_EQ(value_of(stats(name), "fetches of the worst pixel"), largest);
    }
    EXPECT_GT(specular, 0.0);
    EXPECT_GT(diffuse, specular);
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
