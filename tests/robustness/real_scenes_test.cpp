// Scenes that this project did not make: finite pictures that are neither black nor one colour, through every chapter.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "image/image.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

// Not the repository's.
std::filesystem::path scene_folder()
{
    const char* shared = std::getenv("CONEBOOK_SHARED");
    return std::filesystem::path(shared != nullptr ? shared : "") / "scenes";
}

std::vector<std::filesystem::path> scenes()
{
    std::vector<std::filesystem::path> files;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(scene_folder(), error))
        if (entry.path().extension() == ".glb") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

void expect_a_picture(const std::string& program, const std::filesystem::path& scene, const std::string& set)
{
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "picture.exr";
    const ProgramRun run = run_program(
        program, "--headless --size 160x90 --scene '" + scene.string() + "' --output '" + file.string() + "' " + set);
    ASSERT_EQ(run.code, 0) << program << " " << scene << "\n" << run.output;
    const ImageF image = read_exr(file);
    std::size_t lit = 0;
    float low = 1e30f, high = 0.0f;
    for (const glm::vec4& pixel : image.pixels) {
        for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(pixel[c]) && pixel[c] >= 0.0f) << program << " " << scene;
        const float sum = pixel.r + pixel.g + pixel.b;
        lit += sum > 1e-4f ? 1 : 0;
        low = std::min(low, sum);
        high = std::max(high, sum);
    }
    // The smallest of the scenes' figures, the buddha, fills a twelfth of the picture.
    EXPECT_GT(double(lit), 0.03 * double(image.pixels.size())) << program << " " << scene << ": hardly anything to see";
    EXPECT_GT(high, 1.5f * low) << program << " " << scene << ": all one colour";
}

class RealScene : public testing::TestWithParam<std::filesystem::path> {};
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(RealScene);

TEST_P(RealScene, GoesThroughTheWholeBook)
{
    expect_a_picture("12_second_bounce", GetParam(), "--set voxels=64 bounces=2");
}

INSTANTIATE_TEST_SUITE_P(Shared, RealScene, testing::ValuesIn(scenes()),
                         [](const auto& info) { return info.param.stem().string(); });

TEST(Sponza, GoesThroughEveryChapter)
{
    const std::filesystem::path sponza = scene_folder() / "sponza_crytek.glb";
    if (!std::filesystem::exists(sponza)) GTEST_SKIP() << sponza << " is not there; set CONEBOOK_SHARED";
    ASSERT_FALSE(chapters().empty());
    for (const std::string& chapter : chapters())
        expect_a_picture(chapter, sponza, has_voxels(chapter) ? "--set voxels=64" : "");
}

}  // namespace
}  // namespace conebook
