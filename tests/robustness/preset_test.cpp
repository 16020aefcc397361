// --preset and --save-preset of the programs: another run the same, and nothing written over by mistake.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "image/image.hpp"
#include "program.hpp"
#include "scene/scene.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

const char* const kProgram = "02_g_buffer";

std::string quoted(const std::filesystem::path& path) { return "'" + path.string() + "' "; }

Image8 picture(const std::string& arguments)
{
    const TemporaryFolder folder;
    const ProgramRun run =
        run_program(kProgram, "--headless --size 64x48 --output " + quoted(folder / "x.png") + arguments);
    EXPECT_EQ(run.code, 0) << run.output;
    return run.code == 0 ? read_png(folder / "x.png") : Image8{};
}

void write(const std::filesystem::path& file, const nlohmann::json& json) { std::ofstream(file) << json; }

TEST(Presets, MakeAnotherRunTheSame)
{
    const TemporaryFolder folder;
    const std::filesystem::path preset = folder / "preset.json";
    const std::string settings = "--set exposure=0.3 tone_curve=clamp srgb=off depth_bits=9 --view direct ";
    const std::string scene = "--scene " + quoted(asset("materials"));
    const Image8 wanted = picture(scene + settings + "--save-preset " + quoted(preset));
    EXPECT_EQ(picture(scene + "--preset " + quoted(preset)).rgba, wanted.rgba);
    EXPECT_NE(picture(scene).rgba, wanted.rgba);
    // What the command line says stands above it.
    const std::string over = "--set exposure=0.3 tone_curve=clamp --view final ";
    EXPECT_EQ(picture(scene + "--preset " + quoted(preset) + "--set srgb=on depth_bits=0 --view final").rgba,
              picture(scene + over).rgba);
    const nlohmann::json saved = nlohmann::json::parse(std::ifstream(preset));
    EXPECT_EQ(saved.at("view"), "direct");
    EXPECT_EQ(saved.at("parameters").at("exposure"), 0.3);
    EXPECT_EQ(saved.at("parameters").at("srgb"), false);
    EXPECT_EQ(saved.at("parameters").at("tone_curve"), "clamp");
    EXPECT_FALSE(saved.contains("camera"));
}

TEST(Presets, PlaceTheCamera)
{
    const TemporaryFolder folder;
    const std::filesystem::path preset = folder / "preset.json";
    const Scene scene = load_scene(asset("cornell_box"));
    ASSERT_FALSE(scene.cameras.empty());
    const glm::mat4 pose = scene.cameras[0].world_from_camera;
    ASSERT_EQ(glm::mat3(pose), glm::mat3(1.0f)) << "it looks along -z, so its quaternion is known";
    const glm::dvec3 position = scene.origin_ws + glm::dvec3(pose[3]);
    const nlohmann::json same = {{"position", {position.x, position.y, position.z}}, {"orientation", {0, 0, 0, 1}}};
    write(preset, {{"camera", same}});
    const Image8 wanted = picture("");
    EXPECT_EQ(picture("--preset " + quoted(preset)).rgba, wanted.rgba);

    nlohmann::json turned = same;  // upside down: half a turn about z
    turned["orientation"] = {0, 0, 1, 0};
    write(preset, {{"camera", turned}});
    const std::filesystem::path saved = folder / "saved.json";
    const Image8 upside_down =
        picture("--view base_color --preset " + quoted(preset) + "--save-preset " + quoted(saved));
    const Image8 upright = picture("--view base_color");
    ASSERT_EQ(upside_down.rgba.size(), upright.rgba.size());
    std::size_t different = 0;
    const std::size_t pixels = upright.rgba.size() / 4;
    for (std::size_t i = 0; i < pixels; ++i)
        different +=
            std::equal(&upright.rgba[4 * i], &upright.rgba[4 * i] + 3, &upside_down.rgba[4 * (pixels - 1 - i)]) ? 0 : 1;
    EXPECT_LE(different, pixels / 50) << "edges may fall to the other side of a pixel's centre";
    EXPECT_NE(upside_down.rgba, upright.rgba);
    EXPECT_EQ(picture("--view base_color --preset " + quoted(saved)).rgba, upside_down.rgba);
    EXPECT_EQ(picture("--view base_color --camera 0 --preset " + quoted(saved)).rgba, upright.rgba);
}

// A lamp twice as bright, in linear light; and one that is not there.
TEST(Presets, PlaceTheLights)
{
    const TemporaryFolder folder;
    const std::filesystem::path preset = folder / "preset.json", saved = folder / "saved.json";
    const Scene scene = load_scene(asset("cornell_box"));
    ASSERT_FALSE(scene.lights.empty());
    const glm::vec3 twice = 2.0f * scene.lights[0].intensity;
    write(preset, {{"lights", {{{"index", 0}, {"intensity", {twice.r, twice.g, twice.b}}}}}});
    const auto direct = [&](const std::string& arguments) {
        const TemporaryFolder out;
        const ProgramRun run = run_program(
            kProgram, "--headless --size 32x24 --view direct --output " + quoted(out / "x.exr") + arguments);
        EXPECT_EQ(run.code, 0) << run.output;
        return read_exr(out / "x.exr");
    };
    const ImageF once = direct(""), brighter = direct("--preset " + quoted(preset) + "--save-preset " + quoted(saved));
    double most = 0.0;
    for (std::size_t i = 0; i < once.pixels.size(); ++i) {
        EXPECT_NEAR(brighter.pixels[i].g, 2.0f * once.pixels[i].g, 1e-5f);
        most = std::max(most, double(once.pixels[i].g));
    }
    EXPECT_GT(most, 0.01);
    const ImageF again = direct("--preset " + quoted(saved));
    for (std::size_t i = 0; i < once.pixels.size(); ++i) EXPECT_EQ(again.pixels[i], brighter.pixels[i]);

    write(preset, {{"lights", {{{"index", 99}}}}});
    const ProgramRun run = run_program(kProgram, "--headless --size 16x16 --preset " + quoted(preset));
    EXPECT_EQ(run.code, 1);
    EXPECT_NE(run.output.find(preset.string() + ": lights: index 99"), std::string::npos) << run.output;
}

// The first source document as published, as a whole.
TEST(Thesis, CanBeSwitchedOnInEveryChapterWithCones)
{
    const std::filesystem::path thesis = repository_folder() / "assets" / "presets" / "thesis.json";
    const nlohmann::json wanted = nlohmann::json::parse(std::ifstream(thesis));
    std::set<std::string> in_no_chapter;
    for (const auto& entry : wanted.at("parameters_if_present").items()) in_no_chapter.insert(entry.key());
    for (const char* program :
         {"08_diffuse_cones", "09_specular_cones", "10_soft_shadows", "11_emissives", "12_second_bounce"}) {
        SCOPED_TRACE(program);
        const TemporaryFolder folder;
        const std::filesystem::path saved = folder / "saved.json";
        const ProgramRun run = run_program(program, "--headless --size 16x16 --set voxels=32 --preset " +
                                                        quoted(thesis) + "--save-preset " + quoted(saved));
        ASSERT_EQ(run.code, 0) << run.output;
        const nlohmann::json parameters = nlohmann::json::parse(std::ifstream(saved)).at("parameters");
        EXPECT_EQ(parameters.at("voxels"), 32);
        for (const auto& [name, value] : wanted.at("parameters").items()) EXPECT_EQ(parameters.at(name), value) << name;
        for (const auto& [name, value] : wanted.at("parameters_if_present").items()) {
            if (!parameters.contains(name)) continue;
            EXPECT_EQ(parameters.at(name), value) << name;
            in_no_chapter.erase(name);
        }
    }
    EXPECT_EQ(in_no_chapter, std::set<std::string>());
}

// Refused with one line that holds `part`, before anything is written: the folder keeps its `entries`.
void expect_refusal(const TemporaryFolder& folder, const std::string& arguments, const std::string& part)
{
    SCOPED_TRACE(arguments);
    const auto entries = [&] {
        return std::distance(std::filesystem::recursive_directory_iterator(folder.path()), {});
    };
    const auto before = entries();
    const ProgramRun run = run_program(kProgram, "--headless --size 16x16 " + arguments);
    EXPECT_EQ(run.code, 1);
    EXPECT_EQ(std::count(run.output.begin(), run.output.end(), '\n'), 1) << run.output;
    EXPECT_NE(run.output.find(part), std::string::npos) << run.output;
    EXPECT_EQ(entries(), before) << "something was left behind";
}

TEST(Presets, FaultsNameFileAndEntry)
{
    const TemporaryFolder folder;
    const std::filesystem::path preset = folder / "preset.json";
    const auto refused = [&](const nlohmann::json& json, const std::string& entry) {
        write(preset, json);
        expect_refusal(folder, "--preset " + quoted(preset) + "--output " + quoted(folder / "x.png"),
                       preset.string() + ": " + entry);
    };
    refused({{"parameters", {{"cones", 6}}}}, "parameters.cones");  // of a later chapter
    refused({{"parameters", {{"exposure", -1}}}}, "parameters.exposure=-1");
    refused({{"view", "no_such_view"}}, "view no_such_view");
    refused({{"lamp", 1}}, "lamp");
    refused({{"camera", {{"fov", 1}}}}, "camera.fov");
    expect_refusal(folder, "--preset " + quoted(folder / "none.json"), "none.json");
}

TEST(Outputs, DoNotOverwriteEachOtherOrWhatIsRead)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "inner");
    std::filesystem::create_directory_symlink(folder / "inner", folder / "link");
    std::filesystem::copy(asset("cornell_box"), folder / "scene.glb");
    std::ofstream(folder / "taken.png") << "taken";
    std::filesystem::create_symlink(folder / "taken.png", folder / "link.png");
    std::filesystem::create_hard_link(folder / "taken.png", folder / "hard.png");
    write(folder / "preset.json", nlohmann::json::object());
    const std::string output = "--output ", stats = "--stats ", preset = "--preset ", save = "--save-preset ";
    const auto in = [&](const char* name) { return quoted(folder / name); };
    expect_refusal(folder, output + in("x.png") + stats + in("x.png"), "--stats");
    expect_refusal(folder, output + in("x.png") + stats + in("inner/../x.png"), "--stats");
    expect_refusal(folder, output + in("inner/x.png") + stats + in("link/x.png"), "--stats");
    expect_refusal(folder, output + in("taken.png") + stats + in("link.png"), "--stats");
    expect_refusal(folder, output + in("taken.png") + stats + in("hard.png"), "--stats");
    expect_refusal(folder, output + in("x.png") + save + in("x.png"), "--save-preset");
    expect_refusal(folder, stats + in("x.json") + save + in("x.json"), "--save-preset");
    expect_refusal(folder, "--scene " + in("scene.glb") + stats + in("scene.glb"), "--scene");
    expect_refusal(folder, "--scene " + in("scene.glb") + save + in("scene.glb"), "--scene");
    expect_refusal(folder, preset + in("preset.json") + stats + in("preset.json"), "--preset");
    EXPECT_EQ(std::filesystem::file_size(folder / "taken.png"), 5u);
    const ProgramRun again =  // a preset that is brought up to date
        run_program(kProgram, "--headless --size 16x16 " + preset + in("preset.json") + save + in("preset.json"));
    EXPECT_EQ(again.code, 0) << again.output;
    EXPECT_TRUE(nlohmann::json::parse(std::ifstream(folder / "preset.json")).contains("parameters"));
}

TEST(Outputs, ThatCannotBeWrittenAreRefusedFirst)
{
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "taken");
    for (const std::string option : {"--stats ", "--save-preset "}) {
        const std::string picture = "--output " + quoted(folder / "x.png") + option;
        expect_refusal(folder, picture + quoted(folder / "none" / "x.json"), option);
        expect_refusal(folder, picture + quoted(folder / "taken"), option);
        expect_refusal(folder, picture + "/proc/x.json", "/proc/x.json");
        expect_refusal(folder, picture + "/dev/null", "/dev/null");
    }
    EXPECT_FALSE(std::filesystem::is_regular_file("/dev/null"));
}

}  // namespace
}  // namespace conebook
