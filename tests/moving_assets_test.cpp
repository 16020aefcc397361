// The scenes of assets/ that move: where their parts are at a time, by closed forms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>

#include "scene/pose.hpp"

namespace conebook {
namespace {

constexpr const char* kMoving[] = {"door", "walking_lamp", "spinning_shapes", "figure"};
// Keys are floats rounded to 2^-20, and a room is some metres wide.
constexpr double kClose_m = 1e-5;

Scene asset(const std::string& name)
{
    const char* root = std::getenv("CONEBOOK_ROOT");
    if (root == nullptr) throw std::runtime_error("CONEBOOK_ROOT is not set; run through ctest");
    return load_scene(std::filesystem::path(root) / "assets" / (name + ".glb"));
}

std::size_t node_named(const Scene& scene, const std::string& name)
{
    for (std::size_t i = 0; i < scene.nodes.size(); ++i)
        if (scene.nodes[i].name == name) return i;
    throw std::runtime_error("no node " + name);
}

Bounds box_of(const std::vector<Vertex>& vertices)
{
    Bounds box{vertices.at(0).position, vertices[0].position};
    for (const Vertex& vertex : vertices) {
        box.min = glm::min(box.min, vertex.position);
        box.max = glm::max(box.max, vertex.position);
    }
    return box;
}

// World space.
glm::dvec3 middle_of(const Scene& scene, const std::string& name, double time_s)
{
    const Bounds box = box_of(posed_vertices(scene, pose_nodes(scene, time_s), node_named(scene, name)));
    return glm::dvec3(box.center()) + scene.origin_ws;
}

// A point in the space of a node, in world space.
glm::dvec3 carried(const Scene& scene, const std::string& name, double time_s, const glm::dvec3& point)
{
    const NodePose pose = pose_nodes(scene, time_s)[node_named(scene, name)];
    return glm::dvec3(pose.world_from_node * glm::dvec4(point, 1.0));
}

void expect_near(const glm::dvec3& a, const glm::dvec3& b) { EXPECT_LT(glm::distance(a, b), kClose_m); }

class MovingAsset : public testing::TestWithParam<const char*> {};

TEST_P(MovingAsset, EndsAsItBeginsAndMovesBetween)
{
    const Scene scene = asset(GetParam());
    const double length_s = duration(scene);
    EXPECT_GT(length_s, 1.0);
    const Pose first = pose(scene, 0.0), last = pose(scene, length_s), middle = pose(scene, 0.45 * length_s);
    double apart = 0.0, moved = 0.0;
    for (std::size_t i = 0; i < scene.vertices.size(); ++i) {
        apart = std::max(apart, double(glm::distance(first.vertices[i].position, last.vertices[i].position)));
        moved = std::max(moved, double(glm::distance(first.vertices[i].position, middle.vertices[i].position)));
    }
    EXPECT_LT(apart, kClose_m);
    EXPECT_GT(moved, 0.1);
}

// The file's own places are the first keys, so that the scene at rest is the scene at 0 s.
TEST_P(MovingAsset, RestsAsItBegins)
{
    const Scene scene = asset(GetParam());
    const bool walks = std::string(GetParam()) == "figure";  // a figure at rest stands still
    const Pose first = pose(scene, 0.0);
    for (const Node& node : scene.nodes) {
        if (walks && node.skin >= 0) continue;
        for (std::uint32_t v = node.vertices.first; v < node.vertices.end(); ++v)
            ASSERT_LT(glm::distance(first.vertices[v].position, scene.vertices[v].position), kClose_m) << node.name;
    }
}

INSTANTIATE_TEST_SUITE_P(Assets, MovingAsset, testing::ValuesIn(kMoving),
                         [](const auto& info) { return std::string(info.param); });

TEST(MovingAssets, HaveEveryWayToMove)
{
    std::set<Interpolation> ways;
    std::set<AnimationPath> paths;
    std::size_t skins = 0, lights = 0;
    for (const char* name : kMoving) {
        const Scene scene = asset(name);
        for (const Animation& animation : scene.animations) {
            for (const AnimationSampler& sampler : animation.samplers) ways.insert(sampler.interpolation);
            for (const AnimationChannel& channel : animation.channels) paths.insert(channel.path);
        }
        skins += scene.skins.size();
        for (const Node& node : scene.nodes) lights += node.light >= 0 && node.dynamic;
    }
    EXPECT_EQ(ways.size(), 3u);
    EXPECT_EQ(paths.size(), 4u);
    EXPECT_EQ(skins, 1u);
    EXPECT_EQ(lights, 1u);
}

// 1 s closed, 2 s to 100 degrees, 1 s open. Halfway a spline that rests at its ends is at the mean of both quaternions,
// which stands at half the angle.
TEST(MovingAssets, DoorTurnsAboutItsHinge)
{
    const Scene scene = asset("door");
    const glm::dvec3 hinge(0.0625, 0.0, -0.5);
    for (const auto& [time_s, degrees] : {std::pair(0.5, 0.0), {2.0, 50.0}, {3.0, 100.0}, {3.7, 100.0}, {5.0, 50.0}}) {
        const double angle = glm::radians(degrees);
        expect_near(carried(scene, "door", time_s, {0.0, 0.0, 1.0}),
                    hinge + glm::dvec3(std::sin(angle), 0.0, std::cos(angle)));
    }
}

// y = v t - g/2 t^2 above the floor, for the 2/3 s of a jump.
TEST(MovingAssets, BallFallsFreely)
{
    const Scene scene = asset("spinning_shapes");
    const double speed = 9.81 / 3.0;
    for (const double t : {0.0, 0.1, 0.25, 1.0 / 3.0, 0.6}) {
        const glm::dvec3 free_fall(-0.4, 0.2 + speed * t - 0.5 * 9.81 * t * t, 0.45);
        expect_near(middle_of(scene, "ball", t), free_fall);
        expect_near(middle_of(scene, "ball", t + 4.0 / 3.0), free_fall);
    }
}

// A step holds until the next key: 16 to a turn of 4 s.
TEST(MovingAssets, CubeTurnsInSteps)
{
    const Scene scene = asset("spinning_shapes");
    for (const double t : {0.0, 0.2, 0.26, 1.1}) {
        const double angle = glm::two_pi<double>() / 16.0 * std::floor(t / 0.25);
        expect_near(carried(scene, "cube", t, {0.0, 0.0, 1.0}),
                    glm::dvec3(0.7, 0.5, -0.4) + glm::dvec3(std::sin(angle), 0.0, std::cos(angle)));
    }
}

TEST(MovingAssets, LampCarriesItsLightAndStaysAboveTheFloor)
{
    const Scene scene = asset("walking_lamp");
    ASSERT_EQ(scene.lights.size(), 1u);
    for (int i = 0; i < 80; ++i) {
        const double t = 0.1 * i;
        const Pose now = pose(scene, t);
        EXPECT_GT(double(now.bounds.min.y) + scene.origin_ws.y, -kClose_m) << t;
        const glm::dvec3 beam = glm::normalize(glm::dvec3(0.0, -0.25, 1.0));
        const glm::dvec3 place = glm::dvec3(now.lights[0].position) + scene.origin_ws;
        expect_near(place, carried(scene, "walker", t, {0.0, 0.72, 0.16}));
        expect_near(glm::dvec3(now.lights[0].direction),
                    carried(scene, "walker", t, beam) - carried(scene, "walker", t, glm::dvec3(0.0)));
    }
    // A quarter of the way round after 2 s, and it looks where it goes: along -z.
    expect_near(carried(scene, "walker", 2.0, {0.0, 0.0, 1.0}), {1.45, 0.0, -1.0});
}

// Weight 1/2 halfway to the flat ball, which is 1.4 times as wide and 0.4 times as high.
TEST(MovingAssets, BallMorphs)
{
    const Scene scene = asset("figure");
    const std::size_t ball = node_named(scene, "ball");
    for (const auto& [time_s, weight] : {std::pair(0.0, 0.0), {0.5, 0.5}, {1.0, 1.0}, {1.5, 0.5}}) {
        const Bounds box = box_of(posed_vertices(scene, pose_nodes(scene, time_s), ball));
        EXPECT_NEAR(double(box.extent().x), 0.56 * (1.0 + 0.4 * weight), kClose_m);
        EXPECT_NEAR(double(box.extent().y), 0.56 * (1.0 - 0.6 * weight), kClose_m);
    }
}

// After a quarter of 2 s the left leg has swung 30 degrees back about the hip and its knee is at 13.5 degrees; what hangs
// on the lower joint alone goes with it, and nowhere is the skin torn.
TEST(MovingAssets, SkinFollowsItsJoints)
{
    const Scene scene = asset("figure");
    const std::size_t figure = node_named(scene, "figure");
    const double hip = glm::radians(-30.0), knee = hip + glm::radians(13.5);
    const auto down = [](double angle) { return -glm::dvec3(0.0, std::cos(angle), std::sin(angle)); };
    const glm::dvec3 from(-0.15, 0.89, 0.0), ankle = from + 0.39 * down(hip) + 0.39 * down(knee);
    expect_near(carried(scene, "leg_left_lower", 0.5, {0.0, -0.39, 0.0}), ankle);

    const std::vector<NodePose> nodes = pose_nodes(scene, 0.5);
    const std::vector<Vertex> posed = posed_vertices(scene, nodes, figure);
    const Node& node = scene.nodes[figure];
    const Skin& skin = scene.skins.at(0);
    std::size_t rigid = 0;
    for (std::uint32_t v = 0; v < node.modelled.count; ++v) {
        const ModelledVertex& modelled = scene.modelled[node.modelled.first + v];
        for (int k = 0; k < 4; ++k) {
            if (modelled.weights[k] != 1.0f) continue;
            const std::size_t joint = std::size_t(skin.joints[modelled.joints[k]]);
            const glm::dmat4 matrix = nodes[joint].world_from_node * glm::inverse(scene.nodes[joint].world_from_node);
            expect_near(glm::dvec3(posed[v].position) + scene.origin_ws,
                        glm::dvec3(matrix * glm::dvec4(modelled.position, 1.0)));
            ++rigid;
        }
    }
    EXPECT_GT(rigid, node.modelled.count / 2);
    for (std::uint32_t i = node.indices.first; i < node.indices.end(); ++i) {
        const std::uint32_t next = (i - node.indices.first) % 3 == 2 ? i - 2 : i + 1;
        const std::uint32_t a = scene.indices[i], b = scene.indices[next];
        const double rest = glm::distance(scene.vertices[a].position, scene.vertices[b].position);
        const auto at = [&](std::uint32_t v) { return posed[v - node.vertices.first].position; };
        ASSERT_LT(double(glm::distance(at(a), at(b))), 2.0 * rest + kClose_m);
    }
}

}  // namespace
}  // namespace conebook
