// Every chapter's program: bad input gives one clear line, a code above 0 and no file; good input gives the picture
// from any working directory and from any copy of the repository.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "app/app.hpp"
#include "image/image.hpp"
#include "program.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

// Small pictures, and a small grid where there is one.
std::string small(const std::string& program)
{
    return " --headless" + coarse_settings(program) + " ";
}

class Program : public testing::TestWithParam<std::string> {
protected:
    // `arguments` must be refused with one line that holds `part`, and leave nothing in the folder.
    void expect_refusal(const std::string& arguments, const std::string& part)
    {
        const TemporaryFolder folder;
        const bool has_output = arguments.find("--output") != std::string::npos;
        const std::string output = has_output ? "" : " --output '" + (folder / "x.png").string() + "'";
        const std::string stats = " --stats '" + (folder / "x.json").string() + "'";
        const std::string size = arguments.find("--size") != std::string::npos ? "" : " --size 64x64";
        const ProgramRun run = run_program(GetParam(), small(GetParam()) + arguments + size + output + stats);
        SCOPED_TRACE(GetParam() + " " + arguments);
        EXPECT_GT(run.code, 0) << run.output;
        EXPECT_LT(run.code, 128) << "ended by a signal: " << run.output;
        EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
        EXPECT_NE(run.output.find(part), std::string::npos) << run.output << " should say " << part;
        EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "something was written";
    }
    Image8 picture(const std::string& arguments)
    {
        const TemporaryFolder folder;
        const std::filesystem::path file = folder / "x.png";
        const ProgramRun run = run_program(
            GetParam(), small(GetParam()) + "--size 64x64 " + arguments + " --output '" + file.string() + "'");
        EXPECT_EQ(run.code, 0) << run.output;
        return run.code == 0 ? read_png(file) : Image8{};
    }
};

TEST_P(Program, RefusesABadCommandLine)
{
    expect_refusal("--size 0x10", "0x10");
    expect_refusal("--size 10x", "10x");
    expect_refusal("--size=-5x5", "-5x5");
    expect_refusal("--size 10x10x", "10x10x");
    expect_refusal("--size 99999999999x5", "99999999999x5");
    expect_refusal("--size large", "large");
    expect_refusal("--view no_such_view", "no_such_view");
    expect_refusal("--set no_such_parameter=1", "no_such_parameter");
    expect_refusal("--set exposure=-1", "exposure");
    expect_refusal("--set exposure=1e7", "exposure");
    expect_refusal("--set exposure=nan", "exposure");
    expect_refusal("--set exposure=inf", "exposure");
    expect_refusal("--set exposure=", "exposure");
    expect_refusal("--set exposure=2x", "exposure");
    expect_refusal("--set exposure", "exposure");
    expect_refusal("--set tone_curve=no_such_curve", "tone_curve");
    expect_refusal("--frames 0", "frames");
    expect_refusal("--frames -1", "frames");
    expect_refusal("--frames many", "many");
    expect_refusal("--camera 99", "99");
    expect_refusal("--camera -1", "camera");
    expect_refusal("--no-such-option", "--no-such-option");
    expect_refusal("stray", "stray");
}

TEST_P(Program, RefusesAnOutputThatCannotBe)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "taken.png");
    expect_refusal("--output '" + (folder / "x.jpg").string() + "'", "x.jpg");
    expect_refusal("--output '" + (folder / "no_such_folder" / "x.png").string() + "'", "no_such_folder");
    expect_refusal("--output '" + (folder / "taken.png").string() + "'", "taken.png");
    expect_refusal("--output /proc/x.png", "/proc/x.png");  // a folder in which not even root can write
}

TEST_P(Program, RefusesABadScene)
{
    const TemporaryFolder folder;
    const auto write = [&](const char* name, const std::string& bytes) {
        std::ofstream(folder / name, std::ios::binary) << bytes;
        return "--scene '" + (folder / name).string() + "'";
    };
    std::ifstream whole(repository_folder() / "assets" / "cornell_box.glb", std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(whole)), {});
    ASSERT_GT(bytes.size(), 2000u);
    expect_refusal("--scene '" + (folder / "no_such.glb").string() + "'", "no_such.glb");
    expect_refusal("--scene '" + folder.path().string() + "'", folder.path().filename().string());
    expect_refusal(write("empty.glb", ""), "empty.glb");
    expect_refusal(write("truncated.glb", bytes.substr(0, bytes.size() / 2)), "truncated.glb");
    expect_refusal(write("text.gltf", "not json"), "text.gltf");
    expect_refusal(write("nothing.gltf", R"({"asset": {"version": "2.0"}})"), "nothing.gltf");
    expect_refusal(
        write("draco.gltf", R"({"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_draco_mesh_compression"]})"),
        "KHR_draco_mesh_compression");
}

TEST_P(Program, SaysWhatItCanDo)
{
    const ProgramRun views = run_program(GetParam(), "--list-views"), help = run_program(GetParam(), "--help");
    EXPECT_EQ(views.code, 0);
    EXPECT_EQ(views.output.rfind("final\t", 0) == 0 || views.output.find("\nfinal\t") != std::string::npos, true)
        << views.output;
    const ProgramRun parameters = run_program(GetParam(), "--list-params");
    EXPECT_EQ(parameters.code, 0);
    EXPECT_NE(parameters.output.find("exposure "), std::string::npos) << parameters.output;
    EXPECT_EQ(help.code, 0);
    for (const char* option : {"--scene", "--headless", "--size", "--output", "--frames", "--view", "--camera",
                               "--stats", "--set", "--preset", "--save-preset", "--list-views", "--list-params"})
        EXPECT_NE(help.output.find(option), std::string::npos) << option;
}

TEST_P(Program, GivesTheSamePictureFromAnotherFolderAndAfterMoreFrames)
{
    const Image8 here = picture("");
    ASSERT_EQ(here.width, 64);
    EXPECT_GT(*std::max_element(here.rgba.begin(), here.rgba.end() - 1), 0);
    const TemporaryFolder elsewhere;
    const std::filesystem::path before = std::filesystem::current_path();
    std::filesystem::current_path(elsewhere.path());
    const ProgramRun relative = run_program(GetParam(), small(GetParam()) + "--size 64x64 --output relative.png");
    EXPECT_EQ(relative.code, 0) << relative.output;
    std::filesystem::current_path(before);
    EXPECT_EQ(read_png(elsewhere / "relative.png").rgba, here.rgba);
    // Where frames add up to a better picture, each alone is the first one.
    const bool accumulates = run_program(GetParam(), "--list-params").output.find("accumulate ") != std::string::npos;
    EXPECT_EQ(picture(accumulates ? "--frames 3 --set accumulate=off" : "--frames 3").rgba, here.rgba);
}

// What a pass leaves switched on, blending above all, shows only in the next frame and in passes that did not expect it.
TEST_P(Program, LeavesNoStateBehindInTheNextFrame)
{
    const std::string parameters = run_program(GetParam(), "--list-params").output;
    std::string set;
    for (const std::string name : {"interleave", "accumulate"})  // the latter moves the camera by parts of a pixel
        if (parameters.find(name + " ") != std::string::npos) set += " --set " + name + "=off";
    const std::string view = "--scene '" + asset("emissive_shapes").string() + "'" + set + " --view ";
    const std::string views = run_program(GetParam(), "--list-views").output;
    for (const char* name : {"normal", "emission"}) {
        if (views.find(name) == std::string::npos) continue;
        EXPECT_EQ(picture(view + name + " --frames 3").rgba, picture(view + name).rgba) << name;
    }
}

// A copy of shaders/ and assets/ with a fault planted in `file`; $CONEBOOK_ROOT names it while this object lives.
class CopyOfTheRoot {
public:
    CopyOfTheRoot() : original_(repository_folder())
    {
        std::filesystem::copy(original_ / "shaders", copy_ / "shaders", std::filesystem::copy_options::recursive);
        std::filesystem::create_directory(copy_ / "assets");
        std::filesystem::copy(original_ / "assets" / "cornell_box.glb", copy_ / "assets" / "cornell_box.glb");
        setenv("CONEBOOK_ROOT", copy_.path().c_str(), 1);
    }
    ~CopyOfTheRoot() { setenv("CONEBOOK_ROOT", original_.c_str(), 1); }
    // Returns FILE:LINE of the line.
    std::string plant(const std::string& file, const std::string& line) const
    {
        std::ifstream in(copy_ / "shaders" / file);
        const auto lines = std::count(std::istreambuf_iterator<char>(in), {}, '\n');
        std::ofstream(copy_ / "shaders" / file, std::ios::app) << line << "\n";
        return file + ":" + std::to_string(lines + 1);
    }

private:
    std::filesystem::path original_;
    TemporaryFolder copy_;
};

TEST_P(Program, NamesFileAndLineOfAFaultInAShader)
{
    {
        const CopyOfTheRoot copy;
        EXPECT_EQ(picture("").width, 64);  // the copy works
        expect_refusal("", copy.plant("01_first_light/tone_map.frag", "int planted = ;"));
    }
    {
        const CopyOfTheRoot copy;  // one line, however many the driver writes
        expect_refusal(
            "", copy.plant("common/fullscreen.vert", "void planted() { no_such_function();\n no_such_either(); }"));
    }
    {
        // A warning is a fault, and remains one when the driver's disk cache has met the text.
        const CopyOfTheRoot copy;
        const std::string place =
            copy.plant("01_first_light/tone_map.frag", "float planted() { float x; x = x + 1.0; return x; }");
        for (int run = 0; run < 3; ++run) expect_refusal("", place);
    }
    {
        const CopyOfTheRoot copy;
        expect_refusal("", copy.plant("01_first_light/tone_map.frag", "#include \"common/no_such_file.glsl\""));
    }
}

TEST_P(Program, RefusesARootWithoutShaders)
{
    const std::string before = repository_folder().string();
    const TemporaryFolder empty;
    setenv("CONEBOOK_ROOT", empty.path().c_str(), 1);
    expect_refusal("", "CONEBOOK_ROOT");
    setenv("CONEBOOK_ROOT", before.c_str(), 1);
}

INSTANTIATE_TEST_SUITE_P(Chapters, Program, testing::ValuesIn(chapters()),
                         [](const auto& info) { return "c" + info.param; });

// What OpenGL reports as grave ends a program without a picture, wherever it happens in the frame.
TEST(OpenGlFaults, AGraveMessageOrAnErrorFails)
{
    const TemporaryFolder folder;
    const std::string output = (folder / "x.png").string();
    const auto finish = [&](const std::function<void()>& fault) {
        std::vector<std::string> words = {"test", "--headless", "--size", "8x8", "--output", output};
        std::vector<char*> argv;
        for (std::string& word : words) argv.push_back(word.data());
        App app(int(argv.size()), argv.data(), {"test", {{"final", Encoding::radiance, ""}}, {}});
        const gl::Texture linear = gl::texture_2d("linear", GL_RGBA32F, {8, 8});
        const gl::Texture display = gl::texture_2d("display", GL_RGBA8, {8, 8});
        linear.clear();
        app.each_frame([&] {
            app.pass("fault", fault);
            app.show(linear, display);
        });
        return app.finish();
    };
    const auto message = [](GLenum severity) {
        return [severity] {
            glDebugMessageInsert(GL_DEBUG_SOURCE_APPLICATION, GL_DEBUG_TYPE_OTHER, 1, severity, -1, "planted");
        };
    };
    EXPECT_THROW(finish(message(GL_DEBUG_SEVERITY_HIGH)), std::runtime_error);
    EXPECT_FALSE(std::filesystem::exists(output));
    EXPECT_THROW(finish([] { glBindTexture(0x1234, 1); }), std::runtime_error);
    EXPECT_FALSE(std::filesystem::exists(output));
    EXPECT_EQ(finish(message(GL_DEBUG_SEVERITY_NOTIFICATION)), 0);
    EXPECT_TRUE(std::filesystem::exists(output));
}

}  // namespace
}  // namespace conebook
