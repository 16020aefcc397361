// The window, under a virtual X server: the same picture as headless. Without a display: one clear line.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "image/image.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

const char* const kProgram = "12_second_bounce";

// The program's command line under xvfb-run. `run_program` puts the folder of the programs before the name.
ProgramRun run_in_window(const std::string& arguments)
{
    const std::string program = program_folder() + "/" + kProgram;
    const std::string command = "xvfb-run -a -s '-screen 0 1280x1024x24' '" + program + "' " + arguments + " 2>&1";
    ProgramRun run;
    FILE* pipe = popen(command.c_str(), "r");
    if (pipe == nullptr) return run;
    std::array<char, 4096> buffer;
    for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) run.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return run;
}

TEST(Window, ShowsWhatHeadlessShows)
{
    if (std::system("command -v xvfb-run > /dev/null") != 0) GTEST_SKIP() << "xvfb-run is not installed (package xvfb)";
    const TemporaryFolder folder;
    const std::string in_window = (folder / "window.png").string(), without = (folder / "headless.png").string();
    const std::string arguments = " --frames 2 --size 320x180 --set voxels=32 --output ";
    const ProgramRun window = run_in_window(arguments + "'" + in_window + "'");
    ASSERT_EQ(window.code, 0) << window.output;
    EXPECT_NE(window.output.find(": drawn by "), std::string::npos) << window.output;
    const ProgramRun headless = run_program(kProgram, "--headless" + arguments + "'" + without + "'");
    ASSERT_EQ(headless.code, 0) << headless.output;
    const Image8 a = read_png(in_window), b = read_png(without);
    ASSERT_EQ(a.width, 320);  // a screen without scaling: framebuffer pixels are window units
    ASSERT_EQ(a.height, 180);
    ASSERT_EQ(a.rgba.size(), b.rgba.size());
    int largest = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        largest = std::max(largest, std::abs(int(a.rgba[i]) - int(b.rgba[i])));
    EXPECT_LE(largest, 1);
    EXPECT_GT(*std::max_element(a.rgba.begin(), a.rgba.end() - 1), 100) << "the picture is black";
}

TEST(Window, WithoutADisplaySaysSoInOneLine)
{
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    const TemporaryFolder folder;
    const ProgramRun run = run_program(kProgram, "--frames 1 --output '" + (folder / "x.png").string() + "'");
    EXPECT_GT(run.code, 0);
    EXPECT_LT(run.code, 128);
    EXPECT_NE(run.output.find("--headless"), std::string::npos) << run.output;
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace conebook
