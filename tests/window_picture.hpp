// What a window shows against what headless makes of the same arguments. Header only.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "image/image.hpp"
#include "window_program.hpp"

#define SKIP_WITHOUT_A_SCREEN()                     \
    for (const char* command : {"Xvfb", "xdotool"}) \
        if (!is_installed(command)) GTEST_SKIP() << command << " is not installed (packages xvfb, xdotool)"

namespace conebook {

struct Difference {
    int largest = 0;     // of 255
    double share = 0.0;  // of the values, that differ by more than 1
};

inline Difference difference(const Image8& a, const Image8& b)
{
    if (a.rgba.size() != b.rgba.size() || a.width != b.width) return {256, 1.0};
    Difference d;
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        const int by = std::abs(int(a.rgba[i]) - int(b.rgba[i]));
        d.largest = std::max(d.largest, by);
        differ += by > 1;
    }
    d.share = double(differ) / double(a.rgba.size());
    return d;
}

// What headless makes of the same arguments.
inline Image8 headless_picture(const std::string& program, const std::string& arguments)
{
    const TemporaryFolder folder;
    const std::string picture = (folder / "headless.png").string();
    const ProgramRun run = run_program(program, "--headless " + arguments + " --output '" + picture + "'");
    EXPECT_EQ(run.code, 0) << run.output;
    return read_png(picture);
}

inline void expect_same(const std::filesystem::path& screenshot, const Image8& expected)
{
    ASSERT_FALSE(screenshot.empty()) << "no screenshot came";
    const Image8 picture = read_png(screenshot);
    ASSERT_EQ(picture.width, expected.width);
    ASSERT_EQ(picture.height, expected.height);
    EXPECT_LE(difference(picture, expected).largest, 1);
    EXPECT_GT(*std::max_element(picture.rgba.begin(), picture.rgba.end() - 1), 100) << "the picture is black";
}

}  // namespace conebook
