// What the loader keeps for those who move a scene: nodes and what they placed, animations, skins, extras.
#include <cmath>

#include <gtest/gtest.h>

#include "robustness/gltf_builder.hpp"

namespace conebook::test {
namespace {

const Node& node_named(const Scene& scene, const std::string& name)
{
    for (const Node& node : scene.nodes) {
        if (node.name == name) return node;
    }
    throw std::runtime_error("no node " + name);
}

// root (turned about z, scaled, moved) > arm (a matrix) > hand; root > lamp, eye. `hand` and `root` have the triangle.
GltfBuilder a_tree()
{
    GltfBuilder gltf = one_triangle();
    const double half = std::sqrt(0.5);
    gltf.root["nodes"] = {
        {{"name", "hand"}, {"mesh", 0}, {"translation", {0, 3, 0}}, {"extras", {{"grip", 2}}}},
        {{"name", "root"},
         {"mesh", 0},
         {"children", {2, 3, 4}},
         {"translation", {10, 0, 0}},
         {"rotation", {0, 0, half, half}},
         {"scale", {2, 2, 2}}},
        {{"name", "arm"}, {"children", {0}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}}},
        {{"name", "lamp"}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
        {{"name", "eye"}, {"camera", 0}},
        {{"name", "elsewhere"}}};
    gltf.root["scenes"] = {{{"nodes", {1}}, {"extras", {{"author", "me"}}}}};
    gltf.root["meshes"][0]["extras"] = json::array({1, 2});
    gltf.root["materials"] = {{{"name", "m"}, {"extras", "soft"}}};
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    return gltf;
}

TEST(GltfMotion, NodesKeepTheirPlaceInTheTree)
{
    const Scene scene = a_tree().load();
    EXPECT_EQ(scene_fault(scene), "");
    std::vector<std::string> names;
    for (const Node& node : scene.nodes) names.push_back(node.name);
    EXPECT_EQ(names, (std::vector<std::string>{"root", "arm", "hand", "lamp", "eye"}));
    EXPECT_EQ(scene.nodes[0].parent, -1);
    EXPECT_EQ(scene.nodes[1].parent, 0);
    EXPECT_EQ(scene.nodes[2].parent, 1);
    EXPECT_EQ(scene.nodes[2].file_index, 0);
    EXPECT_EQ(scene.nodes[3].light, 0);
    EXPECT_EQ(scene.nodes[4].camera, 0);
    EXPECT_EQ(scene.nodes[4].light, -1);
    EXPECT_EQ(scene.nodes[0].local.translation, glm::dvec3(10, 0, 0));
    EXPECT_EQ(scene.nodes[0].local.scale, glm::dvec3(2, 2, 2));
    EXPECT_NEAR(scene.nodes[0].local.rotation.w, std::sqrt(0.5), 1e-12);
    EXPECT_NEAR(scene.nodes[0].local.rotation.z, std::sqrt(0.5), 1e-12);
    EXPECT_FALSE(scene.nodes[0].matrix);
    ASSERT_TRUE(scene.nodes[1].matrix);
    EXPECT_EQ(glm::dvec3((*scene.nodes[1].matrix)[3]), glm::dvec3(1, 0, 0));
    // hand: (0, 3, 0), by arm (1, 3, 0), scaled (2, 6, 0), turned by 90 degrees (-6, 2, 0), moved (4, 2, 0).
    EXPECT_NEAR(glm::length(glm::dvec3(scene.nodes[2].world_from_node[3]) - glm::dvec3(4, 2, 0)), 0.0, 1e-12);
    // The rule by which a pose is made gives what the file says.
    for (const Node& node : scene.nodes) {
        const glm::dmat4 parent =
            node.parent < 0 ? glm::dmat4(1.0) : scene.nodes[static_cast<std::size_t>(node.parent)].world_from_node;
        EXPECT_EQ(node.world_from_node, parent * node.local_matrix()) << node.name;
    }
    EXPECT_EQ(json::parse(node_named(scene, "hand").extras), (json{{"grip", 2}}));
    EXPECT_EQ(json::parse(node_named(scene, "hand").mesh_extras), (json::array({1, 2})));
    EXPECT_EQ(node_named(scene, "root").extras, "");
    EXPECT_EQ(json::parse(scene.extras), (json{{"author", "me"}}));
    EXPECT_EQ(json::parse(scene.materials[0].extras), json("soft"));
}

// Moving what a node placed by hand must be the same as loading the file with the node moved.
TEST(GltfMotion, WhatANodePlacedCanBeMoved)
{
    GltfBuilder gltf = a_tree();
    const int second = gltf.add_floats({0, 0, 5, 1, 0, 5, 0, 1, 5}, 3);
    gltf.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", second}}}});
    const Scene before = gltf.load();
    gltf.root["nodes"][0]["translation"] = {0, 4, 1};  // hand
    const Scene after = gltf.load();
    const Node& hand = node_named(before, "hand");
    EXPECT_EQ(hand.draws.count, 2u);
    EXPECT_EQ(hand.vertices.count, 6u);
    EXPECT_EQ(hand.indices.count, 6u);
    EXPECT_EQ(node_named(before, "arm").vertices.count, 0u);
    const glm::dmat4 new_from_old = node_named(after, "hand").world_from_node * glm::inverse(hand.world_from_node);
    glm::vec3 low(1e30f), high(-1e30f);
    for (std::uint32_t v = 0; v < before.vertices.size(); ++v) {
        const bool is_hands = v >= hand.vertices.first && v < hand.vertices.end();
        const glm::dvec3 old_ws = glm::dvec3(before.vertices[v].position) + before.origin_ws;
        const glm::dvec3 moved = is_hands ? glm::dvec3(new_from_old * glm::dvec4(old_ws, 1.0)) : old_ws;
        const glm::dvec3 new_ws = glm::dvec3(after.vertices[v].position) + after.origin_ws;
        EXPECT_LT(glm::length(moved - new_ws), 1e-5) << v;  // rounding of floats of 20 m
        if (!is_hands) continue;
        low = glm::min(low, before.vertices[v].position);
        high = glm::max(high, before.vertices[v].position);
    }
    EXPECT_EQ(hand.bounds.min, low);
    EXPECT_EQ(hand.bounds.max, high);
}

TEST(GltfMotion, AnimationsAreKept)
{
    GltfBuilder gltf = a_tree();
    primitive(gltf)["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
    const int times = gltf.add_floats({0, 0.5f, 2}, 1);
    const int rotations =
        gltf.add_accessor<std::int16_t>({0, 0, 0, 32767, 0, 0, 32767, 0, 0, 32767, 0, 0}, s16, "VEC4", true);
    const int moves = gltf.add_floats({1, 2, 3, 4, 5, 6, 7, 8, 9}, 3);
    std::vector<float> splines;
    for (int i = 0; i < 3 * 3 * 2; ++i) splines.push_back(float(i));
    const int weights = gltf.add_floats(splines, 1);
    gltf.root["animations"] = {{{"name", "wave"},
                                {"samplers",
                                 {{{"input", times}, {"output", rotations}},
                                  {{"input", times}, {"output", moves}, {"interpolation", "STEP"}},
                                  {{"input", times}, {"output", weights}, {"interpolation", "CUBICSPLINE"}}}},
                                {"channels",
                                 {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "rotation"}}}},
                                  {{"sampler", 1}, {"target", {{"node", 0}, {"path", "scale"}}}},
                                  {{"sampler", 1}, {"target", {{"node", 1}, {"path", "translation"}}}},
                                  {{"sampler", 2}, {"target", {{"node", 1}, {"path", "weights"}}}},
                                  {{"sampler", 1}, {"target", {{"node", 5}, {"path", "translation"}}}}}}}};
    const Scene scene = gltf.load();
    EXPECT_EQ(scene_fault(scene), "");
    ASSERT_EQ(scene.animations.size(), 1u);
    const Animation& wave = scene.animations[0];
    EXPECT_EQ(wave.name, "wave");
    ASSERT_EQ(wave.samplers.size(), 3u);
    ASSERT_EQ(wave.channels.size(), 4u) << "node 5 is not in the scene";
    EXPECT_EQ(wave.channels[0].path, AnimationPath::rotation);
    EXPECT_EQ(wave.channels[1].path, AnimationPath::scale);
    EXPECT_EQ(wave.channels[2].path, AnimationPath::translation);
    EXPECT_EQ(wave.channels[3].path, AnimationPath::weights);
    EXPECT_EQ(scene.nodes[static_cast<std::size_t>(wave.channels[0].node)].name, "hand");
    EXPECT_EQ(scene.nodes[static_cast<std::size_t>(wave.channels[2].node)].name, "root");
    EXPECT_EQ(wave.samplers[0].interpolation, Interpolation::linear);
    EXPECT_EQ(wave.samplers[1].interpolation, Interpolation::step);
    EXPECT_EQ(wave.samplers[2].interpolation, Interpolation::cubic_spline);
    EXPECT_EQ(wave.samplers[0].times, (std::vector<float>{0, 0.5f, 2}));
    EXPECT_EQ(wave.samplers[0].values, (std::vector<float>{0, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0}));
    EXPECT_EQ(wave.samplers[1].values, (std::vector<float>{1, 2, 3, 4, 5, 6, 7, 8, 9}));
    EXPECT_EQ(wave.samplers[2].values, splines);
    EXPECT_EQ(wave.samplers[2].width(), 2u);
}

// A scene with such an animation is still a picture.
TEST(GltfMotion, UnsoundAnimationsAreLeftOutWithANote)
{
    const auto note_of = [](const std::vector<float>& times, const std::vector<float>& values, const std::string& path,
                            const std::string& interpolation, int node) {
        GltfBuilder gltf = a_tree();
        const int input = gltf.add_floats(times, 1), output = gltf.add_floats(values, 3);
        gltf.root["animations"] = {
            {{"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}}};
        const Scene scene = gltf.load();
        EXPECT_EQ(scene_fault(scene), "");
        EXPECT_EQ(scene.animations.empty(), has_warning(scene, "animations[0] is left out"));
        for (const std::string& line : scene.warnings) {
            if (line.find("left out") != std::string::npos) return line;
        }
        return std::string();
    };
    const auto says = [](const std::string& note, const char* part) { return note.find(part) != std::string::npos; };
    const std::vector<float> moves{1, 2, 3, 4, 5, 6};
    EXPECT_EQ(note_of({0, 1}, moves, "scale", "LINEAR", 1), "");
    EXPECT_TRUE(says(note_of({1, 0}, moves, "scale", "LINEAR", 1), "do not ascend"));
    EXPECT_TRUE(says(note_of({0, std::nanf("")}, moves, "scale", "LINEAR", 1), "not finite"));
    EXPECT_TRUE(says(note_of({0, 1}, moves, "rotation", "LINEAR", 1), "3 floats a key for the rotation of nodes[1]"));
    EXPECT_TRUE(says(note_of({0, 1}, moves, "scale", "CUBICSPLINE", 1), "1 floats a key"));
    EXPECT_TRUE(says(note_of({0, 1, 2, 3}, moves, "scale", "LINEAR", 1), "6 values for 4 keys"));
    EXPECT_TRUE(says(note_of({0, 1}, moves, "scale", "SMOOTH", 1), "unknown interpolation 'SMOOTH'"));
    EXPECT_TRUE(says(note_of({0, 1}, moves, "colour", "LINEAR", 1), "moves 'colour'"));
    EXPECT_TRUE(says(note_of({0, 1}, moves, "scale", "LINEAR", 2), "nodes[2], which has a matrix"));
}

TEST(GltfMotion, SkinsAreKeptAndUnsoundOnesLeftOutWithANote)
{
    GltfBuilder gltf = a_tree();
    primitive(gltf)["attributes"]["JOINTS_0"] =
        gltf.add_accessor<std::uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, u8, "VEC4");
    primitive(gltf)["attributes"]["WEIGHTS_0"] = gltf.add_floats({2, 2, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}, 4);
    std::vector<float> matrices;
    for (int i = 0; i < 32; ++i) matrices.push_back(float(i));
    const int binding = gltf.add_accessor(matrices, f32, "MAT4");
    gltf.root["skins"] = {{{"name", "bones"}, {"joints", {0, 2}}, {"inverseBindMatrices", binding}, {"skeleton", 1}},
                          {{"joints", {3}}},
                          {{"joints", {5}}}};
    gltf.root["nodes"][0]["skin"] = 0;
    gltf.root["nodes"][1]["skin"] = 2;
    const Scene scene = gltf.load();
    EXPECT_EQ(scene_fault(scene), "");
    ASSERT_EQ(scene.skins.size(), 2u);
    const Skin& bones = scene.skins[0];
    EXPECT_EQ(bones.name, "bones");
    EXPECT_EQ(bones.joints, (std::vector<int>{2, 1}));
    EXPECT_EQ(bones.skeleton, 0);
    EXPECT_EQ(bones.inverse_bind[1][0], glm::vec4(16, 17, 18, 19));
    EXPECT_EQ(bones.inverse_bind[1][3], glm::vec4(28, 29, 30, 31));
    EXPECT_EQ(scene.skins[1].inverse_bind[0], glm::mat4(1.0f));
    EXPECT_EQ(node_named(scene, "hand").skin, 0);
    EXPECT_EQ(node_named(scene, "root").skin, -1);
    EXPECT_TRUE(has_warning(scene, "skins[2] is left out: its joint nodes[5] is not in the scene"));
    ASSERT_EQ(scene.modelled.size(), 3u);  // of hand alone
    const Node& hand = node_named(scene, "hand");
    EXPECT_EQ(hand.modelled.count, 3u);
    EXPECT_EQ(scene.modelled[0].joints, glm::uvec4(0, 1, 0, 0));
    EXPECT_EQ(scene.modelled[0].weights, glm::vec4(0.5f, 0.5f, 0, 0));
    EXPECT_EQ(scene.modelled[1].joints, glm::uvec4(1, 0, 0, 0));
    EXPECT_EQ(scene.modelled[2].weights, glm::vec4(1, 0, 0, 0));
    EXPECT_TRUE(has_warning(scene, "vertices without weights of joints; they follow the first joint"));

    primitive(gltf)["attributes"].erase("JOINTS_0");
    const Scene without = gltf.load();
    EXPECT_EQ(node_named(without, "hand").skin, -1);
    EXPECT_TRUE(has_warning(without, "nodes[0] 'hand' has a skin without a mesh of vertices that name its joints"));
}

TEST(GltfMotion, MorphTargetsAreAppliedByTheirWeights)
{
    for (const bool on_node : {false, true}) {
        GltfBuilder gltf = one_triangle();
        primitive(gltf)["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};  // each doubles the triangle
        EXPECT_EQ(gltf.load().nodes[0].weights, (std::vector{0.0, 0.0}));
        gltf.root["meshes"][0]["weights"] = {0, on_node ? 0 : 0.5};
        if (on_node) gltf.root["nodes"][0]["weights"] = {0.25, 0};
        const Scene scene = gltf.load();
        EXPECT_EQ(scene.nodes[0].weights, on_node ? (std::vector{0.25, 0.0}) : (std::vector{0.0, 0.5}));
        EXPECT_NEAR(corner_ws(scene, 1).x, on_node ? 1.25 : 1.5, 1e-6);
        EXPECT_EQ(scene.deltas.size(), 6u);
        gltf.root["nodes"][0]["weights"] = {1, 2, 3};
        EXPECT_NE(refusal(gltf).find("nodes[0] has 3 weights for 2 morph targets"), std::string::npos);
    }
}

TEST(GltfMotion, WhatMayMoveIsDynamic)
{
    const auto dynamic_nodes = [](const std::function<void(GltfBuilder&)>& change) {
        GltfBuilder gltf = a_tree();
        change(gltf);
        std::string names;
        for (const Node& node : gltf.load().nodes) names += node.dynamic ? node.name + " " : "";
        return names;
    };
    EXPECT_EQ(dynamic_nodes([](GltfBuilder&) {}), "");
    EXPECT_EQ(dynamic_nodes([](GltfBuilder& gltf) { gltf.root["nodes"][2]["extras"] = {{"dynamic", true}}; }), "arm hand ");
    EXPECT_EQ(dynamic_nodes([](GltfBuilder& gltf) { gltf.root["nodes"][2]["extras"] = {{"dynamic", false}}; }), "");
    EXPECT_EQ(dynamic_nodes([](GltfBuilder& gltf) {
                  const int times = gltf.add_floats({0, 1}, 1), moves = gltf.add_floats({1, 2, 3, 4, 5, 6}, 3);
                  gltf.root["animations"] = {
                      {{"samplers", {{{"input", times}, {"output", moves}}}},
                       {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
              }),
              "hand ");
}

}  // namespace
}  // namespace conebook::test
