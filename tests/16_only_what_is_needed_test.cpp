// Plans: what they leave out changes no bit of the picture; what they expect of settings comes about.
#include <cmath>

#include "16_only_what_is_needed/demand.hpp"
#include "chapter_12_frames.hpp"
#include "robustness/gltf_builder.hpp"
#include "scene_builder.hpp"

namespace conebook {
namespace {

std::vector<std::string> used_parts(const LightPlan& plan)
{
    std::vector<std::string> used;
    for (const Need& need : {plan.shadow_maps, plan.visibility_volume, plan.voxels, plan.pyramid, plan.further_bounces,
                             plan.direct_light, plan.shadow_cones, plan.diffuse_cones, plan.specular_cones})
        if (need.used) used.push_back(need.name);
    return used;
}
using Names = std::vector<std::string>;

struct Settings {
    SceneLightParams scene;
    CameraLightParams camera;
    std::string view = "final";
    bool needs = true;
};
LightPlan plan_of(const Scene& scene, const Settings& s)
{
    return plan_frame(traits_of(scene), {s.scene, s.camera, s.view}, {s.needs});
}

Scene floor_of(const Material& material, bool lit = true)
{
    SceneBuilder b;
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, b.material(material));
    if (lit) b.point_light({0, 1, 0}, glm::vec3(1.0f));
    return b.build();
}

TEST(FramePlan, HoldsWhatTheSceneAsksFor)
{
    const Names lambertian = {"shadow maps",     "light in voxels", "light pyramid",
                              "further bounces", "direct light",    "diffuse cones"};
    EXPECT_EQ(used_parts(plan_of(floor_of(lambert(0.5f)), {})), lambertian);
    const Names of_metal = {"shadow maps",     "light in voxels", "light pyramid",
                            "further bounces", "direct light",    "specular cones"};
    EXPECT_EQ(used_parts(plan_of(floor_of(metal(glm::vec3(0.9f), 0.2f)), {})), of_metal);
    const Names of_emitter = {"light in voxels", "light pyramid", "further bounces", "diffuse cones"};
    EXPECT_EQ(used_parts(plan_of(floor_of(emitter(1.0f, 0.5f), false), {})), of_emitter);
    const Names all = {"shadow maps",     "visibility volume", "light in voxels", "light pyramid",
                       "further bounces", "direct light",      "diffuse cones",   "specular cones"};
    Settings off;
    off.needs = false;
    EXPECT_EQ(used_parts(plan_of(floor_of(emitter(1.0f, 0.5f), false), off)), all);
}

TEST(FramePlan, HoldsWhatTheViewAndTheSettingsAskFor)
{
    const Scene scene = floor_of(lambert(0.5f));
    Settings s;
    for (const char* surface : {"normal", "depth", "base_color", "emission"}) {
        s.view = surface;
        EXPECT_EQ(used_parts(plan_of(scene, s)), Names{}) << surface;
    }
    s.view = "direct";
    EXPECT_EQ(used_parts(plan_of(scene, s)), (Names{"shadow maps", "direct light"}));
    s.camera.shadows.shadows = ShadowMethod::cone;
    EXPECT_EQ(used_parts(plan_of(scene, s)),
              (Names{"shadow maps", "light in voxels", "light pyramid", "direct light", "shadow cones"}));
    s.scene.voxels.shading.voxel_shadows = VoxelShadows::none;
    EXPECT_EQ(used_parts(plan_of(scene, s)),
              (Names{"light in voxels", "light pyramid", "direct light", "shadow cones"}));
    s.camera.shadows.shadows = ShadowMethod::volume;
    EXPECT_EQ(used_parts(plan_of(scene, s)), (Names{"visibility volume", "light in voxels", "direct light"}));
    s = {};
    s.view = "voxels";
    EXPECT_EQ(used_parts(plan_of(scene, s)),
              (Names{"shadow maps", "light in voxels", "light pyramid", "further bounces"}));
    s = {};
    s.scene.bounces.bounces = 0;
    EXPECT_EQ(used_parts(plan_of(scene, s)), (Names{"shadow maps", "direct light"}));
    // Ambient occlusion is of surfaces whatever they reflect; and ao_strength darkens reflections by it.
    const Scene shiny = floor_of(metal(glm::vec3(0.9f), 0.2f));
    s = {};
    s.view = "ambient_occlusion";
    EXPECT_TRUE(plan_of(shiny, s).diffuse_cones.used);
    s.view = "final";
    EXPECT_FALSE(plan_of(shiny, s).diffuse_cones.used);
    s.camera.composite.ao_strength = 0.5f;
    EXPECT_TRUE(plan_of(shiny, s).diffuse_cones.used);
}

// A floor that looks up, nothing else: faces of one direction.
std::filesystem::path floor_file(const std::filesystem::path& folder, bool is_metal)
{
    test::GltfBuilder b;
    const int position = b.add_floats({-1, 0, 1, 1, 0, 1, 1, 0, -1, -1, 0, -1}, 3);
    const int indices = b.add_accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, test::u16, "SCALAR");
    b.append("materials", {{"pbrMetallicRoughness", {{"metallicFactor", is_metal ? 1 : 0}, {"roughnessFactor", 0.3}}}});
    b.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}, {"material", 0}});
    b.root["extensionsUsed"] = test::json::array({"KHR_lights_punctual"});
    const test::json light = {{"type", "point"}, {"intensity", 5}};
    b.root["extensions"]["KHR_lights_punctual"]["lights"] = test::json::array({light});
    b.add_node({{"mesh", 0}});
    test::json lamp = {{"translation", {0.3, 0.8, 0.1}}};
    lamp["extensions"]["KHR_lights_punctual"]["light"] = 0;
    b.add_node(lamp);
    b.root["scenes"][0]["nodes"] = {0, 1};
    return test::write_file(folder / (is_metal ? "metal.glb" : "floor.glb"), b.glb());
}

std::size_t bytes_of(const Frames& frames)
{
    std::size_t bytes = 0;
    for (const auto& part : {frames.scene_light->resources(), frames.camera_light->resources()})
        for (const gl::Resource& resource : part) bytes += resource.bytes;
    return bytes;
}

// Everything or what is needed, from the beginning and one after the other: the same bits.
TEST(OnlyWhatIsNeeded, GivesTheBitsOfEverything)
{
    const TemporaryFolder folder;
    struct Case {
        std::filesystem::path file;
        int bounces;
        ShadowMethod shadows;
    };
    const Case cases[] = {{asset("cornell_box"), -1, ShadowMethod::map},  // Lambert alone, nothing shines
                          {asset("cornell_box"), 1, ShadowMethod::cone},
                          {asset("cornell_area"), -1, ShadowMethod::map},  // no lights
                          {asset("white_furnace"), 3, ShadowMethod::map},  // shines all over
                          {asset("glossy_room"), -1, ShadowMethod::map},   // some lobes
                          {asset("glossy_room"), 0, ShadowMethod::volume},
                          {floor_file(folder.path(), true), -1, ShadowMethod::map},    // metal alone, one direction
                          {floor_file(folder.path(), false), -1, ShadowMethod::map}};  // one direction
    for (const Case& c : cases) {
        SCOPED_TRACE(c.file.stem().string() + " bounces=" + std::to_string(c.bounces));
        FrameParams start = Frames::small();
        start.scene.bounces.bounces = c.bounces;
        start.camera.shadows.shadows = c.shadows;
        start.camera.accumulation.accumulate = false;
        Frames frames(c.file, start);
        frames.draw();
        const std::vector<float> chapter_12 = frames.pixels();
        bool needs = true;
        frames.make_plan = [&](const SceneTraits& traits, const FrameParams& p) {
            return plan_frame(traits, {p.scene, p.camera, "final"}, {needs});
        };
        frames.renew();
        const std::map<std::string, int> needed = frames.draw();
        EXPECT_EQ(frames.pixels(), chapter_12);
        const std::size_t needed_bytes = bytes_of(frames);
        needs = false;
        frames.renew();
        const std::map<std::string, int> all = frames.draw();
        EXPECT_EQ(frames.pixels(), chapter_12);
        EXPECT_LT(needed_bytes, bytes_of(frames));
        EXPECT_LT(needed.size(), all.size());
        for (const auto& [pass, times] : needed) EXPECT_TRUE(all.contains(pass)) << pass;
        // And back, with what is there.
        needs = true;
        frames.draw();
        EXPECT_EQ(frames.pixels(), chapter_12);
    }
}

// A program for this scene alone would run these, and no others.
TEST(OnlyWhatIsNeeded, LambertianSceneWithoutMapsRunsThesePasses)
{
    FrameParams start = Frames::small();
    start.camera.shadows.shadows = ShadowMethod::cone;
    start.scene.voxels.shading.voxel_shadows = VoxelShadows::hard_ray;
    Frames frames(asset("cornell_box"), start);
    frames.make_plan = [](const SceneTraits& traits, const FrameParams& p) {
        return plan_frame(traits, {p.scene, p.camera, "final"}, {});
    };
    Names passes;
    for (const auto& [pass, times] : frames.draw()) passes.push_back(pass);
    EXPECT_EQ(passes,
              (Names{"average", "composite", "coverage of voxels", "diffuse cones", "direct light", "further bounces",
                     "g-buffer", "light pyramid", "links", "voxel shading", "voxelize", "walk volume"}));
}

// --- What is expected ---

// Half the voxels: error 0.05 instead of 0.03; half the cones: 0.04; all: 0.015 and twice the time.
MeasuredScene example()
{
    const auto row = [](Choice choice, double error, double camera_ms) {
        Measured m;
        m.choice = choice;
        m.error = error;
        m.ms = {{"voxelize", 10.0}, {"g-buffer", 5.0}, {"diffuse cones", camera_ms}};
        m.scopes = {{"voxelize", Scope::scene}, {"g-buffer", Scope::camera}, {"diffuse cones", Scope::camera}};
        return m;
    };
    MeasuredScene scene;
    scene.name = "example";
    scene.baseline = row({}, 0.03, 40.0);
    Choice voxels, cones, more;
    voxels.voxels = 64;
    cones.cones = 9;
    more.cones = 32;
    scene.alone = {row(voxels, 0.05, 30.0), row(cones, 0.04, 20.0), row(more, 0.015, 80.0)};
    return scene;
}

TEST(Expectation, AddsSquaresOfErrorsAndMultipliesTimes)
{
    const MeasuredScene scene = example();
    Choice both;
    both.voxels = 64;
    both.cones = 9;
    EXPECT_NEAR(expected_error(scene, both), std::sqrt(0.03 * 0.03 + 0.04 * 0.04 + 0.01 * 0.07), 1e-9);
    EXPECT_NEAR(expected_times(scene, both).camera_ms, 5.0 + 40.0 * 0.75 * 0.5, 1e-9);
    EXPECT_NEAR(expected_times(scene, both).scene_ms, 10.0, 1e-9);
    Choice better = both;
    better.cones = 32;
    EXPECT_NEAR(expected_error(scene, better), std::sqrt(0.015 * 0.015 + 0.05 * 0.05 - 0.03 * 0.03), 1e-9);
    EXPECT_NEAR(expected_error(scene, {}), 0.03, 1e-12);
}

struct Inputs {
    MeasuredScene measured = example();
    SceneSize scene;
    SceneTraits traits{true, {"specular cones", false, ""}, true, false};
    SceneLightParams scene_params;
    CameraLightParams camera_params;
    FrameSettings settings{scene_params, camera_params, "final"};
    NeedParams needs;
    Inputs() { scene.bounds = {glm::vec3(-1.0f), glm::vec3(1.0f)}; }
    DemandInputs get() { return {measured, {256, 256}, scene, traits, settings, needs, {256, 256}, 1.0}; }
};

TEST(Demand, ChoosesTheFastestThatIsExactEnoughOrTheMostExactThatIsFastEnough)
{
    Inputs inputs;
    DemandParams demand;
    demand.error = 0.045f;
    EXPECT_EQ(choose(demand, inputs.get()).choice.cones, 9);
    EXPECT_EQ(choose(demand, inputs.get()).choice.voxels, 128);
    demand.error = 0.02f;
    EXPECT_EQ(choose(demand, inputs.get()).choice.cones, 32);
    demand = {};
    demand.time_budget = 30.0f;
    EXPECT_EQ(choose(demand, inputs.get()).choice.cones, 9);  // 5 + 20 ms
    EXPECT_EQ(choose(demand, inputs.get()).choice.voxels, 128);
    demand = {};
    demand.memory = 60.0f;  // 128 voxels take 115 MB in the pyramids alone
    EXPECT_EQ(choose(demand, inputs.get()).choice.voxels, 64);
    EXPECT_EQ(choose(demand, inputs.get()).choice.cones, 32);
    // What the reader has set stays.
    demand = {};
    demand.error = 0.9f;
    inputs.camera_params.cones.cones = 32;
    EXPECT_EQ(choose(demand, inputs.get()).choice.cones, 32);
}

TEST(Demand, BeyondReachNamesTheNearest)
{
    Inputs inputs;
    for (const auto& [demand, words] : {std::pair(DemandParams{0.001f, 0.0f, 0.0f}, "error=0.001"),
                                        std::pair(DemandParams{0.02f, 60.0f, 0.0f}, "error=0.02 memory=60"),
                                        std::pair(DemandParams{0.0f, 0.0f, 1.0f}, "time_budget=1")})
        try {
            choose(demand, inputs.get());
            ADD_FAILURE() << words;
        } catch (const std::runtime_error& error) {
            const std::string text = error.what();
            EXPECT_EQ(text.rfind(words, 0), 0u) << text;
            EXPECT_NE(text.find("the nearest has error"), std::string::npos) << text;
            EXPECT_NE(text.find("voxels="), std::string::npos) << text;
            EXPECT_EQ(text.find('\n'), std::string::npos);
        }
}

// Settings that were measured together against what is expected from those measured alone.
TEST(Expectation, HoldsForSettingsThatWereMeasuredTogether)
{
    const MeasuredSettings all = read_measured_settings(repository_folder() / "assets" / "plan.json");
    int compared = 0;
    for (const MeasuredScene& scene : all.scenes)
        for (const Measured& row : scene.together) {
            const double ratio = expected_error(scene, row.choice) / row.error;
            EXPECT_GT(ratio, 1.0 / 1.5) << scene.name << " " << text_of(row.choice);
            EXPECT_LT(ratio, 1.5) << scene.name << " " << text_of(row.choice);
            ++compared;
        }
    EXPECT_GE(compared, 24);
}

// Four scenes, each drawn as planned: error against the path tracer and bytes are as expected.
TEST(Demand, IsKeptTo)
{
    const TemporaryFolder folder;
    const std::string size = " --size 256x256 ", output = (folder / "picture.exr").string();
    struct Case {
        const char *scene, *demand;
    };
    for (const Case& c : {Case{"cornell_box", "error=0.06"}, Case{"cornell_area", "memory=40"},
                          Case{"colonnade", "error=0.1 memory=60"}, Case{"glossy_room", "error=0.06"}}) {
        SCOPED_TRACE(std::string(c.scene) + " " + c.demand);
        const std::string scene = " --scene '" + asset(c.scene).string() + "'";
        ProgramRun run =
            run_program("16_only_what_is_needed", "--headless" + scene + size + "--output '" + output + "' --stats '" +
                                                      (folder / "stats.json").string() + "' --set " + c.demand);
        ASSERT_EQ(run.code, 0) << run.output;
        // 17 samples a pixel, whose neighbours share: noise of about 0.02 in blocks of 4 x 4 pixels.
        run = run_program("reference", scene + size + "--spp 17 --share --bounces -1 --output '" +
                                           (folder / "truth.exr").string() + "'");
        ASSERT_EQ(run.code, 0) << run.output;
        run = run_program("compare", "'" + output + "' '" + (folder / "truth.exr").string() +
                                         "' --block 4 --no-flip --json '" + (folder / "error.json").string() + "'");
        ASSERT_EQ(run.code, 0) << run.output;
        const double error = read_statistics(folder / "error.json").at("smape");
        const nlohmann::json stats = read_statistics(folder / "stats.json");
        const double error_ratio = count_of(stats, "expected error") / error;
        EXPECT_GT(error_ratio, 1.0 / 1.5) << error;
        EXPECT_LT(error_ratio, 1.5) << error;
        double bytes = 0.0;
        for (const auto& resource : stats.at("resources")) bytes += double(resource.at("bytes"));
        const double memory_ratio = count_of(stats, "expected memory") / (bytes * 1e-6);
        EXPECT_GT(memory_ratio, 1.0 / 1.5) << bytes;
        EXPECT_LT(memory_ratio, 1.5) << bytes;
    }
}

}  // namespace
}  // namespace conebook
