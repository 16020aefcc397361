// The window, under a virtual X server with real events: it shows what headless shows, whatever happened before, and it
// answers keys, mouse and resizing. Without a display: one clear line.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "window_picture.hpp"

namespace conebook {
namespace {

struct Chapter {
    std::string name, parameters;  // of a small grid, and one sample
};
const Chapter kFirst{"01_first_light", ""}, kEighth{"08_diffuse_cones", "voxels=32"},
    kTwelfth{"12_second_bounce", "voxels=32 accumulate=off"};

std::vector<std::string> window_arguments(const Chapter& chapter, const std::string& size)
{
    std::vector<std::string> words = {"--size", size};
    if (!chapter.parameters.empty()) words.push_back("--set");
    std::istringstream parameters(chapter.parameters);
    for (std::string word; parameters >> word;) words.push_back(word);
    return words;
}

std::string same_headless(const Chapter& chapter, const std::string& size, const std::string& view)
{
    return "--size " + size + " --view " + view + (chapter.parameters.empty() ? "" : " --set " + chapter.parameters);
}

class Window : public testing::TestWithParam<Chapter> {};

TEST_P(Window, FollowsKeysAndResizesAndEndsAsHeadlessDoes)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    WindowProgram window(screen, GetParam().name, window_arguments(GetParam(), "640x360"));
    ASSERT_TRUE(window.shows_whole(0)) << window.said();
    expect_same(window.screenshot(), headless_picture(GetParam().name, same_headless(GetParam(), "640x360", "final")));

    // Number keys and Tab change the view. They come faster than pictures do, so that most of these are given up.
    window.key("2 1 2 Tab Tab 1 Tab");
    ASSERT_TRUE(window.shows([](const ShownPicture& p) { return p.is_whole() && p.view == "direct"; }));
    expect_same(window.screenshot(), headless_picture(GetParam().name, same_headless(GetParam(), "640x360", "direct")));

    // Another size.
    screen.xdotool("search --name '^" + GetParam().name + "' windowsize 500 300");
    ASSERT_TRUE(window.shows([](const ShownPicture& p) { return p.is_whole() && p.window_size == "500x300"; }));
    expect_same(window.screenshot(), headless_picture(GetParam().name, same_headless(GetParam(), "500x300", "direct")));

    window.key("Escape");
    EXPECT_EQ(window.code(), 0) << window.said();
}

TEST_P(Window, TurnsByTheMouseThereAndBack)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    WindowProgram window(screen, GetParam().name, window_arguments(GetParam(), "320x180"));
    ASSERT_TRUE(window.shows_whole(0)) << window.said();
    const Image8 before = read_png(window.screenshot());
    screen.xdotool("mousedown 3 mousemove_relative 50 20 mouseup 3");
    ASSERT_TRUE(window.shows_whole(1)) << "a drag within one frame is lost";
    EXPECT_GT(difference(before, read_png(window.screenshot())).share, 0.2);
    const int changes = window.changes();
    screen.xdotool("mousedown 3 mousemove_relative -- -50 -20 mouseup 3");
    ASSERT_TRUE(window.shows_whole(changes + 1));
    // The angles' rounding moves edges by less than a pixel: measured 0 to 0.02 % of the values.
    EXPECT_LT(difference(before, read_png(window.screenshot())).share, 0.005);
    window.key("Escape");
    EXPECT_EQ(window.code(), 0) << window.said();
}

INSTANTIATE_TEST_SUITE_P(Chapters, Window, testing::Values(kFirst, kEighth, kTwelfth),
                         [](const auto& info) { return "c" + info.param.name; });

// Depth of the middle of the picture, of 255.
int depth_of_middle(const std::filesystem::path& picture)
{
    const Image8 depth = read_png(picture);
    return depth.rgba[4 * (std::size_t(depth.height / 2) * std::size_t(depth.width) + std::size_t(depth.width / 2))];
}

TEST(MovingKeys, CountHoweverShortTheyArePressed)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    WindowProgram window(screen, kFirst.name, {"--size", "320x180", "--view", "depth"});
    ASSERT_TRUE(window.shows_whole(0)) << window.said();
    int before = depth_of_middle(window.screenshot());
    for (const char* key : {"w", "s"}) {
        // Each tap counts as 0.05 s, of a quarter of the scene's longest side a second: the depth's picture has 255 for twice
        // that side, so 8 taps are 12 steps of it, and more if a key was down for longer.
        for (int tap = 0; tap < 8; ++tap) {
            const int changes = window.changes();
            screen.xdotool("keydown " + std::string(key) + " keyup " + key);
            ASSERT_TRUE(window.shows_whole(changes + 1)) << "a tap is lost";
        }
        const int after = depth_of_middle(window.screenshot());
        EXPECT_GE(key == std::string("w") ? before - after : after - before, 11) << key;
        before = after;
    }
    window.key("Escape");
    EXPECT_EQ(window.code(), 0) << window.said();
}

TEST(StartUp, LosesNoKey)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    // As soon as there is a window the key is pressed; the voxels take far longer.
    WindowProgram window(screen, kTwelfth.name, {"--size", "320x180", "--set", "voxels=128", "accumulate=off"});
    window.key("3");
    ASSERT_TRUE(window.shows([](const ShownPicture& p) { return p.is_whole() && p.view == "indirect_diffuse"; }))
        << window.said();
    const std::vector<ShownPicture> shown = window.shown();
    EXPECT_EQ(shown.front().what, "meanwhile");
    expect_same(window.screenshot(),
                headless_picture(kTwelfth.name, "--size 320x180 --view indirect_diffuse --set voxels=128"));
    window.key("Escape");
    EXPECT_EQ(window.code(), 0) << window.said();
}

TEST(Refining, EndsWithTheMeanOfAllSamplesAndSleeps)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    WindowProgram window(screen, kTwelfth.name, {"--size", "160x90", "--set", "voxels=32"});
    ASSERT_TRUE(window.shows_whole(0, 3)) << window.said();
    window.key("2 1");  // in the midst of it: the mean begins again
    ASSERT_TRUE(window.shows_whole(1, 63));
    expect_same(window.screenshot(), headless_picture(kTwelfth.name, "--size 160x90 --frames 64 --set voxels=32"));
    const std::size_t shown = window.shown().size();
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_EQ(window.shown().size(), shown) << "it goes on though there is nothing to add";
    window.key("2");
    EXPECT_TRUE(window.shows([](const ShownPicture& p) { return p.view == "direct"; })) << "it does not wake";
    window.key("Escape");
    EXPECT_EQ(window.code(), 0) << window.said();
}

// Whatever is half done when the window is closed, --output gets a whole picture.
TEST(Closing, WritesAWholePicture)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    const TemporaryFolder folder;
    const std::string picture = (folder / "closed.png").string();
    WindowProgram window(screen, kTwelfth.name,
                         {"--size", "640x360", "--set", "voxels=32", "accumulate=off", "--output", picture});
    ASSERT_TRUE(window.shows([](const ShownPicture& p) { return p.what == "frame"; })) << window.said();
    window.key("2 Escape");
    ASSERT_EQ(window.code(), 0) << window.said();
    expect_same(picture, headless_picture(kTwelfth.name, same_headless(kTwelfth, "640x360", "direct")));
}

// A parameter of --list-params, in the panel's order.
struct Row {
    std::string name, value, range;
    bool is_switch() const { return range == "on | off"; }
    // Where on the slider, 0 .. 1: at the other end of a few choices; in the upper part of a range; few voxels.
    double place() const
    {
        if (range.find(" | ") == std::string::npos) return name == "voxels" ? 0.4 : 0.6;
        return range.size() > value.size() && range.substr(range.size() - value.size()) == value ? 0.1 : 0.9;
    }
};

std::vector<Row> rows_of(const std::string& program)
{
    std::vector<Row> rows;
    std::istringstream lines(run_program(program, "--list-params").output);
    for (std::string line; std::getline(lines, line);) {
        Row row;
        std::istringstream words(line);
        words >> row.name >> row.value >> row.range;
        for (std::string bar, word; words >> bar && bar == "|" && words >> word;) row.range += " | " + word;
        rows.push_back(row);
    }
    return rows;
}

class Panel : public testing::TestWithParam<Chapter> {};

// A click on each parameter, and the next picture is another one; after all of them the picture is that of a program which
// has begun with the values that the window says it has.
TEST_P(Panel, EveryParameterActsInTheNextFrame)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    const std::string size = "400x1000";
    WindowProgram window(screen, GetParam().name, window_arguments(GetParam(), size));
    ASSERT_TRUE(window.shows_whole(0)) << window.said();
    screen.xdotool("mousemove 18 18 click 1");  // the panel is folded in narrow windows
    // Dear ImGui's own style: what is above the first row, its middle, and from row to row; pixels.
    constexpr int kFirst = 9 + 19 + 8 + 17 + 23 + 23 + 9, kPitch = 23, kLeft = 17, kSlider = 147;
    int row_count = 0;
    for (const Row& row : rows_of(GetParam().name)) {
        const int y = kFirst + kPitch * row_count++;
        if (y > 960) break;                      // further ones would have to be scrolled to
        if (row.name == "accumulate") continue;  // its pictures go on
        const int changes = window.changes(), x = kLeft + (row.is_switch() ? 8 : int(row.place() * kSlider));
        screen.xdotool("mousemove " + std::to_string(x) + " " + std::to_string(y) + " click 1");
        ASSERT_TRUE(window.shows([=](const ShownPicture& p) { return p.changes > changes; })) << row.name;
    }
    EXPECT_GE(row_count, 5);
    ASSERT_TRUE(window.shows_whole(0));
    const std::string parameters = window.shown().back().parameters;
    for (const Row& row : rows_of(GetParam().name)) {
        if (--row_count <= 0) break;
        const bool changed = parameters.find(" " + row.name + "=") != std::string::npos;
        EXPECT_TRUE(changed) << row.name << " of" << parameters;
    }
    expect_same(window.screenshot(), headless_picture(GetParam().name, "--size " + size + " --set" + parameters));
    window.key("Escape");
    EXPECT_EQ(window.code(), 0) << window.said();
}

INSTANTIATE_TEST_SUITE_P(Chapters, Panel,
                         testing::Values(Chapter{"04_conservative_voxelization", "voxels=16"},
                                         Chapter{"05_atomic_averaging", "voxels=16"}),
                         [](const auto& info) { return "c" + info.param.name; });

TEST(PanelViews, KeysAndMouseOfThePanelAreNotThePictures)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    WindowProgram window(screen, kFirst.name, {"--size", "400x400"});
    ASSERT_TRUE(window.shows_whole(0)) << window.said();
    const Image8 before = read_png(window.screenshot());
    screen.xdotool("mousemove 18 18 click 1");  // unfold it
    // A turn that begins on the panel turns nothing; the same beside it does.
    screen.xdotool("mousemove 200 200 mousedown 3 mousemove_relative 20 0 mouseup 3");
    screen.xdotool("mousemove 380 200");
    EXPECT_EQ(difference(before, read_png(window.screenshot())).largest, 0);
    // Hidden, it takes nothing.
    window.key("F1");
    screen.xdotool("mousemove 200 200 mousedown 3 mousemove_relative 20 0 mouseup 3");
    ASSERT_TRUE(window.shows_whole(1));
    EXPECT_GT(difference(before, read_png(window.screenshot())).share, 0.05);
    window.key("Escape");
    EXPECT_EQ(window.code(), 0) << window.said();
}

TEST(Frames, OfAGivenNumberAreWhole)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    const TemporaryFolder folder;
    const std::string picture = (folder / "window.png").string();
    WindowProgram window(screen, kTwelfth.name,
                         {"--frames", "2", "--size", "320x180", "--set", "voxels=32", "--output", picture});
    ASSERT_EQ(window.code(), 0) << window.said();
    EXPECT_NE(window.said().find(": drawn by "), std::string::npos) << window.said();
    for (const ShownPicture& p : window.shown()) EXPECT_TRUE(p.is_whole());
    EXPECT_EQ(window.shown().size(), 2u);
    expect_same(picture, headless_picture(kTwelfth.name, "--frames 2 --size 320x180 --set voxels=32"));
}

TEST(WithoutADisplay, SaysSoInOneLine)
{
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    const TemporaryFolder folder;
    const ProgramRun run = run_program(kTwelfth.name, "--frames 1 --output '" + (folder / "x.png").string() + "'");
    EXPECT_GT(run.code, 0);
    EXPECT_LT(run.code, 128);
    EXPECT_NE(run.output.find("--headless"), std::string::npos) << run.output;
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace conebook
