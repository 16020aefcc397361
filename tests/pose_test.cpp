// Poses: curves against closed forms, moved nodes against files in which they stand there, skins against matrices by hand,
// and the pass on the GPU against its twin on the CPU.
#include "gl/pose_pass.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "robustness/gltf_builder.hpp"
#include "scene/pose.hpp"
#include "test_gl.hpp"

namespace conebook::test {
namespace {

constexpr double kPiD = 3.14159265358979323846;

// `values` as a curve of node 0's `path` with keys at these times.
void animate(GltfBuilder& gltf, const std::string& path, const std::vector<float>& times,
             const std::vector<float>& values, int components, const std::string& interpolation = "LINEAR",
             int node = 0)
{
    const int input = gltf.add_floats(times, 1), output = gltf.add_floats(values, components);
    if (!gltf.root.contains("animations"))
        gltf.root["animations"] = {{{"samplers", json::array()}, {"channels", json::array()}}};
    json& animation = gltf.root["animations"][0];
    const std::size_t sampler = animation["samplers"].size();
    animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
}

glm::dvec3 origin_of_node(const Scene& scene, double time_s)
{
    return glm::dvec3(pose_nodes(scene, time_s)[0].world_from_node[3]);
}

TEST(Pose, CurvesAreThoseOfTheirInterpolation)
{
    const std::vector<float> times{1, 2, 4};
    GltfBuilder step = one_triangle(), linear = one_triangle(), spline = one_triangle();
    animate(step, "translation", times, {0, 0, 0, 1, 2, 3, 5, 6, 7}, 3, "STEP");
    animate(linear, "translation", times, {0, 0, 0, 1, 2, 3, 5, 6, 7}, 3);
    // x(t) = t^3, y(t) = 2 - t, z(t) = t^2: a cubic with its own derivatives as tangents is met everywhere.
    std::vector<float> keys;
    for (const float t : times) {
        const std::vector<float> slope{3 * t * t, -1, 2 * t}, value{t * t * t, 2 - t, t * t};
        for (const auto* part : {&slope, &value, &slope}) keys.insert(keys.end(), part->begin(), part->end());
    }
    animate(spline, "translation", times, keys, 3, "CUBICSPLINE");
    const Scene stepping = step.load(), going = linear.load(), curved = spline.load();
    EXPECT_EQ(origin_of_node(stepping, 0.0), glm::dvec3(0, 0, 0));
    EXPECT_EQ(origin_of_node(stepping, 1.99), glm::dvec3(0, 0, 0));
    EXPECT_EQ(origin_of_node(stepping, 2.0), glm::dvec3(1, 2, 3));
    EXPECT_EQ(origin_of_node(stepping, 3.9), glm::dvec3(1, 2, 3));
    EXPECT_EQ(origin_of_node(stepping, 4.0), glm::dvec3(5, 6, 7)) << "the last key is reached";
    EXPECT_EQ(origin_of_node(going, 0.5), glm::dvec3(0, 0, 0));
    EXPECT_EQ(origin_of_node(going, 1.25), glm::dvec3(0.25, 0.5, 0.75));
    EXPECT_EQ(origin_of_node(going, 3.0), glm::dvec3(3, 4, 5));
    EXPECT_EQ(origin_of_node(going, 4.0 + 3.0), glm::dvec3(3, 4, 5)) << "over and over again";
    for (const double t : {1.0, 1.1, 1.9, 2.5, 3.9, 4.0}) {
        EXPECT_LT(glm::distance(origin_of_node(curved, t), glm::dvec3(t * t * t, 2 - t, t * t)), 1e-10) << t;
    }
    EXPECT_EQ(duration(curved), 4.0);
}

TEST(Pose, RotationsTurnEvenlyAndTheShortWay)
{
    GltfBuilder gltf = one_triangle();
    const float half = float(std::sqrt(0.5));
    // To 90 degrees about z; the second key has the other sign, which is the same rotation.
    animate(gltf, "rotation", {0, 3}, {0, 0, 0, 1, 0, 0, -half, -half}, 4);
    const Scene scene = gltf.load();
    for (const double t : {0.0, 1.0, 2.0, 3.0}) {
        const glm::dvec3 x(pose_nodes(scene, t)[0].world_from_node[0]);
        EXPECT_LT(glm::distance(x, glm::dvec3(std::cos(t * kPiD / 6), std::sin(t * kPiD / 6), 0)), 1e-7) << t;
    }
}

TEST(Pose, ANodeThatMovedIsAsInAFileInWhichItStandsThere)
{
    GltfBuilder gltf = one_triangle();
    gltf.root["nodes"] = {{{"name", "arm"}, {"scale", {-2, 1, 1}}, {"children", {1}}},
                          {{"name", "hand"}, {"mesh", 0}, {"translation", {1, 0, 0}}},
                          {{"name", "floor"}, {"mesh", 0}, {"scale", {9, 9, 9}}}};
    gltf.root["scenes"] = {{{"nodes", {0, 2}}}};
    GltfBuilder moving = gltf;
    const double half = std::sqrt(0.5);
    animate(moving, "rotation", {0, 1}, {0, 0, 0, 1, float(half), 0, 0, float(half)}, 4, "LINEAR", 0);
    animate(moving, "translation", {0, 1}, {1, 0, 0, 1, 2, 3}, 3, "LINEAR", 1);
    gltf.root["nodes"][0]["rotation"] = {half, 0, 0, half};
    gltf.root["nodes"][1]["translation"] = {1, 2, 3};
    const Scene expected = gltf.load(), scene = moving.load();
    EXPECT_EQ(scene_fault(scene), "");
    const Pose now = pose(scene, 1.0);
    ASSERT_EQ(now.vertices.size(), expected.vertices.size());
    for (std::size_t v = 0; v < now.vertices.size(); ++v) {
        const Vertex &a = now.vertices[v], &b = expected.vertices[v];
        const glm::dvec3 a_ws = glm::dvec3(a.position) + scene.origin_ws,
                         b_ws = glm::dvec3(b.position) + expected.origin_ws;
        EXPECT_LT(glm::distance(a_ws, b_ws), 2e-6) << v;
        EXPECT_LT(glm::distance(a.normal, b.normal), 1e-6f) << v;
        EXPECT_LT(glm::distance(a.tangent, b.tangent), 1e-6f) << v;
    }
    EXPECT_EQ(scene.indices, expected.indices);
    // And the rest pose is what the scene holds.
    for (std::size_t node = 0; node < scene.nodes.size(); ++node) {
        const std::vector<Vertex> rest = posed_vertices(scene, rest_pose(scene), node);
        for (std::size_t v = 0; v < rest.size(); ++v) {
            const Vertex& kept = scene.vertices[scene.nodes[node].vertices.first + v];
            EXPECT_LT(glm::distance(rest[v].position, kept.position), 1e-6f);
            EXPECT_LT(glm::distance(rest[v].normal, kept.normal), 1e-6f);
            EXPECT_LT(glm::distance(rest[v].tangent, kept.tangent), 1e-6f);
        }
    }
}

TEST(Pose, LightsAndCamerasGoWithTheirNodes)
{
    GltfBuilder gltf = one_triangle();
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"spot", json::object()}}};
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    gltf.root["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.root["scenes"] = {{{"nodes", {0, 1}}}};
    const float half = float(std::sqrt(0.5));
    animate(gltf, "translation", {0, 2}, {0, 0, 0, 2, 4, 6}, 3, "LINEAR", 1);
    animate(gltf, "rotation", {0, 1}, {0, 0, 0, 1, 0, half, 0, half}, 4, "LINEAR", 1);
    const Scene scene = gltf.load();
    const Pose now = pose(scene, 1.0);
    EXPECT_LT(glm::distance(glm::dvec3(now.lights[0].position) + scene.origin_ws, glm::dvec3(1, 2, 3)), 1e-6);
    EXPECT_LT(glm::distance(now.lights[0].direction, glm::vec3(-1, 0, 0)), 1e-6f) << "-z turned by 90 degrees about y";
    EXPECT_LT(glm::distance(glm::dvec3(now.cameras[0].world_from_camera[3]) + scene.origin_ws, glm::dvec3(1, 2, 3)),
              1e-6);
    EXPECT_LT(glm::distance(glm::vec3(now.cameras[0].world_from_camera[2]), glm::vec3(1, 0, 0)), 1e-6f);
}

// Node 0: a strip along x of 8 quads, with normals and tangents, in a skin of two joints (1, 2) at x = 0 and 1, far from the
// world's origin. Node 3, mirrored: a flat triangle with two morph targets. Both move.
GltfBuilder a_crowd()
{
    GltfBuilder gltf;
    std::vector<float> positions, normals, tangents, weights;
    std::vector<std::uint8_t> joints;
    std::vector<std::uint16_t> indices;
    for (int i = 0; i <= 8; ++i) {
        for (int k = 0; k < 2; ++k) {
            const float x = 0.25f * float(i);
            positions.insert(positions.end(), {x, 0.0f, float(k)});
            normals.insert(normals.end(), {0, 1, 0});
            tangents.insert(tangents.end(), {1, 0, 0, -1});
            joints.insert(joints.end(), {0, 1, 0, 0});
            const float second = std::min(std::max(x - 0.5f, 0.0f), 1.0f);
            weights.insert(weights.end(), {1 - second, second, 0, 0});
        }
        if (i == 8) break;
        for (const int corner : {0, 1, 3, 0, 3, 2}) indices.push_back(std::uint16_t(2 * i + corner));
    }
    gltf.add_mesh({{"attributes",
                    {{"POSITION", gltf.add_floats(positions, 3)},
                     {"NORMAL", gltf.add_floats(normals, 3)},
                     {"TANGENT", gltf.add_floats(tangents, 4)},
                     {"JOINTS_0", gltf.add_accessor(joints, u8, "VEC4")},
                     {"WEIGHTS_0", gltf.add_floats(weights, 4)}}},
                   {"indices", gltf.add_accessor(indices, u16, "SCALAR")}});
    const int triangle = gltf.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    const int up = gltf.add_floats({0, 0, 1, 0, 0, 0, 0, 0, 0}, 3),
              wide = gltf.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    gltf.add_mesh({{"attributes", {{"POSITION", triangle}}}, {"targets", {{{"POSITION", up}}, {{"POSITION", wide}}}}});
    gltf.root["meshes"][1]["weights"] = {0.5, 0};
    gltf.add_node({{"mesh", 0}, {"skin", 0}, {"translation", {7, 7, 7}}});  // has no part in it
    gltf.add_node({{"children", {2}}, {"translation", {1000, 0, 0}}});
    gltf.add_node({{"translation", {1, 0, 0}}});
    gltf.add_node({{"mesh", 1}, {"translation", {1000, 1, 0}}, {"scale", {-1, 1, 2}}});
    gltf.root["scenes"] = {{{"nodes", {0, 1, 3}}}};
    const int binding = gltf.add_accessor<float>(
        {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1}, f32, "MAT4");
    gltf.root["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", binding}}};
    const float half = float(std::sqrt(0.5));
    animate(gltf, "rotation", {0, 2}, {0, 0, 0, 1, 0, 0, half, half}, 4, "LINEAR", 2);  // the second joint, about z
    animate(gltf, "weights", {0, 2}, {0, 0, 1, 2}, 1, "LINEAR", 3);
    animate(gltf, "rotation", {0, 2}, {0, 0, 0, 1, 0, half, 0, half}, 4, "LINEAR", 3);
    return gltf;
}

TEST(Pose, SkinsBlendTheMatricesOfTheirJoints)
{
    const Scene scene = a_crowd().load();
    EXPECT_EQ(scene_fault(scene), "");
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    for (const double t : {0.0, 0.7, 2.0}) {
        const Pose now = pose(scene, t);
        const double angle = t / 2 * kPiD / 2;
        for (std::uint32_t v = 0; v < 18; ++v) {
            const double x = 0.25 * (v / 2), z = v % 2, second = std::clamp(x - 0.5, 0.0, 1.0);
            const glm::dvec3 still(1000 + x, 0, z);
            const glm::dvec3 turned(1001 + (x - 1) * std::cos(angle), (x - 1) * std::sin(angle), z);
            const glm::dvec3 position = glm::dvec3(now.vertices[v].position) + scene.origin_ws;
            EXPECT_LT(glm::distance(position, glm::mix(still, turned, second)), 1e-6) << t << " " << v;
            const double blended = second == 1.0 ? angle : 0.0;
            if (second == 0.0 || second == 1.0) {
                EXPECT_LT(glm::distance(glm::dvec3(now.vertices[v].normal),
                                        glm::dvec3(-std::sin(blended), std::cos(blended), 0)),
                          1e-6);
                EXPECT_LT(glm::distance(glm::dvec4(now.vertices[v].tangent),
                                        glm::dvec4(std::cos(blended), std::sin(blended), 0, -1)),
                          1e-6);
            }
        }
    }
}

TEST(Pose, MorphTargetsMoveFlatNormalsToo)
{
    const Scene scene = a_crowd().load();
    const Node& node = scene.nodes[3];
    ASSERT_EQ(node.vertices.count, 3u);
    ASSERT_TRUE(node.mirrored);
    for (const double t : {0.0, 1.3, 2.0}) {
        const Pose now = pose(scene, t);
        const std::uint32_t* corner = &scene.indices[node.indices.first];
        glm::dvec3 p[3];
        for (int i = 0; i < 3; ++i) p[i] = now.vertices[corner[i]].position;
        const glm::dvec3 face = glm::normalize(glm::cross(p[1] - p[0], p[2] - p[0]));
        for (int i = 0; i < 3; ++i)
            EXPECT_LT(glm::distance(glm::dvec3(now.vertices[corner[i]].normal), face), 1e-5) << t;
        // As modelled (0, 0, w0), (1 + w1, 0, 0), (0, 1 + w1, 0) with w0 = t / 2, w1 = t; then scaled, turned about y, moved.
        const double angle = t / 2 * kPiD / 2;
        const glm::dvec3 first(1000 + 2 * t / 2 * std::sin(angle), 1, 2 * t / 2 * std::cos(angle));
        EXPECT_LT(glm::distance(glm::dvec3(now.vertices[node.vertices.first].position) + scene.origin_ws, first), 1e-6)
            << t;
    }
}

TEST(Pose, SweptBoundsHoldAllOfThem)
{
    const Scene scene = a_crowd().load();
    const Bounds all = swept_bounds(scene);
    EXPECT_GT(all.max.y, scene.bounds.max.y + 0.5f);
    for (const double t : {0.0, 0.3, 1.1, 1.7}) {
        const Bounds now = pose(scene, t).bounds;
        const glm::vec3 step(0.1f);  // 64 samples of 2 s; nothing moves by more than 3 m/s
        EXPECT_TRUE(glm::all(glm::lessThanEqual(all.min - step, now.min)));
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(all.max + step, now.max)));
    }
}

TEST(PosePass, IsItsTwin)
{
    TestGl& gl = test_gl();  // the context comes first
    const Scene scene = a_crowd().load();
    GpuScene gpu_scene(scene);
    PosePass pass(gl.shaders, scene);
    EXPECT_TRUE(pass.run(gpu_scene, rest_pose(scene))) << "the loader's vertices are rounded otherwise";
    EXPECT_FALSE(pass.run(gpu_scene, rest_pose(scene))) << "nothing has moved";
    EXPECT_EQ(gpu_scene.geometry_revision(), 2u);
    for (const double t : {0.0, 0.4, 1.0, 1.9}) {
        const Pose now = pose(scene, t);
        EXPECT_TRUE(pass.run(gpu_scene, now.nodes));
        const Revision revision = gpu_scene.geometry_revision();
        EXPECT_FALSE(pass.run(gpu_scene, now.nodes));
        EXPECT_EQ(gpu_scene.geometry_revision(), revision);
        const auto vertices = gpu_scene.vertices().read<Vertex>();
        ASSERT_EQ(vertices.size(), now.vertices.size());
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            // Floats of 3 m, a few operations each.
            EXPECT_LT(glm::distance(vertices[v].position, now.vertices[v].position), 3e-6f) << t << " " << v;
            EXPECT_LT(glm::distance(vertices[v].normal, now.vertices[v].normal), 1e-5f) << t << " " << v;
            EXPECT_LT(glm::distance(vertices[v].tangent, now.vertices[v].tangent), 1e-5f) << t << " " << v;
            EXPECT_EQ(vertices[v].uv0, now.vertices[v].uv0);
            EXPECT_EQ(vertices[v].color, now.vertices[v].color);
        }
    }
    EXPECT_EQ(gl.log.faults(), std::vector<std::string>{});
}

TEST(PosePass, DoesNothingWithoutAnythingDynamic)
{
    TestGl& gl = test_gl();
    const Scene scene = one_triangle().load();
    GpuScene gpu_scene(scene);
    PosePass pass(gl.shaders, scene);
    EXPECT_FALSE(pass.run(gpu_scene, pose_nodes(scene, 1.0)));
    EXPECT_TRUE(pass.resources().empty());
}

}  // namespace
}  // namespace conebook::test
