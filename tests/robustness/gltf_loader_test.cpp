// Geometry of the loader against exact answers: vertices, winding, normals, tangents, precision.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "robustness/gltf_builder.hpp"

namespace conebook::test {
namespace {

#define EXPECT_VEC_NEAR(actual, expected, tolerance)                             \
    EXPECT_LT(glm::length(glm::dvec3(actual) - glm::dvec3(expected)), tolerance) \
        << glm::dvec3(actual).x << " " << glm::dvec3(actual).y << " " << glm::dvec3(actual).z

TEST(GltfLoader, OneTriangle)
{
    const Scene scene = one_triangle().load();
    EXPECT_EQ(scene_fault(scene), "");
    ASSERT_EQ(scene.indices.size(), 3u);
    EXPECT_EQ(scene.origin_ws, glm::dvec3(0.5, 0.5, 0.0));
    EXPECT_EQ(scene.bounds.min, glm::vec3(-0.5f, -0.5f, 0.0f));
    EXPECT_EQ(scene.bounds.max, glm::vec3(0.5f, 0.5f, 0.0f));
    EXPECT_EQ(corner_ws(scene, 0), glm::dvec3(0, 0, 0));
    EXPECT_EQ(corner_ws(scene, 1), glm::dvec3(1, 0, 0));
    EXPECT_EQ(corner_ws(scene, 2), glm::dvec3(0, 1, 0));
    for (const Vertex& vertex : scene.vertices) {
        EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
        EXPECT_EQ(vertex.color, glm::vec4(1));
    }
}

template <class T>
GltfBuilder square_with_indices(Component component)
{
    GltfBuilder gltf;
    const int position = gltf.add_floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 9, 9, 9}, 3);  // the last is not used
    const int indices = gltf.add_accessor<T>({0, 1, 2, 0, 2, 3}, component, "SCALAR");
    gltf.add_mesh({{"attributes", {{"POSITION", position}}}, {"indices", indices}});
    gltf.add_node({{"mesh", 0}});
    return gltf;
}

TEST(GltfLoader, IndicesOfEveryTypeGiveTheSameSquare)
{
    for (const GltfBuilder& gltf : {square_with_indices<std::uint8_t>(u8), square_with_indices<std::uint16_t>(u16),
                                    square_with_indices<std::uint32_t>(u32)}) {
        const Scene scene = gltf.load();
        ASSERT_EQ(scene.triangle_count(), 2u);
        const glm::dvec3 expected[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(corner_ws(scene, i), expected[i]);
        EXPECT_EQ(scene.bounds.max, glm::vec3(0.5f, 0.5f, 0.0f)) << "an unused vertex must not widen the bounds";
    }
}

TEST(GltfLoader, StripTurnsEverySecondTriangleAndDropsJoints)
{
    GltfBuilder gltf = one_triangle();
    const int position = gltf.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0}, 3);
    primitive(gltf) = {{"attributes", {{"POSITION", position}}}, {"mode", 5}};
    Scene scene = gltf.load();
    ASSERT_EQ(scene.triangle_count(), 3u);
    // glTF 2.0, 3.7.2.1: p_i = {v_i, v_i+(1+i%2), v_i+(2-i%2)}
    const glm::dvec3 v[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
    const int expected[] = {0, 1, 2, 1, 3, 2, 2, 3, 4};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(corner_ws(scene, i), v[expected[i]]) << i;
    for (std::size_t t = 0; t < 3; ++t) EXPECT_EQ(face_normal(scene, t), glm::vec3(0, 0, 1)) << t;

    // Repeated corners join two strips: 0 1 2 2 1 1 3 2... leaves only proper triangles.
    primitive(gltf)["indices"] = gltf.add_accessor<std::uint16_t>({0, 1, 2, 2, 2, 1, 3}, u16, "SCALAR");
    scene = gltf.load();
    ASSERT_EQ(scene.triangle_count(), 2u);
    EXPECT_EQ(face_normal(scene, 0), glm::vec3(0, 0, 1));
    EXPECT_EQ(face_normal(scene, 1), glm::vec3(0, 0, 1));
}

TEST(GltfLoader, FanSharesItsFirstVertex)
{
    GltfBuilder gltf = one_triangle();
    const int position = gltf.add_floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 3);
    primitive(gltf) = {{"attributes", {{"POSITION", position}}}, {"mode", 6}};
    const Scene scene = gltf.load();
    const glm::dvec3 v[] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    const int expected[] = {1, 2, 0, 2, 3, 0};
    ASSERT_EQ(scene.indices.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(corner_ws(scene, i), v[expected[i]]) << i;
}

TEST(GltfLoader, PointsAndLinesAreLeftOutWithAWarning)
{
    GltfBuilder gltf = one_triangle();
    nlohmann::json lines = primitive(gltf);
    lines["mode"] = 1;
    gltf.root["meshes"][0]["primitives"].push_back(lines);
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.triangle_count(), 1u);
    EXPECT_TRUE(has_warning(scene, "points or lines"));
}

TEST(GltfLoader, InterleavedAccessors)
{
    GltfBuilder gltf = one_triangle();
    // position, normal, and four bytes that belong to nobody: stride 28
    const std::vector<float> data = {0, 0, 0, 0, 0, 1, -7, 2, 0, 0, 0, 0, 1, -7, 0, 3, 0, 0, 0, 1, -7};
    const int view = gltf.add_view(GltfBuilder::bytes_of(data), 28);
    const auto accessor = [&](int offset) {
        return gltf.append(
            "accessors",
            {{"bufferView", view}, {"byteOffset", offset}, {"componentType", f32}, {"count", 3}, {"type", "VEC3"}});
    };
    const int position = accessor(0), normal = accessor(12);
    primitive(gltf)["attributes"] = {{"POSITION", position}, {"NORMAL", normal}};
    const Scene scene = gltf.load();
    EXPECT_EQ(corner_ws(scene, 1), glm::dvec3(2, 0, 0));
    EXPECT_EQ(corner_ws(scene, 2), glm::dvec3(0, 3, 0));
    EXPECT_EQ(scene.vertices[2].normal, glm::vec3(0, 0, 1));
}

TEST(GltfLoader, SparseAccessorsWithAndWithoutABase)
{
    GltfBuilder gltf = one_triangle();
    const int indices = gltf.add_view(GltfBuilder::bytes_of(std::vector<std::uint16_t>{1, 2}));
    const int values = gltf.add_view(GltfBuilder::bytes_of(std::vector<float>{5, 0, 0, 0, 7, 0}));
    const json sparse = {{"count", 2},
                         {"indices", {{"bufferView", indices}, {"componentType", u16}}},
                         {"values", {{"bufferView", values}}}};
    gltf.root["accessors"][0]["sparse"] = sparse;
    const Scene with_base = gltf.load();
    gltf.root["accessors"][0].erase("bufferView");
    const Scene without_base = gltf.load();
    for (const Scene* scene : {&with_base, &without_base}) {
        EXPECT_EQ(corner_ws(*scene, 0), glm::dvec3(0, 0, 0));
        EXPECT_EQ(corner_ws(*scene, 1), glm::dvec3(5, 0, 0));
        EXPECT_EQ(corner_ws(*scene, 2), glm::dvec3(0, 7, 0));
    }
}

TEST(GltfLoader, HierarchyComposesTranslationRotationScale)
{
    GltfBuilder gltf = one_triangle();
    const double h = std::sqrt(0.5);  // 90 degrees about z: (x, y) -> (-y, x)
    gltf.root["nodes"] = {
        {{"children", {1}}, {"translation", {10, 20, 30}}, {"rotation", {0, 0, h, h}}, {"scale", {2, 3, 4}}},
        {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 1, 1, 1}}}};
    const Scene scene = gltf.load();
    // (x+1, y+1, z+1) -> scale -> rotate -> translate
    const glm::dvec3 local[] = {{1, 1, 1}, {2, 1, 1}, {1, 2, 1}};
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 expected(10 - 3 * local[i].y, 20 + 2 * local[i].x, 30 + 4 * local[i].z);
        EXPECT_VEC_NEAR(corner_ws(scene, i), expected, 1e-5);
    }
    EXPECT_VEC_NEAR(scene.vertices[0].normal, glm::vec3(0, 0, 1), 1e-6);
}

// A closed box with normals and tangents, so that "outside" is known.
GltfBuilder box()
{
    GltfBuilder gltf;
    std::vector<float> positions, normals, tangents;
    for (int axis = 0; axis < 3; ++axis) {
        for (const float side : {-1.0f, 1.0f}) {
            glm::vec3 n(0), u(0), v(0);
            n[axis] = side;
            u[(axis + 1) % 3] = side;  // u x v = n on either side
            v[(axis + 2) % 3] = 1.0f;
            for (const glm::vec2 at : {glm::vec2(-1, -1), {1, -1}, {1, 1}, {-1, -1}, {1, 1}, {-1, 1}}) {
                const glm::vec3 p = n + at.x * u + at.y * v;
                positions.insert(positions.end(), {p.x, p.y, p.z});
                normals.insert(normals.end(), {n.x, n.y, n.z});
                tangents.insert(tangents.end(), {u.x, u.y, u.z, 1.0f});
            }
        }
    }
    const int position = gltf.add_floats(positions, 3), normal = gltf.add_floats(normals, 3);
    const int tangent = gltf.add_floats(tangents, 4);
    gltf.add_mesh({{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TANGENT", tangent}}}});
    gltf.add_node({{"mesh", 0}});
    return gltf;
}

TEST(GltfLoader, MirroredBoxesStillFaceOutside)
{
    for (const glm::vec3 scale : {glm::vec3(1, 1, 1), {-1, 1, 1}, {1, -2, 1}, {-1, -1, 3}, {-0.5, -1, -1}}) {
        GltfBuilder gltf = box();
        gltf.root["nodes"][0]["scale"] = {scale.x, scale.y, scale.z};
        const Scene scene = gltf.load();
        EXPECT_EQ(scene_fault(scene), "");
        const float mirror = scale.x * scale.y * scale.z < 0.0f ? -1.0f : 1.0f;
        for (std::size_t t = 0; t < 12; ++t) {
            const glm::dvec3 centre =
                (corner_ws(scene, 3 * t) + corner_ws(scene, 3 * t + 1) + corner_ws(scene, 3 * t + 2)) / 3.0;
            const Vertex& vertex = scene.vertices[scene.indices[3 * t]];
            EXPECT_GT(glm::dot(glm::dvec3(face_normal(scene, t)), centre), 0.0) << "wound inside out";
            EXPECT_GT(glm::dot(face_normal(scene, t), vertex.normal), 0.999f);
            // The bitangent of the file is v = n x u; in the scene it must be the matrix times that.
            const glm::vec3 n =
                vertex.normal / scale;  // back to the mesh: the inverse of the inverse transpose, a diagonal
            const glm::vec3 u = glm::vec3(vertex.tangent) / scale;
            const glm::vec3 v = glm::cross(glm::normalize(n * scale * scale), glm::normalize(u)) * scale;
            const glm::vec3 bitangent = vertex.tangent.w * glm::cross(vertex.normal, glm::vec3(vertex.tangent));
            EXPECT_GT(glm::dot(glm::normalize(v), bitangent), 0.999f);
            EXPECT_EQ(vertex.tangent.w, mirror);
        }
    }
}

TEST(GltfLoader, NormalsTransformByTheInverseTranspose)
{
    GltfBuilder gltf = one_triangle();
    const float h = std::sqrt(0.5f);
    const int position = gltf.add_floats({0, 1, 0, 0, 1, 1, 1, 0, 0}, 3);  // in the plane x + y = 1
    primitive(gltf)["attributes"] = {{"POSITION", position},
                                     {"NORMAL", gltf.add_floats({h, h, 0, h, h, 0, h, h, 0}, 3)}};
    gltf.root["nodes"][0]["scale"] = {2, 1, 1};  // now x/2 + y = 1
    const Scene scene = gltf.load();
    for (const Vertex& vertex : scene.vertices) {
        EXPECT_VEC_NEAR(vertex.normal, glm::normalize(glm::dvec3(0.5, 1.0, 0.0)), 1e-6);
    }
    EXPECT_VEC_NEAR(face_normal(scene, 0), glm::normalize(glm::dvec3(0.5, 1.0, 0.0)), 1e-6);
}

TEST(GltfLoader, AFlattenedNodeKeepsUnitNormals)
{
    GltfBuilder gltf = box();
    gltf.root["nodes"][0]["scale"] = {1, 0, 1};
    EXPECT_EQ(scene_fault(gltf.load()), "");
    gltf.root["nodes"][0]["scale"] = {0, 0, 0};
    EXPECT_EQ(scene_fault(gltf.load()), "");
}

// 10 km from the origin a float has steps of 1 mm; the scene must keep what the nodes' doubles say.
TEST(GltfLoader, PrecisionFarFromTheOrigin)
{
    GltfBuilder gltf;
    const int position = gltf.add_floats({0, 0, 0, 1e-3f, 0, 0, 0, 1e-3f, 0}, 3);
    gltf.add_mesh({{"attributes", {{"POSITION", position}}}});
    gltf.root["nodes"] = {{{"children", {1, 2}}, {"translation", {12345.6789, -9876.54321, 10000.0001}}},
                          {{"mesh", 0}},
                          {{"mesh", 0}, {"translation", {1e-3, 0, 0}}}};
    const Scene scene = gltf.load();
    const glm::dvec3 offset(12345.6789, -9876.54321, 10000.0001);
    const double step = static_cast<double>(1e-3f);
    const glm::dvec3 expected[] = {{0, 0, 0},    {step, 0, 0},        {0, step, 0},
                                   {1e-3, 0, 0}, {1e-3 + step, 0, 0}, {1e-3, step, 0}};
    for (std::size_t i = 0; i < 6; ++i) {
        // 1e-10 m: float steps at 1e-3 m; doubles at 1e4 m have steps of 2e-12 m.
        EXPECT_VEC_NEAR(corner_ws(scene, i) - offset, expected[i], 1e-10) << i;
    }
    EXPECT_NEAR(scene.bounds.extent().x, 2e-3, 1e-9);
}

TEST(GltfLoader, MissingNormalsAreFlat)
{
    GltfBuilder gltf = one_triangle();
    const int position = gltf.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, 3);  // two faces around one edge
    primitive(gltf) = {{"attributes", {{"POSITION", position}}},
                       {"indices", gltf.add_accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, u16, "SCALAR")}};
    const Scene scene = gltf.load();
    for (std::size_t i = 0; i < 6; ++i) {
        const glm::vec3 expected = i < 3 ? glm::vec3(0, 0, 1) : glm::vec3(1, 0, 0);
        EXPECT_EQ(scene.vertices[scene.indices[i]].normal, expected) << i;
    }
}

TEST(GltfLoader, BadNormalsAreComputedWithAWarning)
{
    GltfBuilder gltf = one_triangle();
    const float nan = std::nanf("");
    primitive(gltf)["attributes"]["NORMAL"] = gltf.add_floats({nan, 0, 1, 0, 0, 0, 0, 0, 4}, 3);
    const Scene scene = gltf.load();
    for (const Vertex& vertex : scene.vertices) EXPECT_EQ(vertex.normal, glm::vec3(0, 0, 1));
    EXPECT_TRUE(has_warning(scene, "2 normals are zero or not finite"));
    EXPECT_TRUE(has_warning(scene, "not of unit length"));
}

TEST(GltfLoader, TangentsFollowTheUvAndItsTransform)
{
    GltfBuilder gltf = one_triangle();
    const int position = gltf.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    const int texture = gltf.add_texture({128, 128, 255, 255}, 1, 1);
    gltf.append("materials", {{"normalTexture", {{"index", texture}}}});
    const auto tangent = [&](const std::vector<float>& uv) {
        primitive(gltf) = {{"attributes", {{"POSITION", position}, {"TEXCOORD_0", gltf.add_floats(uv, 2)}}},
                           {"material", 0}};
        return gltf.load().vertices.at(0).tangent;
    };
    // glTF: v points down the image, the bitangent up.
    EXPECT_EQ(tangent({0, 1, 1, 1, 0, 0}), glm::vec4(1, 0, 0, 1));    // u along x, upright
    EXPECT_EQ(tangent({0, 0, 1, 0, 0, 1}), glm::vec4(1, 0, 0, -1));   // u along x, upside down: mirrored
    EXPECT_EQ(tangent({1, 1, 0, 1, 1, 0}), glm::vec4(-1, 0, 0, -1));  // u along -x: mirrored
    EXPECT_EQ(tangent({0, 0, 0, 0, 0, 0}).w, 1.0f);                   // no direction at all: still a frame
    // Rotating the UV by 90 degrees (counter-clockwise, v down: u' = v, v' = -u) turns the tangent to where v grows.
    gltf.root["materials"][0]["normalTexture"]["extensions"]["KHR_texture_transform"]["rotation"] =
        std::numbers::pi / 2;
    const glm::vec4 turned = tangent({0, 1, 1, 1, 0, 0});
    EXPECT_VEC_NEAR(glm::vec3(turned), glm::vec3(0, -1, 0), 1e-6);
    EXPECT_EQ(turned.w, 1.0f);
}

TEST(GltfLoader, AVertexAtAMirroredSeamIsDoubled)
{
    GltfBuilder gltf = one_triangle();
    // Two triangles that share the edge x = 0, where u turns back: the left half mirrors the right.
    const int position = gltf.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0}, 3);
    const int normal = gltf.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    const int uv = gltf.add_floats({0, 1, 1, 1, 0, 0, 1, 1}, 2);
    gltf.append("materials", {{"normalTexture", {{"index", gltf.add_texture({128, 128, 255, 255}, 1, 1)}}}});
    primitive(gltf) = {{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
                       {"indices", gltf.add_accessor<std::uint16_t>({0, 1, 2, 0, 2, 3}, u16, "SCALAR")},
                       {"material", 0}};
    const Scene scene = gltf.load();
    EXPECT_EQ(scene.vertices.size(), 6u);
    for (std::size_t i = 0; i < 6; ++i) {
        const glm::vec4 expected = i < 3 ? glm::vec4(1, 0, 0, 1) : glm::vec4(-1, 0, 0, -1);
        EXPECT_EQ(scene.vertices[scene.indices[i]].tangent, expected) << i;
    }
}

TEST(GltfLoader, TheFirstSceneIsTakenWhenNoneIsNamedAndAllRootsWhenThereIsNone)
{
    GltfBuilder gltf = one_triangle();
    gltf.add_node({{"mesh", 0}, {"translation", {5, 0, 0}}});
    gltf.root["scenes"].push_back({{"nodes", {1}}});
    gltf.root["scene"] = 1;
    EXPECT_EQ(corner_ws(gltf.load(), 0).x, 5.0);
    gltf.root.erase("scene");
    EXPECT_EQ(corner_ws(gltf.load(), 0).x, 0.0);
    gltf.root.erase("scenes");
    EXPECT_EQ(gltf.load().triangle_count(), 2u);
}

TEST(GltfLoader, AChainOfAHundredThousandNodes)
{
    GltfBuilder gltf = one_triangle();
    constexpr int depth = 100'000;
    gltf.root["nodes"] = json::array();
    for (int i = 0; i < depth; ++i) gltf.root["nodes"].push_back({{"children", {i + 1}}, {"translation", {0.5, 0, 0}}});
    gltf.root["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(corner_ws(gltf.load(), 0).x, 0.5 * depth);
}

}  // namespace
}  // namespace conebook::test
