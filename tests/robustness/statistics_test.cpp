// What --stats says: the fixed fields of every chapter, and needs that agree with what the scenes are known to hold
// and with the passes that were run.
#include <filesystem>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "image/image.hpp"
#include "program.hpp"
#include "robustness/gltf_builder.hpp"
#include "statistics_file.hpp"
#include "temporary_folder.hpp"

namespace conebook {
namespace {

using nlohmann::json;

std::string scene(const std::filesystem::path& file) { return "--scene '" + file.string() + "' "; }

// A run with small settings; its statistics.
class Measured {
public:
    explicit Measured(const std::string& arguments, const std::string& program = "12_second_bounce")
    {
        const std::string files =
            " --output '" + (folder_ / "x.exr").string() + "' --stats '" + (folder_ / "x.json").string() + "'";
        const ProgramRun run = run_program(program, "--headless --size 48x48 " + coarse_settings(program) + arguments + files);
        if (run.code != 0) throw std::runtime_error(program + " " + arguments + ": " + run.output);
        json_ = read_statistics(folder_ / "x.json");
    }
    const json& all() const { return json_; }
    // Nothing when the need is not named.
    std::optional<bool> needs(const std::string& name) const
    {
        const json need = named(json_, "needed", name);
        return need.is_null() ? std::nullopt : std::optional(need.at("used").get<bool>());
    }
    std::string reason(const std::string& name) const { return named(json_, "needed", name).value("reason", ""); }
    bool has(const char* list, const std::string& name) const { return !named(json_, list, name).is_null(); }
    std::vector<glm::vec4> pixels() const { return read_exr(folder_ / "x.exr").pixels; }

private:
    TemporaryFolder folder_;
    json json_;
};

class Statistics : public testing::TestWithParam<std::string> {};

TEST_P(Statistics, HoldTheFixedFields)
{
    const Measured run("--frames 3 " + scene(asset("materials")), GetParam());
    EXPECT_EQ(run.all().at("program"), GetParam());
    EXPECT_NE(run.all().at("driver"), "");
    EXPECT_EQ(run.all().at("size"), json({48, 48}));
    EXPECT_EQ(run.all().at("seed"), 0);
    ASSERT_FALSE(run.all().at("passes").empty());
    for (const json& pass : run.all().at("passes")) {
        SCOPED_TRACE(pass.dump());
        EXPECT_GT(pass.at("min_ms"), 0.0);
        EXPECT_LE(pass.at("min_ms"), pass.at("median_ms"));
        EXPECT_TRUE(pass.at("frames") == 3 || pass.at("frames") == 1);  // 1: geometry that stands still
    }
    ASSERT_FALSE(run.all().at("resources").empty());
    for (const json& resource : run.all().at("resources")) EXPECT_GT(resource.at("bytes"), 0) << resource;
    ASSERT_FALSE(run.all().at("needed").empty());
    std::set<std::string> names;
    for (const json& need : run.all().at("needed")) {
        EXPECT_NE(need.at("reason"), "") << need;
        EXPECT_TRUE(names.insert(need.at("name")).second) << need << " twice";
    }
    EXPECT_EQ(run.needs("framing camera"), false);
}

INSTANTIATE_TEST_SUITE_P(Chapters, Statistics, testing::ValuesIn(chapters()),
                         [](const auto& info) { return "c" + info.param; });

TEST(Needs, OfAPointLightInALambertianBox)
{
    const Measured run(scene(asset("cornell_box")));
    for (const char* name : {"default light", "emission", "emission in voxels", "textures", "textures in voxels",
                             "alpha mask", "normal maps", "specular cones", "sky", "visibility volume", "shadow cones"})
        EXPECT_EQ(run.needs(name), false) << name << run.reason(name);
    for (const char* name : {"shadow map of light 0", "diffuse cones", "further bounces"})
        EXPECT_EQ(run.needs(name), true) << name << run.reason(name);
    EXPECT_EQ(run.reason("shadow map of light 0"), "point light: 6 maps");
    EXPECT_EQ(run.needs("shadow map of light 1"), std::nullopt);
    EXPECT_TRUE(run.has("passes", "diffuse cones"));
    EXPECT_FALSE(run.has("passes", "specular cones"));
    EXPECT_FALSE(run.has("resources", "specular light"));
}

TEST(Needs, OfALampAlone)
{
    const Measured run(scene(asset("cornell_area")));
    EXPECT_EQ(run.needs("emission"), true);
    EXPECT_EQ(run.reason("emission"), "1 of 6 materials with emission");
    EXPECT_EQ(run.needs("emission in voxels"), true);
    EXPECT_EQ(run.needs("default light"), false);
    EXPECT_EQ(run.needs("shadow maps"), false);
    EXPECT_EQ(run.needs("shadow map of light 0"), std::nullopt);
}

TEST(Needs, OfThreeLightsAndReflectingSpheres)
{
    const Measured run(scene(asset("materials")));
    EXPECT_EQ(run.reason("shadow map of light 0"), "point light: 6 maps");
    EXPECT_EQ(run.reason("shadow map of light 1"), "spot light: one map");
    EXPECT_EQ(run.reason("shadow map of light 2"), "directional light: one map");
    EXPECT_EQ(run.reason("specular cones"), "19 of 22 materials with a specular lobe");  // the three walls have none
    EXPECT_EQ(run.needs("specular cones"), true);
    EXPECT_EQ(run.needs("textures"), true);
    EXPECT_TRUE(run.has("passes", "specular cones"));
}

TEST(Needs, OfMasksAndNormalMaps)
{
    const Measured run(scene(asset("colonnade")));
    for (const char* name : {"textures", "textures in voxels", "alpha mask", "normal maps"})
        EXPECT_EQ(run.needs(name), true) << name;
    EXPECT_EQ(run.needs("normal maps in voxels"), false);
    EXPECT_EQ(run.needs("specular cones"), false);
}

TEST(Needs, FollowTheParameters)
{
    const Measured direct("--set bounces=0 sky=0 ");
    for (const char* name : {"diffuse cones", "specular cones", "further bounces"})
        EXPECT_EQ(direct.needs(name), false) << name;
    EXPECT_FALSE(direct.has("passes", "diffuse cones"));

    const Measured once("--set bounces=1 sky=0.5 ");
    EXPECT_EQ(once.needs("diffuse cones"), true);
    EXPECT_EQ(once.needs("further bounces"), false);
    EXPECT_EQ(once.needs("sky"), true);

    const Measured volume("--set shadows=volume ");
    EXPECT_EQ(volume.needs("visibility volume"), true);
    EXPECT_TRUE(volume.has("resources", "visibility volume"));
    EXPECT_EQ(volume.needs("shadow map of light 0"), true);  // of the voxels

    const Measured rays("--set shadows=cone voxel_shadows=hard_ray ");
    EXPECT_EQ(rays.needs("shadow cones"), true);
    EXPECT_EQ(rays.needs("shadow map of light 0"), false);
    EXPECT_FALSE(rays.has("passes", "shadow maps"));
    EXPECT_FALSE(rays.has("resources", "visibility volume"));
}

TEST(Needs, OfAFileWithoutLightAndCamera)
{
    const TemporaryFolder folder;
    test::write_file(folder / "x.glb", test::one_triangle().glb());
    const Measured run(scene(folder / "x.glb"));
    EXPECT_EQ(run.needs("framing camera"), true);
    EXPECT_EQ(run.needs("default light"), true);
    // Nothing stands behind a single triangle.
    EXPECT_EQ(run.reason("shadow map of light 0"), "directional light: nothing that it lights is behind anything");
    EXPECT_EQ(run.needs("specular cones"), true);  // glTF's default material is metal
}

// Left out is what would not have changed a bit: the same floor and wall, once with a reflecting triangle besides that
// has no area and is not seen, but makes the program trace the cones.
TEST(Needs, WhatIsLeftOutWouldHaveAddedNothing)
{
    const auto corner = [](bool reflecting) {
        test::GltfBuilder gltf;
        const auto matte = [&](double specular) {
            const json factor = {{"specularFactor", specular}};
            return gltf.append("materials", {{"pbrMetallicRoughness", {{"metallicFactor", 0.0}}},
                                             {"extensions", {{"KHR_materials_specular", factor}}}});
        };
        const int lambert = matte(0.0), other = matte(reflecting ? 1.0 : 0.0);
        const auto add = [&](const std::vector<float>& corners, int material) {
            const int position = gltf.add_floats(corners, 3);
            const int mesh = gltf.add_mesh({{"attributes", {{"POSITION", position}}}, {"material", material}});
            gltf.root["scenes"][0]["nodes"][std::size_t(mesh)] = gltf.add_node({{"mesh", mesh}});
        };
        add({0, 0, 0, 0, 0, 2, 2, 0, 0, 2, 0, 0, 0, 0, 2, 2, 0, 2}, lambert);
        add({0, 0, 0, 2, 0, 0, 0, 2, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0}, lambert);
        add({1, 1, 0, 1, 1, 0, 1, 1, 0}, other);
        gltf.root["extensionsUsed"] = {"KHR_materials_specular"};
        return gltf.glb();
    };
    const TemporaryFolder folder;
    test::write_file(folder / "without.glb", corner(false));
    test::write_file(folder / "with.glb", corner(true));
    for (const char* program : {"09_specular_cones", "11_emissives", "12_second_bounce"}) {
        SCOPED_TRACE(program);
        const Measured without(scene(folder / "without.glb"), program);
        const Measured with(scene(folder / "with.glb"), program);
        EXPECT_FALSE(without.has("passes", "specular cones"));
        ASSERT_TRUE(with.has("passes", "specular cones"));
        EXPECT_EQ(without.pixels(), with.pixels());
        double sum = 0.0;
        for (const glm::vec4& pixel : without.pixels()) sum += double(pixel.r);
        EXPECT_GT(sum, 1.0) << "an empty picture shows nothing";
    }
}

}  // namespace
}  // namespace conebook
