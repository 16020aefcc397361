// A still picture gets better: the mean of frames with other cone directions and sub-pixel offsets against the path tracer.
#include <string>

#include <gtest/gtest.h>

#include "image/image.hpp"
#include "program.hpp"
#include "reference/compare_images.hpp"
#include "reference/path_tracer.hpp"
#include "scene/scene.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

constexpr int kSize = 64;  // pixels

ImageF frames_of(const std::string& scene, int frames, const std::string& set = "")
{
    const TemporaryFolder folder;
    const std::string file = (folder / "picture.exr").string();
    const std::string size = std::to_string(kSize) + "x" + std::to_string(kSize);
    const ProgramRun run =
        run_program("12_second_bounce", "--headless --size " + size + " --scene '" + asset(scene).string() +
                                            "' --frames " + std::to_string(frames) + " --output '" + file +
                                            "' --set voxels=64 " + set);
    EXPECT_EQ(run.code, 0) << run.output;
    return run.code == 0 ? read_exr(file) : ImageF{1, 1, {glm::vec4(0.0f)}};
}

class Accumulation : public testing::TestWithParam<const char*> {};

// Edges of things: one sample a pixel is off by up to the whole difference of both sides, sixteen by a quarter of it.
TEST_P(Accumulation, BringsEveryPixelNearerToTheTruth)
{
    const Scene scene = load_scene(asset(GetParam()));
    PathTraceOptions options;
    options.width = options.height = kSize;
    options.spp = 256;
    options.bounces = -1;
    const PathTraceResult truth = path_trace(scene, choose_camera(scene, {}), options);
    CompareOptions by_pixel;
    by_pixel.flip = false;
    by_pixel.reference_error = &truth.errors[0];
    const double once = compare_images(frames_of(GetParam(), 1), truth.pictures[0], by_pixel).rmse_without_noise.value();
    const double often = compare_images(frames_of(GetParam(), 16), truth.pictures[0], by_pixel).rmse_without_noise.value();
    std::printf("%s: RMSE %.5f after one frame, %.5f after sixteen\n", GetParam(), once, often);
    EXPECT_LT(often, 0.75 * once);  // measured: 0.65 and 0.44 of it
}
INSTANTIATE_TEST_SUITE_P(Scenes, Accumulation, testing::Values("cornell_box", "colonnade"),
                         [](const auto& info) { return std::string(info.param); });

TEST(AccumulationSequence, IsTheSameInEveryRun)
{
    EXPECT_EQ(frames_of("cornell_box", 5).pixels, frames_of("cornell_box", 5).pixels);
    EXPECT_NE(frames_of("cornell_box", 5).pixels, frames_of("cornell_box", 1).pixels);
}

TEST(AccumulationSequence, OffEveryFrameIsTheFirst)
{
    EXPECT_EQ(frames_of("cornell_box", 5, "accumulate=off").pixels, frames_of("cornell_box", 1).pixels);
}

}  // namespace
}  // namespace conebook
