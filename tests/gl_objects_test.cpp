// Names of OpenGL objects, and the clock of the passes, on the driver at hand.
#include <string>

#include <gtest/gtest.h>

#include "app/pass_timer.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

std::string label_of(GLenum kind, GLuint id)
{
    std::string text(4096, '\0');
    GLsizei length = 0;
    glGetObjectLabel(kind, id, GLsizei(text.size()), &length, text.data());
    return text.substr(0, std::size_t(length));
}

TEST(Labels, LongOnesAreCut)
{
    const TestGl& gl = test_gl();
    GLint limit = 0;
    glGetIntegerv(GL_MAX_LABEL_LENGTH, &limit);  // with the 0 at the end
    ASSERT_GE(limit, 256);
    for (const int length : {1, limit - 1, limit, limit + 1, 4 * limit}) {
        const std::string name(std::size_t(length), 'x');
        const std::string expected = name.substr(0, std::size_t(limit) - 1);
        const gl::Buffer buffer(name, 16);
        const gl::Texture texture = gl::texture_2d(name, GL_RGBA8, {4, 4});
        const gl::Framebuffer framebuffer(name, {&texture});
        EXPECT_EQ(label_of(GL_BUFFER, buffer.id()), expected);
        EXPECT_EQ(label_of(GL_TEXTURE, texture.id()), expected);
        EXPECT_EQ(label_of(GL_FRAMEBUFFER, framebuffer.id()), expected);
        EXPECT_EQ(buffer.resource().name, name);  // the statistics have the whole name
    }
    EXPECT_TRUE(gl.log.faults().empty()) << gl.log.faults().front();
}

TEST(Labels, GroupsOfAnyNameOpenAndClose)
{
    const TestGl& gl = test_gl();
    const auto depth = [] {
        GLint value = 0;
        glGetIntegerv(GL_DEBUG_GROUP_STACK_DEPTH, &value);
        return value;
    };
    const GLint before = depth();
    for (const std::size_t length : {1u, 100000u}) {
        const gl::DebugGroup group(std::string(length, 'x'));
        EXPECT_EQ(depth(), before + 1);
    }
    EXPECT_EQ(depth(), before);
    EXPECT_TRUE(gl.log.faults().empty()) << gl.log.faults().front();
}

TEST(StorageBlocks, BeyondTheDriversLimitAreRefusedByName)
{
    test_gl();
    const std::size_t most = gl::most_storage_bytes();
    EXPECT_GE(most, std::size_t(1) << 27);  // what OpenGL 4.5 promises
    EXPECT_NO_THROW(gl::require_storage("grains", most / 8, 8, "a smaller heap"));
    try {
        gl::require_storage("grains", most / 8 + 1, 8, "a smaller heap");
        FAIL() << "not refused";
    } catch (const std::runtime_error& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find(std::to_string(most / 8 + 1) + " grains"), 0u) << message;
        EXPECT_NE(message.find(std::to_string(most >> 20) + " MiB, GL_MAX_SHADER_STORAGE_BLOCK_SIZE"),
                  std::string::npos)
            << message;
        EXPECT_NE(message.find("use a smaller heap"), std::string::npos) << message;
    }
}

class Timer : public testing::TestWithParam<PassTimer::Clock> {};

// Every run of every pass is counted once, and passes stand in the order in which they first ran, although results of GPU
// queries come later. What they say is not looked at: llvmpipe's queries do not count the work.
TEST_P(Timer, CountsEveryPassOfEveryFrame)
{
    const TestGl& gl = test_gl();
    constexpr int kFrames = 3 * PassTimer::kFramesInFlight;
    const gl::Texture texture = gl::texture_2d("texture", GL_RGBA32F, {512, 512});
    Statistics statistics;
    PassTimer timer(GetParam());
    int runs = 0;
    for (int frame = 0; frame < kFrames; ++frame) {
        const auto work = [&] {
            texture.clear();
            ++runs;
            return true;
        };
        timer.time("every frame", Scope::camera, work, statistics);
        if (frame % 2 == 1) timer.time("odd frames", Scope::light, work, statistics);
        if (frame == 0) timer.time("first frame", Scope::scene, work, statistics);
        timer.end_frame(statistics);
    }
    timer.finish(statistics);
    EXPECT_EQ(runs, kFrames + kFrames / 2 + 1);
    const TemporaryFolder folder;
    statistics.write_json(folder / "x.json");
    const nlohmann::json passes = read_statistics(folder / "x.json").at("passes");
    ASSERT_EQ(passes.size(), 3u);
    EXPECT_EQ(passes[0].at("name"), "every frame");
    EXPECT_EQ(passes[1].at("name"), "first frame");
    EXPECT_EQ(passes[2].at("name"), "odd frames");
    EXPECT_EQ(passes[0].at("frames"), kFrames);
    EXPECT_EQ(passes[1].at("frames"), 1);
    EXPECT_EQ(passes[2].at("frames"), kFrames / 2);
    EXPECT_TRUE(gl.log.faults().empty()) << gl.log.faults().front();
}

// Nothing waits for the frame at hand, and nothing is kept for ever.
TEST(GpuQueries, ResultsComeAtTheLatestWhenTheirFrameIsOld)
{
    Statistics statistics;
    PassTimer timer(PassTimer::Clock::gpu_queries);
    const TemporaryFolder folder;
    const auto frames_counted = [&] {
        statistics.write_json(folder / "x.json");
        const nlohmann::json pass = named(read_statistics(folder / "x.json"), "passes", "pass");
        return pass.is_null() ? 0 : pass.at("frames").get<int>();
    };
    for (int frame = 1; frame <= 20; ++frame) {
        timer.time(
            "pass", Scope::camera, [] { return true; }, statistics);
        const int before = frames_counted();
        EXPECT_LT(before, frame);  // this frame's is not asked for while it is drawn
        timer.end_frame(statistics);
        EXPECT_GE(frames_counted(), frame - PassTimer::kFramesInFlight + 1);
    }
    timer.finish(statistics);
    EXPECT_EQ(frames_counted(), 20);
}

INSTANTIATE_TEST_SUITE_P(Clocks, Timer,
                         testing::Values(PassTimer::Clock::cpu_around_finish, PassTimer::Clock::gpu_queries),
                         [](const auto& info) {
                             return info.param == PassTimer::Clock::gpu_queries ? "gpu_queries" : "cpu_around_finish";
                         });

}  // namespace
}  // namespace conebook
