// Objects in chapter 15's window, under a virtual X server with real events: what the reader does there is in the
// parameter, in the preset, and in the picture as headless makes it from them.
#include <cmath>

#include "window_picture.hpp"

namespace conebook {
namespace {

constexpr const char* kProgram = "15_dynamic_scenes";

// The room's camera: 2.8 m before its open side, which is 2 m wide and fills a square picture.
constexpr int kSize = 320;
constexpr double kToOpening_m = 2.8, kOpening_m = 2.0;

// The text of `objects=` in a line of the trace, "" without any.
std::string objects_of(const ShownPicture& picture)
{
    std::istringstream words(picture.parameters);
    for (std::string word; words >> word;)
        if (word.rfind("objects=", 0) == 0) return word.substr(8);
    return "";
}

// Where the first of them is, a sphere.
double first_x_m(const std::string& objects)
{
    const std::string start = "sphere:at=";
    return objects.rfind(start, 0) == 0 ? std::strtod(objects.c_str() + start.size(), nullptr) : 1e9;
}

bool shows_objects(const WindowProgram& window, const std::string& text)
{
    return window.shows([&](const ShownPicture& p) { return p.is_whole() && objects_of(p) == text; });
}

std::string last_objects(const WindowProgram& window) { return objects_of(window.shown().back()); }

TEST(ObjectsInTheWindow, ArePickedMovedSwitchedAddedAndRemoved)
{
    SKIP_WITHOUT_A_SCREEN();
    const VirtualScreen screen;
    const TemporaryFolder folder;
    const std::string preset = (folder / "preset.json").string();
    WindowProgram window(screen, kProgram,
                         {"--scene", asset("cornell_empty").string(), "--size", "320x320", "--save-preset", preset,
                          "--set", "voxels=32", "accumulate=off", "cones=6",
                          "objects=sphere:at=0,1,0:scale=0.6:dynamic+cube:at=-0.5,0.3,-0.4:scale=0.4"});
    ASSERT_TRUE(window.shows_whole(0)) << window.said();

    // Keys move nothing before something is picked; then by a tenth of a metre, about a fiftieth of the room.
    window.key("Right");
    screen.xdotool("mousemove 160 160 click 1");
    window.key("Right Right Prior");
    const std::string cube = "+cube:at=-0.5,0.3,-0.4:scale=0.4";
    EXPECT_TRUE(shows_objects(window, "sphere:at=0.2,1.1,0:scale=0.6:dynamic" + cube)) << last_objects(window);

    // Dragged by 40 pixels along its front, which is a sphere's: 0.3 m before its middle where it is grabbed.
    screen.xdotool("mousemove 183 148 mousedown 1 mousemove 163 148 mousemove 143 148 mouseup 1");
    const double depth_m = kToOpening_m + 1.0 - 0.3, moved_m = 40.0 / kSize * kOpening_m * depth_m / kToOpening_m;
    EXPECT_TRUE(window.shows([&](const ShownPicture& p) {
        return p.is_whole() && std::abs(first_x_m(objects_of(p)) - (0.2 - moved_m)) < 0.02;
    })) << last_objects(window) << ", expected to have moved by " << moved_m;

    // Somewhere else nothing is picked; there is nothing to remove.
    screen.xdotool("mousemove 300 60 click 1");
    const std::string before = last_objects(window);
    window.key("Delete m");

    // The cube becomes dynamic, another object comes, moves away and goes.
    screen.xdotool("mousemove 107 238 click 1");
    window.key("m");
    ASSERT_TRUE(shows_objects(window, before + ":dynamic")) << last_objects(window);
    window.key("Insert Left");
    ASSERT_TRUE(shows_objects(window, before + ":dynamic+sphere:at=-0.1,1,0:dynamic")) << last_objects(window);
    window.key("Delete");
    ASSERT_TRUE(shows_objects(window, before + ":dynamic")) << last_objects(window);
    window.key("Insert Down");
    ASSERT_TRUE(shows_objects(window, before + ":dynamic+sphere:at=0,1,0.1:dynamic")) << last_objects(window);
    screen.xdotool("mousemove 107 238 click 1");
    window.key("Delete");

    // The light comes to the camera; then all is as a preset says it.
    const int changes = window.changes();
    window.key("c");
    ASSERT_TRUE(window.shows_whole(changes + 1)) << window.said();
    const std::filesystem::path picture = window.screenshot();
    window.key("Escape");
    ASSERT_EQ(window.code(), 0) << window.said();
    expect_same(picture, headless_picture(kProgram, "--scene '" + asset("cornell_empty").string() +
                                                        "' --size 320x320 --preset '" + preset + "'"));
}

// Faults are one line.
TEST(ObjectsInTheWindow, FaultsOfTheCommandLineAreNamed)
{
    const std::string scene = "--headless --size 32x32 --scene '" + asset("cornell_empty").string() + "' ";
    for (const auto& [objects, fault] : {std::pair("ball", "--set objects: object 1 'ball': is none of icosahedron"),
                                         {"sphere:at=0,x,0", "at=0,x,0 has 'x', which is not a number"},
                                         {"no_such.glb", "no_such.glb: no such file"}}) {
        const ProgramRun run = run_program(kProgram, scene + "--set objects=" + objects);
        EXPECT_GT(run.code, 0);
        EXPECT_LT(run.code, 128);
        EXPECT_NE(run.output.find(fault), std::string::npos) << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    }
}

}  // namespace
}  // namespace conebook
