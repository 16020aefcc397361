// What runs again when something changes: against lists of passes, and against pictures that begin with the change.
#include "chapter_12_frames.hpp"

namespace conebook {
namespace {

using Runs = std::map<std::string, int>;

// Each of them once.
Runs once(const std::vector<std::string>& names)
{
    Runs runs;
    for (const std::string& name : names) runs[name] = 1;
    return runs;
}
Runs operator+(Runs a, const Runs& b)
{
    a.insert(b.begin(), b.end());
    return a;
}

const Runs kCamera = once({"g-buffer", "direct light", "diffuse cones", "composite"});
const Runs kFromBounces = once({"further bounces", "light pyramid"});
const Runs kFromShading = once({"voxel shading"}) + kFromBounces;
const Runs kFromLights = once({"shadow maps"}) + kFromShading;
const Runs kFromVoxels = once({"voxelize", "average", "walk volume", "coverage of voxels", "links"}) + kFromShading;
const Runs kAll = kFromVoxels + once({"shadow maps"});

TEST(OnlyWhatChanged, RunsAgain)
{
    Frames frames(asset("cornell_box"));
    EXPECT_EQ(frames.draw(), kAll + kCamera);
    for (int frame = 1; frame < 4; ++frame) EXPECT_EQ(frames.draw(), kCamera) << frame;

    frames.camera().world_from_camera[3].x += 0.1f;
    EXPECT_EQ(frames.draw(), kCamera);
    EXPECT_EQ(frames.draw(), kCamera);

    std::vector<Light> lights = frames.scene.lights();
    ASSERT_FALSE(lights.empty());
    lights[0].intensity *= 2.0f;
    frames.scene.set_lights(lights);
    EXPECT_EQ(frames.draw(), kFromLights + kCamera);
    EXPECT_EQ(frames.draw(), kCamera);
}

TEST(OnlyWhatChanged, OfTheParametersRunsAgain)
{
    Frames frames(asset("cornell_box"));
    frames.draw();
    const auto expect_after = [&](const char* what, const Runs& expected) {
        EXPECT_EQ(frames.draw(), expected + kCamera) << what;
        EXPECT_EQ(frames.draw(), kCamera) << what << ", once more";
    };
    BounceParams& bounces = frames.params.scene.bounces;
    ConeParams& cones = frames.params.camera.cones;
    bounces.bounces = 3;
    expect_after("bounces", kFromBounces);
    bounces.bounces = -1;
    expect_after("bounces", kFromBounces);
    bounces.tolerance = 1e-4f;
    expect_after("tolerance", kFromBounces);
    bounces.links = 9;
    expect_after("links", once({"links"}) + kFromBounces);
    cones.sky = 0.5f;
    expect_after("sky", kFromBounces);
    cones.start_offset = 1.0f;
    expect_after("start_offset", once({"links"}) + kFromBounces);
    frames.params.scene.voxels.shading.voxel_lambert = VoxelLambert::directional;
    expect_after("voxel_lambert", kFromShading);
    // Of the camera alone.
    cones.ao_falloff = 2.0f;
    cones.cones = 6;
    frames.params.camera.diffuse.gather_scale = 1;
    frames.params.camera.composite.bounce_strength = 2.0f;
    expect_after("what the camera's passes read", {});
}

// The rays of the faces have the table of the cones, and tilts that go with their aperture.
TEST(OnlyWhatChanged, LinksFollowTheDirectionsOfTheCones)
{
    Frames frames(asset("cornell_box"));
    frames.draw();
    frames.params.camera.cones.cone_table = ConeTable::thesis;
    EXPECT_EQ(frames.draw(), once({"links"}) + kFromBounces + kCamera);
    frames.params.camera.cones.aperture = 60.0f;
    EXPECT_EQ(frames.draw(), once({"links"}) + kFromBounces + kCamera);
}

std::vector<float> first_pixels(const FrameParams& params)
{
    Frames frames(asset("cornell_box"), params);
    frames.draw();
    return frames.pixels();
}

// Between all bounces and one the pyramid is made from other light, whatever the numbers of their revisions.
TEST(OnlyWhatChanged, OneBounceAfterAllIsOneBounce)
{
    FrameParams one = Frames::small();
    one.scene.bounces.bounces = 1;
    const std::vector<float> pixels = first_pixels(one);
    Frames frames(asset("cornell_box"));
    frames.draw();
    EXPECT_NE(frames.pixels(), pixels);
    frames.params.scene.bounces.bounces = 1;
    EXPECT_EQ(frames.draw(), once({"light pyramid"}) + kCamera);
    EXPECT_EQ(frames.pixels(), pixels);
}

TEST(OnlyWhatChanged, UpdateAlwaysRunsAllOfIt)
{
    FrameParams params = Frames::small();
    params.scene.voxels.update = Update::always;
    const std::vector<float> pixels = first_pixels(Frames::small());
    Frames frames(asset("cornell_box"), params);
    for (int frame = 0; frame < 3; ++frame) {
        EXPECT_EQ(frames.draw(), kAll + kCamera) << frame;
        EXPECT_EQ(frames.pixels(), pixels) << frame;  // each is a first one
    }
}

// What is drawn after a change is what is drawn when all begins with it.
TEST(OnlyWhatChanged, APictureDoesNotTellWhatWasBefore)
{
    const auto changed_after = [](int count) {
        Frames frames(asset("cornell_box"));
        for (int frame = 0; frame < count; ++frame) frames.draw();
        std::vector<Light> lights = frames.scene.lights();
        lights[0].position.x += 0.2f;
        frames.scene.set_lights(lights);
        frames.params.scene.bounces.links = 9;
        frames.params.camera.cones.sky = 0.25f;
        frames.camera().world_from_camera[3].y += 0.05f;
        frames.draw();
        return frames.pixels();
    };
    EXPECT_EQ(changed_after(3), changed_after(0));
}

// A still picture moves its camera by less than a pixel; a change begins anew with the middle of the pixels.
TEST(OnlyWhatChanged, ResetsTheSamples)
{
    Frames frames(asset("cornell_box"));
    frames.draw();
    const glm::mat4 first = frames.app().camera().clip_from_scene;
    const auto moves = [&] {
        frames.draw();
        return frames.app().camera().clip_from_scene != first;
    };
    EXPECT_TRUE(moves());
    EXPECT_TRUE(moves());
    frames.scene.set_lights(frames.scene.lights());
    EXPECT_FALSE(moves());
    EXPECT_TRUE(moves());
    frames.params.display.exposure += 1.0f;
    EXPECT_FALSE(moves());
    EXPECT_TRUE(moves());
    frames.params.camera.accumulation.accumulate = false;
    EXPECT_FALSE(moves());
    EXPECT_FALSE(moves());
}

// The program itself: every pass that does not depend on the camera once in five frames, and the scopes that it says.
TEST(OnlyWhatChanged, FiveFramesOfTheProgram)
{
    const TemporaryFolder folder;
    const std::string file = (folder / "stats.json").string();
    const ProgramRun run =
        run_program("12_second_bounce", "--headless --size 24x24 --frames 5 --scene '" + asset("cornell_box").string() +
                                            "' --stats '" + file + "' --set voxels=24");
    ASSERT_EQ(run.code, 0) << run.output;
    Runs expected = kAll;
    for (const auto& [name, runs] : kCamera) expected[name] = 5;
    Runs found;
    const std::map<std::string, std::string> of_scene = {
        {"voxelize", ""}, {"average", ""}, {"walk volume", ""}, {"coverage of voxels", ""}, {"links", ""}};
    const nlohmann::json stats = read_statistics(file);
    for (const auto& pass : stats.at("passes")) {
        const std::string name = pass.at("name");
        found[name] = pass.at("frames");
        EXPECT_EQ(pass.at("scope"), kCamera.contains(name) ? "camera" : of_scene.contains(name) ? "scene" : "light");
    }
    EXPECT_EQ(found, expected);
}

}  // namespace
}  // namespace conebook
