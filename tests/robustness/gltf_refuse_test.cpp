// Files that are wrong in one known way: each is refused with one line that names the file and this fault.
#include <sys/stat.h>

#include <chrono>
#include <functional>
#include <tuple>

#include <gtest/gtest.h>

#include "png_builder.hpp"
#include "robustness/gltf_builder.hpp"

namespace conebook::test {
namespace {

struct Fault {
    std::string name;
    std::function<void(GltfBuilder&)> damage;  // of one_triangle()
    std::string says;
};

void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

json texture_of(GltfBuilder& gltf, const json& image)
{
    gltf.root["images"] = {image};
    gltf.root["textures"] = {{{"source", 0}}};
    gltf.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
    return image;
}

std::string png_header(std::uint32_t width, std::uint32_t height)
{
    PngBuilder png;
    png.width = width;
    png.height = height;
    return png.header() + std::string("\0\0\0\0IDAT", 8);
}

void compress_by_draco(GltfBuilder& gltf)
{
    gltf.root["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    primitive(gltf)["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                                   {"attributes", {{"POSITION", 0}}}};
}

// bufferViews[0] is compressed; the buffer that it stands for has no bytes.
void compress_by_meshopt(GltfBuilder& gltf, const std::string& extension)
{
    gltf.root["extensionsUsed"] = {extension};
    gltf.other_buffers.push_back({{"byteLength", 36}, {"extensions", {{extension, {{"fallback", true}}}}}});
    json& view = gltf.root["bufferViews"][0];
    view["extensions"][extension] = {{"buffer", 0},      {"byteOffset", 0},      {"byteLength", 36},
                                     {"byteStride", 12}, {"mode", "ATTRIBUTES"}, {"count", 3}};
    view["buffer"] = 1;
}

const std::vector<Fault> faults = {
    {"index_out_of_range",
     [](GltfBuilder& g) {
         primitive(g)["indices"] = g.add_accessor<std::uint16_t>({0, 1, 3}, u16, "SCALAR");
     },
     "index 3 of 3 vertices"},
    {"primitive_restart",
     [](GltfBuilder& g) {
         primitive(g)["indices"] = g.add_accessor<std::uint8_t>({0, 1, 255}, u8, "SCALAR");
     },
     "primitive restart"},
    {"signed_indices",
     [](GltfBuilder& g) {
         primitive(g)["indices"] = g.add_accessor<std::int16_t>({0, 1, 2}, s16, "SCALAR");
     },
     "not unsigned integer"},
    {"four_corners",
     [](GltfBuilder& g) {
         primitive(g)["indices"] = g.add_accessor<std::uint16_t>({0, 1, 2, 0}, u16, "SCALAR");
     },
     "not a multiple of 3"},
    {"nan_position",
     [](GltfBuilder& g) {
         primitive(g)["attributes"]["POSITION"] = g.add_floats({0, 0, 0, std::nanf(""), 0, 0, 0, 1, 0}, 3);
     },
     "vertex 1 is not finite"},
    {"infinite_position",
     [](GltfBuilder& g) {
         primitive(g)["attributes"]["POSITION"] = g.add_floats({0, 0, 0, HUGE_VALF, 0, 0, 0, 1, 0}, 3);
     },
     "vertex 1 is not finite"},
    {"moved_to_infinity",
     [](GltfBuilder& g) {
         g.root["nodes"] = {{{"scale", {1e200, 1, 1}}, {"children", {1}}}, {{"scale", {1e200, 1, 1}}, {"mesh", 0}}};
     },
     "to infinity"},
    {"too_large",
     [](GltfBuilder& g) {
         g.root["nodes"][0]["scale"] = {1e20, 1, 1};
     },
     "larger than 1e9 m"},
    {"too_small",
     [](GltfBuilder& g) {
         g.root["nodes"][0]["scale"] = {9e-7, 9e-7, 9e-7};
     },
     "smaller than 1e-6 m"},
    {"no_position", [](GltfBuilder& g) { primitive(g)["attributes"] = json::object(); }, "has no POSITION"},
    {"position_of_two",
     [](GltfBuilder& g) {
         primitive(g)["attributes"]["POSITION"] = g.add_floats({0, 0, 1, 0, 0, 1}, 2);
     },
     "2 components"},
    {"counts_differ",
     [](GltfBuilder& g) {
         primitive(g)["attributes"]["NORMAL"] = g.add_floats({0, 0, 1}, 3);
     },
     "1 elements for 3 vertices"},
    {"ten_million_triangles", [](GltfBuilder& g) { g.root["accessors"][0]["count"] = 30'000'000; },
     "claims 30000000 elements"},
    {"ten_million_triangles_sparse",
     [](GltfBuilder& g) {
         g.root["accessors"][0]["count"] = 30'000'000;
         g.root["accessors"][0].erase("bufferView");
         g.root["accessors"][0]["sparse"] = {
             {"count", 1}, {"indices", {{"bufferView", 0}, {"componentType", u8}}}, {"values", {{"bufferView", 0}}}};
     },
     "claims 30000000 elements"},
    {"sparse_count",
     [](GltfBuilder& g) {
         g.root["accessors"][0]["sparse"] = {
             {"count", 4}, {"indices", {{"bufferView", 0}, {"componentType", u8}}}, {"values", {{"bufferView", 0}}}};
     },
     "more sparse elements"},
    {"sparse_index",
     [](GltfBuilder& g) {
         const int indices = g.add_view(std::string("\x07\0\0\0", 4));
         g.root["accessors"][0]["sparse"] = {{"count", 1},
                                             {"indices", {{"bufferView", indices}, {"componentType", u8}}},
                                             {"values", {{"bufferView", 0}}}};
     },
     "sparse index out of range"},
    {"no_data", [](GltfBuilder& g) { g.root["accessors"][0].erase("bufferView"); }, "has no data"},
    {"accessor_offset", [](GltfBuilder& g) { g.root["accessors"][0]["byteOffset"] = 4; }, "up to byte 40"},
    {"largest_offset", [](GltfBuilder& g) { g.root["accessors"][0]["byteOffset"] = 2147483647; },
     "up to byte 2147483683"},
    {"negative_offset", [](GltfBuilder& g) { g.root["accessors"][0]["byteOffset"] = -4; },
     "accessors[0].byteOffset is -4"},
    {"huge_offset", [](GltfBuilder& g) { g.root["accessors"][0]["byteOffset"] = 18446744073709551615u; },
     "accessors[0].byteOffset"},
    {"view_past_buffer", [](GltfBuilder& g) { g.root["bufferViews"][0]["byteLength"] = 40; },
     "bufferViews[0] ends at byte 40"},
    {"narrow_stride", [](GltfBuilder& g) { g.root["bufferViews"][0]["byteStride"] = 8; }, "byteStride below"},
    {"component_type", [](GltfBuilder& g) { g.root["accessors"][0]["componentType"] = 5124; }, "component type 5124"},
    {"matrix_positions", [](GltfBuilder& g) { g.root["accessors"][0]["type"] = "MAT2"; }, "is a matrix"},
    {"cycle",
     [](GltfBuilder& g) {
         g.root["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
     },
     "cycle"},
    {"own_child", [](GltfBuilder& g) { g.root["nodes"][0]["children"] = {0}; }, "cycle"},
    {"two_parents",
     [](GltfBuilder& g) {
         g.root["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, {{"mesh", 0}}};
     },
     "more than one parent"},
    {"node_twice",
     [](GltfBuilder& g) {
         g.root["scenes"][0]["nodes"] = {0, 0};
     },
     "in the scene twice"},
    {"projective_matrix",
     [](GltfBuilder& g) { g.root["nodes"][0]["matrix"] = {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; },
     "last row"},
    {"zero_quaternion",
     [](GltfBuilder& g) {
         g.root["nodes"][0]["rotation"] = {0, 0, 0, 0};
     },
     "not a rotation"},
    {"no_triangles", [](GltfBuilder& g) { g.root["nodes"] = {json::object()}; }, "has no triangles"},
    {"no_scene_such", [](GltfBuilder& g) { g.root["scene"] = 1; }, "scene is 1"},
    {"texture_reference",
     [](GltfBuilder& g) {
         g.root["materials"] = {{{"emissiveTexture", {{"index", 0}}}}};
     },
     "materials[0].emissiveTexture.index is 0, but the file has 0 textures"},
    {"missing_image",
     [](GltfBuilder& g) {
         texture_of(g, {{"uri", "nowhere.png"}});
     },
     "cannot read 'nowhere.png': no such file"},
    {"absolute_uri",
     [](GltfBuilder& g) {
         texture_of(g, {{"uri", "/etc/hostname"}});
     },
     "not a relative path"},
    {"web_uri",
     [](GltfBuilder& g) {
         texture_of(g, {{"uri", "http://example.com/a.png"}});
     },
     "not a relative path"},
    {"folder_uri",
     [](GltfBuilder& g) {
         texture_of(g, {{"uri", "."}});
     },
     "not a regular file"},
    {"bad_base64",
     [](GltfBuilder& g) {
         texture_of(g, {{"uri", "data:image/png;base64,####"}});
     },
     "not valid base64"},
    {"ktx",
     [](GltfBuilder& g) {
         texture_of(g, {{"bufferView", g.add_view("\xabKTX 20\xbb")}});
     },
     "KTX"},
    {"no_image_format",
     [](GltfBuilder& g) {
         texture_of(g, {{"bufferView", 0}});
     },
     "neither PNG nor JPEG"},
    {"implausible_image",
     [](GltfBuilder& g) {
         texture_of(g, {{"bufferView", g.add_view(png_header(8000, 8000))}});
     },
     "8000x8000"},
    {"absurd_image",
     [](GltfBuilder& g) {
         // Padded until the pixels alone are the fault, not their number per byte.
         texture_of(g, {{"bufferView", g.add_view(png_header(12000, 12000) + std::string(600'000, '\0'))}});
     },
     "12000x12000"},
    {"cut_image",
     [](GltfBuilder& g) {
         std::string png = GltfBuilder::png(std::vector<std::uint8_t>(64 * 64 * 4, 7), 64, 64);
         texture_of(g, {{"bufferView", g.add_view(png.substr(0, png.size() / 2))}});
     },
     "images[0] is damaged"},
    {"alpha_mode",
     [](GltfBuilder& g) {
         g.root["materials"] = {{{"alphaMode", "GLASS"}}};
     },
     "unknown alphaMode 'GLASS'"},
    {"required_draco", [](GltfBuilder& g) { g.root["extensionsRequired"] = {"KHR_draco_mesh_compression"}; },
     "KHR_draco_mesh_compression"},
    {"required_two",
     [](GltfBuilder& g) {
         g.root["extensionsRequired"] = {"KHR_texture_basisu", "KHR_texture_transform", "EXT_meshopt_compression"};
     },
     "KHR_texture_basisu, EXT_meshopt_compression"},
    {"draco_without_fallback",
     [](GltfBuilder& g) {
         g.root["accessors"][0].erase("bufferView");
         compress_by_draco(g);
     },
     "POSITION is compressed by KHR_draco_mesh_compression"},
    {"draco_below_sparse_values",
     [](GltfBuilder& g) {
         g.root["accessors"][0].erase("bufferView");
         g.root["accessors"][0]["sparse"] = {
             {"count", 1}, {"indices", {{"bufferView", 0}, {"componentType", u8}}}, {"values", {{"bufferView", 0}}}};
         compress_by_draco(g);
     },
     "POSITION is compressed by KHR_draco_mesh_compression"},
    {"draco_indices",
     [](GltfBuilder& g) {
         primitive(g)["indices"] = g.add_accessor<std::uint16_t>({0, 1, 2}, u16, "SCALAR");
         g.root["accessors"][1].erase("bufferView");
         compress_by_draco(g);
     },
     "indices is compressed by KHR_draco_mesh_compression"},
    {"meshopt_without_fallback", [](GltfBuilder& g) { compress_by_meshopt(g, "EXT_meshopt_compression"); },
     "POSITION is compressed by EXT_meshopt_compression"},
    {"meshopt_of_khronos", [](GltfBuilder& g) { compress_by_meshopt(g, "KHR_meshopt_compression"); },
     "POSITION is compressed by KHR_meshopt_compression"},
    {"meshopt_sparse_values",
     [](GltfBuilder& g) {
         const int view = g.add_view(std::string(12, '\0'));
         compress_by_meshopt(g, "EXT_meshopt_compression");
         // Of the accessor, only the sparse values are compressed.
         g.root["accessors"][0]["bufferView"] = view;
         g.root["accessors"][0]["sparse"] = {
             {"count", 1}, {"indices", {{"bufferView", view}, {"componentType", u8}}}, {"values", {{"bufferView", 0}}}};
     },
     "POSITION is compressed by EXT_meshopt_compression"},
    {"version_3", [](GltfBuilder& g) { g.root["asset"]["version"] = "3.0"; }, "version '3.0'"},
    {"no_asset", [](GltfBuilder& g) { g.root.erase("asset"); }, "asset is missing"},
    {"number_too_large_for_float",
     [](GltfBuilder& g) {
         g.root["materials"] = {{{"emissiveFactor", {1e300, 0, 0}}}};
     },
     "too large a number"},
    {"camera_fov",
     [](GltfBuilder& g) {
         g.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 4}, {"znear", 1}}}}};
         g.root["nodes"][0]["camera"] = 0;
     },
     "yfov is outside"},
    {"no_such_light", [](GltfBuilder& g) { g.root["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 0; },
     "0 lights"},
};

class GltfRefuse : public testing::TestWithParam<Fault> {};

TEST_P(GltfRefuse, OneLineNamesFileAndFault)
{
    GltfBuilder gltf = one_triangle();
    GetParam().damage(gltf);
    const std::string error = refusal(gltf);
    EXPECT_NE(error.find("test.glb: "), std::string::npos) << error;
    EXPECT_NE(error.find(GetParam().says), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
}

INSTANTIATE_TEST_SUITE_P(Faults, GltfRefuse, testing::ValuesIn(faults),
                         [](const auto& info) { return info.param.name; });

TEST(GltfRefuseFile, WhatIsNoFileAtAll)
{
    const TemporaryFolder folder;
    EXPECT_NE(refusal(folder.path() / "none.glb").find("none.glb: no such file"), std::string::npos);
    EXPECT_NE(refusal(folder.path()).find("not a regular file"), std::string::npos);
    EXPECT_NE(refusal(write_file(folder.path() / "empty.gltf", "")).find("empty"), std::string::npos);
    EXPECT_NE(refusal(write_file(folder.path() / "text.gltf", "hello\n\x01 world")).find("not valid JSON"),
              std::string::npos);
    EXPECT_NE(refusal(write_file(folder.path() / "list.gltf", "[1, 2]")).find("not a glTF file"), std::string::npos);
    const std::string deep = R"({"asset":{"version":"2.0"},"extras":)" + std::string(1'000'000, '[');
    EXPECT_NE(refusal(write_file(folder.path() / "deep.gltf", deep)).find("levels deep"), std::string::npos);
    // Reading a pipe that nobody writes to would hang.
    ASSERT_EQ(mkfifo((folder.path() / "pipe.bin").c_str(), 0600), 0);
    const std::string gltf = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":"pipe.bin"}]})";
    EXPECT_NE(refusal(write_file(folder.path() / "pipe.gltf", gltf)).find("not a regular file"), std::string::npos);
}

// Compression is no fault where the file has the data without it too.
TEST(GltfRefuseFile, CompressionWithAFallbackIsIgnored)
{
    GltfBuilder draco = one_triangle();
    compress_by_draco(draco);
    EXPECT_EQ(scene_fault(draco.load()), "");
    EXPECT_TRUE(has_warning(draco.load(), "KHR_draco_mesh_compression is ignored"));

    // Zeros that no stream fills: the extension lists POSITION alone.
    GltfBuilder zeros = one_triangle();
    compress_by_draco(zeros);
    const int color = zeros.add_accessor<std::uint8_t>(std::vector<std::uint8_t>(16, 0), u8, "VEC4", true);
    zeros.root["accessors"][color].erase("bufferView");
    zeros.root["accessors"][color]["count"] = 3;
    zeros.root["accessors"][color]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", color}, {"componentType", u8}}}, {"values", {{"bufferView", color}}}};
    primitive(zeros)["attributes"]["COLOR_0"] = color;
    EXPECT_EQ(scene_fault(zeros.load()), "");

    GltfBuilder meshopt = one_triangle();
    compress_by_meshopt(meshopt, "EXT_meshopt_compression");
    const GltfBuilder plain = one_triangle();
    const std::string positions =
        "data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";  // one_triangle's positions
    meshopt.other_buffers[0]["uri"] = positions;
    EXPECT_EQ(meshopt.load().vertices.at(1).position, plain.load().vertices.at(1).position);

    // What nothing uses may lie in a buffer without bytes.
    GltfBuilder unused = one_triangle();
    compress_by_meshopt(unused, "EXT_meshopt_compression");
    primitive(unused)["attributes"]["POSITION"] = unused.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, 3);
    EXPECT_EQ(scene_fault(unused.load()), "");
}

// Every way in which an image may be in a file; what damage is found is tests/codecs_test.cpp's.
TEST(GltfRefuseFile, ADamagedImageIsNamed)
{
    const TemporaryFolder folder;
    std::string png = GltfBuilder::png(std::vector<std::uint8_t>(16 * 16 * 4, 7), 16, 16);
    png[png.size() - 20] = static_cast<char>(png[png.size() - 20] ^ 1);
    write_file(folder / "wood.png", png);
    for (const auto& [name, uri, expected] : {std::tuple("", "wood.png", "images[0] 'wood.png' is damaged: "),
                                              {"bark", "wood.png", "images[0] 'bark' is damaged: "},
                                              {"bark", "", "images[0] 'bark' is damaged: "}}) {
        GltfBuilder gltf = one_triangle();
        json image = json::object();
        if (*name) image["name"] = name;
        if (*uri) {
            image["uri"] = uri;
        } else {
            image["bufferView"] = gltf.add_view(png);
        }
        texture_of(gltf, image);
        const std::string error = refusal(write_file(folder / "test.glb", gltf.glb()));
        EXPECT_NE(error.find(std::string("test.glb: ") + expected), std::string::npos) << error;
    }
}

TEST(GltfRefuseFile, InstancingIsBounded)
{
    // 300 nodes of a mesh with 400,000 triangles: 1.2 MB that stand for 120 million triangles.
    GltfBuilder gltf = one_triangle();
    primitive(gltf)["attributes"]["NORMAL"] = gltf.add_floats({0, 0, 1, 0, 0, 1, 0, 0, 1}, 3);
    primitive(gltf)["indices"] = gltf.add_accessor(std::vector<std::uint8_t>(1'200'000, 0), u8, "SCALAR");
    gltf.root["nodes"] = json::array();
    gltf.root["scenes"][0]["nodes"] = json::array();
    for (int i = 0; i < 300; ++i) {
        gltf.root["nodes"].push_back({{"mesh", 0}});
        gltf.root["scenes"][0]["nodes"].push_back(i);
    }
    const auto start = std::chrono::steady_clock::now();
    const std::string error = refusal(gltf);
    EXPECT_NE(error.find("100 million triangles"), std::string::npos) << error;
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

}  // namespace
}  // namespace conebook::test
