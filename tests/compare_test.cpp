// The measures against pictures whose difference is known by construction, and the two programs' command lines.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "program.hpp"
#include "reference/compare_images.hpp"
#include "reference/flip.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

ImageF random_image(int width, int height, int seed)
{
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> uniform(0.1f, 2.0f);
    ImageF image{width, height, {}};
    for (int i = 0; i < width * height; ++i)
        image.pixels.emplace_back(uniform(random), uniform(random), uniform(random), 1.0f);
    return image;
}

ImageF constant(int width, int height, const glm::vec3& value)
{
    return {width, height, std::vector<glm::vec4>(std::size_t(width) * height, glm::vec4(value, 1.0f))};
}

CompareOptions without_flip(int block = 1)
{
    CompareOptions o;
    o.flip = false;
    o.block = block;
    return o;
}

TEST(Compare, EqualPicturesHaveNoError)
{
    const ImageF image = random_image(40, 30, 1);
    const ImageMetrics m = compare_images(image, image);
    EXPECT_EQ(m.pixels, 1200u);
    EXPECT_EQ(m.signed_ratio, 1.0);
    for (const double x : {m.bias, m.rmse, m.nrmse, m.rel_mse, m.mape, m.smape, m.relative_error_p95, *m.flip})
        EXPECT_EQ(x, 0.0);
    const ImageF black = constant(8, 8, glm::vec3(0));
    const ImageMetrics b = compare_images(black, black);
    EXPECT_EQ(b.signed_ratio, 1.0);
    EXPECT_EQ(b.smape, 0.0);
}

// I = c R: every relative measure has a closed form in c.
TEST(Compare, ScaledPicture)
{
    for (const double c : {0.25, 0.5, 2.0}) {
        const ImageF reference = constant(16, 16, glm::vec3(3));
        const ImageMetrics m = compare_images(constant(16, 16, glm::vec3(float(3 * c))), reference, without_flip());
        const double d = std::abs(c - 1.0);
        EXPECT_NEAR(m.signed_ratio, c, 1e-7);
        EXPECT_NEAR(m.bias, 3.0 * (c - 1.0), 1e-6);
        EXPECT_NEAR(m.rmse, 3.0 * d, 1e-6);
        EXPECT_NEAR(m.nrmse, d, 1e-6);
        EXPECT_NEAR(m.smape, d / (c + 1.0), 1e-6);
        EXPECT_NEAR(m.mape, d / 1.01, 1e-6);
        EXPECT_NEAR(m.relative_error_p95, d / 1.01, 1e-6);
        EXPECT_NEAR(m.rel_mse, d * d / 1.01, 1e-6);
        ImageF varied = random_image(20, 20, 5), scaled = varied;
        for (glm::vec4& p : scaled.pixels) p = glm::vec4(glm::vec3(p) * float(c), 1.0f);
        EXPECT_NEAR(compare_images(scaled, varied, without_flip()).smape, d / (c + 1.0), 1e-6);
        EXPECT_NEAR(compare_images(scaled, varied, without_flip()).signed_ratio, c, 1e-6);
    }
}

TEST(Compare, PercentileIsOfTheLargestErrors)
{
    const ImageF reference = constant(100, 1, glm::vec3(1));
    ImageF image = reference;
    for (int x = 0; x < 100; ++x) image.at(x, 0) = glm::vec4(glm::vec3(1.0f + float(x) / 101.0f), 1.0f);
    // Errors x/101 over 1 + 0.01, three equal ones per pixel: the 285th of 300 is that of x = 94.
    EXPECT_NEAR(compare_images(image, reference, without_flip()).relative_error_p95, 94.0 / 101.0 / 1.01, 1e-6);
}

TEST(Compare, PixelsWithoutGeometryAreLeftOut)
{
    ImageF reference = random_image(20, 10, 2), image = reference;
    for (int x = 0; x < 20; x += 2) {
        reference.at(x, 3).a = 0.0f;
        image.at(x, 3) = glm::vec4(1e4f);
    }
    const ImageMetrics m = compare_images(image, reference, without_flip());
    EXPECT_EQ(m.pixels, 190u);
    EXPECT_EQ(m.rmse, 0.0);
    for (const int block : {2, 5, 7}) EXPECT_EQ(compare_images(image, reference, without_flip(block)).rmse, 0.0);
    for (glm::vec4& p : reference.pixels) p.a = 0.0f;
    EXPECT_THROW(compare_images(image, reference, without_flip()), std::runtime_error);
}

TEST(Compare, BlocksAverageFirst)
{
    const ImageF reference = constant(16, 16, glm::vec3(1));
    ImageF image = reference;
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) image.at(x, y) += glm::vec4(glm::vec3((x + y) % 2 ? 0.25f : -0.25f), 0.0f);
    EXPECT_NEAR(compare_images(image, reference, without_flip()).rmse, 0.25, 1e-7);
    EXPECT_NEAR(compare_images(image, reference, without_flip(2)).rmse, 0.0, 1e-7);
    EXPECT_NEAR(compare_images(image, reference, without_flip(2)).signed_ratio, 1.0, 1e-7);
    // 3 x 3 blocks keep one pixel of the nine too many: 0.25 / 9, but for the last row and column of blocks.
    EXPECT_GT(compare_images(image, reference, without_flip(3)).rmse, 0.25 / 9 - 1e-6);
}

// Reference = truth + noise of known size; picture = truth + known error: the noise is taken out again.
TEST(Compare, NoiseOfTheReferenceIsSubtracted)
{
    const double sigma = 0.1, error = 0.05;
    const int size = 256;
    std::mt19937 random(11);
    std::normal_distribution<float> normal(0.0f, float(sigma));
    ImageF reference = constant(size, size, glm::vec3(1)), noise = constant(size, size, glm::vec3(float(sigma)));
    for (glm::vec4& p : reference.pixels) p += glm::vec4(normal(random), normal(random), normal(random), 0.0f);
    const ImageF image = constant(size, size, glm::vec3(float(1.0 + error)));
    CompareOptions o = without_flip();
    o.reference_error = &noise;
    const ImageMetrics m = compare_images(image, reference, o);
    // n = 196608: MSE scatters by about sqrt(2 s^4 + 4 s^2 e^2) / sqrt(n) = 4e-5, thus its root by 4e-4.
    EXPECT_NEAR(m.rmse, std::hypot(sigma, error), 1e-3);
    EXPECT_NEAR(*m.rmse_without_noise, error, 1.2e-3);
    EXPECT_NEAR(*m.noise_rms, sigma, 1e-6);
    EXPECT_TRUE(m.noisy_reference);
    // Of the truth itself SMAPE finds the noise: |s| / (2 + s), whose mean is that of |s| / 2 to the order of s^2.
    const ImageMetrics truth = compare_images(constant(size, size, glm::vec3(1)), reference, o);
    EXPECT_NEAR(*truth.noise_smape, truth.smape, sigma * sigma * truth.smape);
    EXPECT_NEAR(truth.smape, sigma * std::sqrt(2.0 / M_PI) / 2.0, 0.01 * sigma);
    o.block = 16;  // noise falls by 16
    const ImageMetrics blocks = compare_images(image, reference, o);
    EXPECT_NEAR(*blocks.noise_rms, sigma / 16, 1e-6);
    EXPECT_NEAR(*blocks.rmse_without_noise, error, 1.2e-3);
    for (glm::vec4& p : noise.pixels) p *= 0.01f;
    o.block = 1;
    EXPECT_FALSE(compare_images(image, reference, o).noisy_reference);
}

TEST(Compare, NanInfinityAndSizesAreErrors)
{
    const ImageF good = random_image(8, 8, 3);
    for (const float bad : {NAN, INFINITY, -INFINITY}) {
        ImageF broken = good;
        broken.at(3, 5).y = bad;
        EXPECT_THROW(compare_images(broken, good), std::runtime_error);
        EXPECT_THROW(compare_images(good, broken), std::runtime_error);
    }
    EXPECT_THROW(compare_images(good, random_image(8, 9, 3)), std::runtime_error);
    EXPECT_THROW(compare_images(good, good, without_flip(0)), std::runtime_error);
}

TEST(Compare, HeatmapShowsSignAndMask)
{
    ImageF reference = constant(3, 1, glm::vec3(1));
    ImageF image = reference;
    image.at(0, 0) = glm::vec4(2, 2, 2, 1);
    image.at(1, 0) = glm::vec4(0.5f, 0.5f, 0.5f, 1);
    reference.at(2, 0).a = 0.0f;
    const Image8 map = error_heatmap(image, reference);
    EXPECT_GT(map.rgba[0], map.rgba[2]);
    EXPECT_GT(map.rgba[6], map.rgba[4]);
    EXPECT_EQ(map.rgba[8], map.rgba[9]);
    EXPECT_GT(map.rgba[8], 0);
}

// Uniform pictures have no features and the filters keep them, so FLIP is the colour term alone: HyAB of the
// Hunt-adjusted Lab values. Grey against grey: |L1 - L2|.
TEST(Flip, UniformGreysFollowTheColourTerm)
{
    const auto lightness = [](double y) { return 116.0 * std::cbrt(y) - 16.0; };
    const auto largest =
        [&] {  // HyAB between green and blue, after the Hunt adjustment, to the power 0.7: from the paper's code
            const ImageF green = constant(8, 8, {0, 1, 0}), blue = constant(8, 8, {0, 0, 1});
            return double(ldr_flip(green, blue)[20]);
        }();
    EXPECT_NEAR(largest, 1.0, 1e-4);  // the scale's end by definition
    double before = 0.0;
    for (const double grey : {0.45, 0.4, 0.3, 0.1, 0.02}) {
        const double flip = ldr_flip(constant(40, 40, glm::vec3(float(grey))), constant(40, 40, glm::vec3(0.5f)))[820];
        // Below the cut the term is proportional to |dL|^0.7: ratios do not depend on the end of the scale.
        const double reference = ldr_flip(constant(40, 40, glm::vec3(0.49f)), constant(40, 40, glm::vec3(0.5f)))[820];
        const double expected =
            reference * std::pow((lightness(0.5) - lightness(grey)) / (lightness(0.5) - lightness(0.49)), 0.7);
        if (grey >= 0.1) {
            EXPECT_NEAR(flip, expected, 2e-3);
        }
        EXPECT_GT(flip, before);
        before = flip;
    }
}

TEST(Flip, SymmetricBoundedAndWorseForLargerErrors)
{
    const ImageF reference = random_image(48, 32, 4);
    double before = 0.0;
    for (const float amount : {0.01f, 0.05f, 0.2f, 0.8f}) {
        ImageF image = reference;
        for (int y = 8; y < 24; ++y)
            for (int x = 8; x < 24; ++x) image.at(x, y) *= glm::vec4(glm::vec3(1.0f + amount), 1.0f);
        const auto forth = ldr_flip(image, reference), back = ldr_flip(reference, image);
        for (std::size_t i = 0; i < forth.size(); ++i) {
            ASSERT_NEAR(forth[i], back[i], 1e-5);
            ASSERT_GE(forth[i], 0.0f);
            ASSERT_LE(forth[i], 1.0f);
        }
        const double mean = hdr_flip_mean(image, reference);
        EXPECT_GT(mean, before);
        before = mean;
    }
}

class Programs : public testing::Test {
protected:
    void SetUp() override
    {
        if (program_folder().empty()) GTEST_SKIP() << "$CONEBOOK_BIN names no folder of programs";
    }
    static void expect_one_line(const ProgramRun& run, const std::string& part)
    {
        EXPECT_EQ(run.code, 1);
        EXPECT_NE(run.output.find(part), std::string::npos) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    }
    TemporaryFolder folder_;
    std::string path(const std::string& name) const { return "'" + (folder_ / name).string() + "'"; }
};

TEST_F(Programs, CompareWritesWhatTheLibraryMeasures)
{
    const ImageF image = random_image(32, 24, 8), reference = random_image(32, 24, 9);
    write_exr(folder_ / "i.exr", image);
    write_exr(folder_ / "r.exr", reference);
    const auto run = run_program(
        "compare", path("i.exr") + " " + path("r.exr") + " --json " + path("m.json") + " --heatmap " + path("h.png"));
    ASSERT_EQ(run.code, 0) << run.output;
    EXPECT_EQ(run.output.rfind("signed ratio", 0), 0u) << run.output;
    std::ifstream in(folder_ / "m.json");
    const auto json = nlohmann::json::parse(in);
    const ImageMetrics m = compare_images(image, reference);
    EXPECT_NEAR(json["signed_ratio"].get<double>(), m.signed_ratio, 1e-12);
    EXPECT_NEAR(json["smape"].get<double>(), m.smape, 1e-12);
    EXPECT_NEAR(json["hdr_flip"].get<double>(), *m.flip, 1e-12);
    EXPECT_EQ(read_png(folder_ / "h.png").rgba, error_heatmap(image, reference).rgba);
}

TEST_F(Programs, CompareRefusesBadInput)
{
    write_exr(folder_ / "i.exr", random_image(4, 4, 1));
    write_exr(folder_ / "r.exr", random_image(4, 5, 1));
    ImageF nan = random_image(4, 4, 1);
    nan.at(1, 2).x = NAN;
    write_exr(folder_ / "nan.exr", nan);
    expect_one_line(run_program("compare", path("i.exr") + " " + path("r.exr")), "sizes differ");
    expect_one_line(run_program("compare", path("nan.exr") + " " + path("i.exr")), "NaN");
    expect_one_line(run_program("compare", path("i.exr") + " " + path("nan.exr")), "NaN");
    expect_one_line(run_program("compare", path("i.exr") + " " + path("none.exr")), "none.exr: no such file");
    expect_one_line(run_program("compare", path("i.exr")), "reference");
    expect_one_line(run_program("compare", path("i.exr") + " " + path("i.exr") + " --block 0"), "block");
    const auto unwritable =
        run_program("compare", path("i.exr") + " " + path("i.exr") + " --json " + path("none/m.json"));
    EXPECT_EQ(unwritable.code, 1);
    EXPECT_NE(unwritable.output.find("m.json: cannot be written"), std::string::npos) << unwritable.output;
}

TEST_F(Programs, ReferenceRefusesBadInput)
{
    const std::string output = " --output " + path("a.exr");
    expect_one_line(run_program("reference", "--scene " + path("none.glb") + output), "none.glb");
    std::ofstream(folder_ / "broken.glb") << "glTF, but not really";
    expect_one_line(run_program("reference", "--scene " + path("broken.glb") + output), "broken.glb");
    expect_one_line(run_program("reference", "--scene x.glb --size 0x10" + output), "--size");
    expect_one_line(run_program("reference", "--scene x.glb --size 10" + output), "--size");
    expect_one_line(run_program("reference", "--scene x.glb --spp 0" + output), "spp");
    expect_one_line(run_program("reference", "--scene x.glb --bounces -2" + output), "bounces");
    expect_one_line(run_program("reference", "--scene x.glb --part all" + output), "unknown part");
    expect_one_line(run_program("reference", "--scene x.glb --output " + path("a.png")), ".exr");
    expect_one_line(run_program("reference", "--scene x.glb"), "output");
    EXPECT_FALSE(std::filesystem::exists(folder_ / "a.exr"));
}

}  // namespace
}  // namespace conebook
