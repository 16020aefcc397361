// Parameters by name, and presets that hold them: what goes in comes out, and what does not fit is refused.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "app/preset.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

enum class Way { straight, round, none };

struct Fields {
    float length = 0.75f;
    int count = 12;
    bool shown = true;
    Way way = Way::round;
    int cones = 6;
    std::string words;
};

ParameterTable table_of(Fields& fields)
{
    ParameterTable table;
    table.add("length", fields.length, 1e-6, 10.0, "m", "");
    table.add("count", fields.count, -1, 64, "", "");
    table.add("shown", fields.shown, "");
    table.add("way", fields.way, {"straight", "round", "none"}, "");
    table.add_values("cones", fields.cones, {6, 9, 5}, "");
    const auto no_digits = [](const std::string& text) {
        for (const char c : text)
            if (c >= '0' && c <= '9') throw std::runtime_error("has the digit " + std::string(1, c));
    };
    table.add("words", fields.words, no_digits, "");
    return table;
}

std::string fault_of(const std::function<void()>& work)
{
    try {
        work();
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return "";
}

TEST(Parameters, GoToTheirFields)
{
    Fields fields;
    ParameterTable table = table_of(fields);
    for (const char* assignment : {"length=2.5e-3", "count=-1", "shown=off", "way=none", "cones=5", "words=a:b=c,+d e"})
        table.set(assignment);
    EXPECT_EQ(fields.length, 2.5e-3f);
    EXPECT_EQ(fields.count, -1);
    EXPECT_FALSE(fields.shown);
    EXPECT_EQ(fields.way, Way::none);
    EXPECT_EQ(fields.cones, 5);
    EXPECT_EQ(fields.words, "a:b=c,+d e");
    EXPECT_EQ(table.values().numbers, (std::vector<double>{2.5e-3f, -1, 0, double(Way::none), 5, 0}));
    EXPECT_EQ(table.values().texts, (std::vector<std::string>{"", "", "", "", "", "a:b=c,+d e"}));
    for (const Parameter& parameter : table.all()) EXPECT_FALSE(parameter.is_default()) << parameter.name;
    EXPECT_EQ(table.changed(), " length=0.0025 count=-1 shown=off way=none cones=5 'words=a:b=c,+d e'");
    Fields others;
    ParameterTable same = table_of(others);
    same.set_values(table.values());
    EXPECT_EQ(same.changed(), table.changed());
    table.set("words=none");
    EXPECT_EQ(fields.words, "");
    table.set("shown=1");
    EXPECT_TRUE(fields.shown);
}

TEST(Parameters, ValuesThatDoNotFitAreRefusedAndChangeNothing)
{
    Fields fields;
    ParameterTable table = table_of(fields);
    for (const char* assignment :
         {"length=0", "length=11", "length=nan", "length=inf", "length=1x", "length=", "count=2.5", "count=65",
          "shown=perhaps", "shown=2", "way=1", "way=Round", "cones=7", "cones=4", "cones=6.5"}) {
        const std::string fault = fault_of([&] { table.set(assignment); });
        EXPECT_EQ(fault.rfind(std::string("--set ") + assignment + ": ", 0), 0u) << assignment << " said " << fault;
    }
    EXPECT_EQ(fault_of([&] { table.set("words=abc4"); }), "--set words: has the digit 4");
    EXPECT_EQ(fault_of([&] { table.set("width=1"); }).rfind("--set width: unknown parameter", 0), 0u);
    EXPECT_NE(fault_of([&] { table.set("length"); }), "");
    for (const Parameter& parameter : table.all()) EXPECT_TRUE(parameter.is_default()) << parameter.name;
    EXPECT_THROW(table.add("way", fields.way, {"a"}, ""), std::logic_error);
}

class PresetFile {
public:
    std::filesystem::path file() const { return folder_ / "preset.json"; }
    const PresetFile& hold(const std::string& text) const
    {
        std::ofstream(file()) << text;
        return *this;
    }

private:
    TemporaryFolder folder_;
};

TEST(Presets, KeepEveryBitOfEveryValue)
{
    const PresetFile preset;
    for (const float length : {1e-6f, 0.1f, 1.0f / 3.0f, 9.9999990f, std::nextafter(1.0f, 2.0f)}) {
        Fields saved, read;
        const ParameterTable saved_table = table_of(saved);
        ParameterTable read_table = table_of(read);
        saved = {length, 64, false, Way::none, 9, "a 'quoted' \"word\""};
        const CameraChoice camera{3, glm::dvec3(0.1, -2e6, 3.0), glm::dquat(0.5, 0.5, -0.5, 0.5), 0.7f};
        const LightChoice light{2, glm::vec3(0.1f, length, 30.0f), glm::dvec3(1e6, 0.1, -3.0),
                                glm::dvec3(0.6, 0.0, 0.8)};
        write_preset(preset.file(), saved_table, {"depth", camera, {light, {0, {}, {}, {}}}});
        const Preset back = read_preset(preset.file(), read_table);
        EXPECT_EQ(read.length, saved.length);
        EXPECT_EQ(read.count, saved.count);
        EXPECT_EQ(read.shown, saved.shown);
        EXPECT_EQ(read.way, saved.way);
        EXPECT_EQ(read.cones, saved.cones);
        EXPECT_EQ(read.words, saved.words);
        EXPECT_EQ(back.view, "depth");
        EXPECT_EQ(back.camera.index, camera.index);
        EXPECT_EQ(back.camera.position, camera.position);
        EXPECT_EQ(back.camera.orientation, camera.orientation);
        EXPECT_EQ(back.camera.y_fov, camera.y_fov);
        ASSERT_EQ(back.lights.size(), 2u);
        EXPECT_EQ(back.lights[0].index, light.index);
        EXPECT_EQ(back.lights[0].intensity, light.intensity);
        EXPECT_EQ(back.lights[0].position, light.position);
        EXPECT_EQ(back.lights[0].direction, light.direction);
        EXPECT_FALSE(back.lights[1].intensity || back.lights[1].position || back.lights[1].direction);
    }
}

TEST(Presets, WhatTheyDoNotHoldStaysAsItIs)
{
    const PresetFile preset;
    Fields fields;
    ParameterTable table = table_of(fields);
    fields.count = 7;
    Preset read = read_preset(preset.hold("{}").file(), table);
    EXPECT_EQ(read.view, "");
    EXPECT_FALSE(read.camera.index || read.camera.position || read.camera.orientation || read.camera.y_fov);
    read = read_preset(preset.hold(R"({"camera": 2, "parameters": {"way": "straight"}})").file(), table);
    EXPECT_EQ(read.camera.index, 2);
    EXPECT_EQ(fields.way, Way::straight);
    EXPECT_EQ(fields.count, 7);
}

TEST(Presets, HoldWhatSomeChaptersLack)
{
    const PresetFile preset;
    Fields fields;
    ParameterTable table = table_of(fields);
    preset.hold(R"({"parameters": {"count": 3}, "parameters_if_present": {"cones": 9, "bounces": 2}})");
    read_preset(preset.file(), table);
    EXPECT_EQ(fields.count, 3);
    EXPECT_EQ(fields.cones, 9);
}

TEST(Presets, PlaceLights)
{
    Scene scene;
    scene.origin_ws = {1000.0, 0.0, 0.0};
    scene.lights.resize(2);
    place_lights(scene, {{1, glm::vec3(1, 2, 3), glm::dvec3(1001.0, 2.0, 3.0), glm::dvec3(1, 0, 0)}});
    EXPECT_EQ(scene.lights[1].intensity, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.lights[1].position, glm::vec3(1, 2, 3));
    EXPECT_EQ(scene.lights[1].direction, glm::vec3(1, 0, 0));
    EXPECT_EQ(scene.lights[0].intensity, Light{}.intensity);
    place_lights(scene, {{0, {}, {}, glm::dvec3(0, 1, 0)}});
    EXPECT_EQ(scene.lights[0].direction, glm::vec3(0, 1, 0));
    EXPECT_EQ(scene.lights[0].position, Light{}.position);
    EXPECT_NE(fault_of([&] { place_lights(scene, {{2, {}, {}, {}}}); }).find("index 2"), std::string::npos);
}

TEST(Presets, RefuseWhatTheyDoNotKnow)
{
    const PresetFile preset;
    const struct {
        const char *text, *entry;
    } cases[] = {
        {"", "is no JSON"},
        {"{\"view\": ", "is no JSON"},
        {"[1, 2]", "must be an object"},
        {R"({"colour": 1})", "colour: unknown entry"},
        {R"({"view": 3})", "view: must be"},
        {R"({"parameters": 3})", "parameters: must be an object"},
        {R"({"parameters": {"width": 3}})", "parameters.width: unknown parameter"},
        {R"({"parameters": {"length": 20}})", "parameters.length=20: out of range"},
        {R"({"parameters": {"length": "far"}})", "parameters.length=far: not a finite number"},
        {R"({"parameters": {"length": [1]}})", "parameters.length: must be a number"},
        {R"({"parameters": {"count": 2.5}})", "parameters.count=2.5: must be a whole number"},
        {R"({"parameters": {"way": "left"}})", "parameters.way=left: must be one of"},
        {R"({"parameters": {"shown": null}})", "parameters.shown: must be"},
        {R"({"parameters_if_present": {"count": 65}})", "parameters_if_present.count=65: out of range"},
        {R"({"parameters_if_present": 3})", "parameters_if_present: must be an object"},
        {R"({"lights": 1})", "lights: must be a list"},
        {R"({"lights": [{"position": [0, 0, 0]}]})", "lights[0]: has no index"},
        {R"({"lights": [{"index": 0, "colour": 1}]})", "lights[0].colour: unknown entry"},
        {R"({"lights": [{"index": 0, "intensity": [1, -1, 1]}]})", "lights[0].intensity: must not be negative"},
        {R"({"lights": [{"index": 0}, {"index": 1, "direction": [1, 1, 0]}]})", "lights[1].direction: must be a unit"},
        {R"({"camera": -1})", "camera: out of range"},
        {R"({"camera": 1.5})", "camera: must be"},
        {R"({"camera": "front"})", "camera: must be"},
        {R"({"camera": {"index": 4294967296}})", "camera.index: out of range"},
        {R"({"camera": {"place": [0, 0, 0]}})", "camera.place: unknown entry"},
        {R"({"camera": {"position": [0, 0]}})", "camera.position: must be a list of 3"},
        {R"({"camera": {"position": [0, "a", 0]}})", "camera.position[1]: must be a number"},
        {R"({"camera": {"position": [0, 0, 1e39]}})", "camera.position[2]: out of range"},
        {R"({"camera": {"orientation": [0, 0, 0, 0]}})", "camera.orientation: must be a unit quaternion"},
        {R"({"camera": {"y_fov": 3.2}})", "camera.y_fov: out of range"},
        {R"({"camera": {"y_fov": 0}})", "camera.y_fov: out of range"},
    };
    for (const auto& [text, entry] : cases) {
        Fields fields;
        ParameterTable table = table_of(fields);
        const std::string fault = fault_of([&] { read_preset(preset.hold(text).file(), table); });
        EXPECT_EQ(fault.rfind(preset.file().string() + ": " + entry, 0), 0u) << text << " said " << fault;
        EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
    }
    Fields fields;
    ParameterTable table = table_of(fields);
    EXPECT_NE(fault_of([&] { read_preset(preset.file().parent_path(), table); }), "");
    EXPECT_NE(fault_of([&] { read_preset(preset.file().parent_path() / "none.json", table); }), "");
}

// A camera at (1, 2, 3) of a scene far from its file's origin.
Scene scene_with_camera(glm::dvec3 origin_ws)
{
    Scene scene;
    scene.origin_ws = origin_ws;
    scene.bounds = {glm::vec3(-1.0f), glm::vec3(1.0f)};
    Camera camera;
    camera.world_from_camera[3] = glm::vec4(1.0f, 2.0f, 3.0f, 1.0f);
    scene.cameras.push_back(camera);
    return scene;
}

TEST(Cameras, ThatDidNotMoveAreNumbers)
{
    const Scene scene = scene_with_camera({});
    const CameraChoice choice = choice_of(scene, 0, scene.cameras[0]);
    EXPECT_EQ(choice.index, 0);
    EXPECT_FALSE(choice.position || choice.orientation || choice.y_fov);
}

TEST(Cameras, ThatWereFlownStandWhereTheyStood)
{
    const glm::dvec3 origin(1e6, -2e6, 0.0);
    const Scene scene = scene_with_camera(origin);
    // Turned by 90 degrees about y, the camera looks along -x: its quaternion is (0, sin 45, 0, cos 45).
    Camera flown = scene.cameras[0];
    flown.world_from_camera = glm::mat4(glm::vec4(0, 0, -1, 0), glm::vec4(0, 1, 0, 0), glm::vec4(1, 0, 0, 0),
                                        glm::vec4(5.0f, 6.0f, 7.0f, 1.0f));
    flown.y_fov = 1.25f;
    const CameraChoice choice = choice_of(scene, std::nullopt, flown);
    ASSERT_TRUE(choice.position && choice.orientation && choice.y_fov);
    EXPECT_EQ(*choice.position, origin + glm::dvec3(5.0, 6.0, 7.0));
    const double half = std::sqrt(0.5);
    EXPECT_NEAR(choice.orientation->w, half, 1e-12);
    EXPECT_NEAR(choice.orientation->y, half, 1e-12);
    EXPECT_NEAR(choice.orientation->x, 0.0, 1e-12);
    EXPECT_NEAR(choice.orientation->z, 0.0, 1e-12);
    const Camera placed = place_camera(scene, choice);
    EXPECT_EQ(placed.y_fov, 1.25f);
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            EXPECT_NEAR(placed.world_from_camera[column][row], flown.world_from_camera[column][row], 1e-6);
}

// A turn by 240 degrees about (1, 1, 1): its matrix is a permutation of the axes, its quaternion has no zero.
TEST(Cameras, StandAsAPresetSays)
{
    const Scene scene = scene_with_camera({});
    CameraChoice choice;
    choice.orientation = glm::dquat(-0.5, 0.5, 0.5, 0.5);
    const glm::mat4 turned = place_camera(scene, choice).world_from_camera;
    EXPECT_NEAR(glm::distance(glm::vec3(turned[0]), glm::vec3(0, 0, 1)), 0.0, 1e-6);
    EXPECT_NEAR(glm::distance(glm::vec3(turned[1]), glm::vec3(1, 0, 0)), 0.0, 1e-6);
    EXPECT_NEAR(glm::distance(glm::vec3(turned[2]), glm::vec3(0, 1, 0)), 0.0, 1e-6);
    EXPECT_EQ(glm::vec3(turned[3]), glm::vec3(1.0f, 2.0f, 3.0f));
    choice = {0, glm::dvec3(-1.0, 0.5, 4.0), {}, {}};
    EXPECT_EQ(glm::vec3(place_camera(scene, choice).world_from_camera[3]), glm::vec3(-1.0f, 0.5f, 4.0f));
    EXPECT_EQ(glm::mat3(place_camera(scene, choice).world_from_camera), glm::mat3(1.0f));
    EXPECT_THROW(place_camera(scene, {1, {}, {}, {}}), std::runtime_error);
    Scene orthographic = scene;
    orthographic.cameras[0].orthographic = true;
    EXPECT_THROW(place_camera(orthographic, {0, {}, {}, 0.5f}), std::runtime_error);
}

}  // namespace
}  // namespace conebook
