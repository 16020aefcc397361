// Real glTF files: a collection of valid, odd and broken ones, each with what a loader must do, and large scenes.
#include <cmath>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "robustness/gltf_builder.hpp"

namespace conebook::test {
namespace {

std::filesystem::path shared_folder()
{
    const char* folder = std::getenv("CONEBOOK_SHARED");
    return folder ? folder : "";
}

json read_gltf_json(const std::filesystem::path& file)
{
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    if (!bytes.starts_with("glTF")) return json::parse(bytes);
    std::uint32_t size = 0;
    std::memcpy(&size, &bytes[12], 4);
    return json::parse(bytes.substr(20, size));
}

// Whether the file holds any triangle at all. Some files of the collection that are valid glTF hold none: an empty
// scene, points, lights only. load_scene must refuse these, since there is nothing to light.
bool has_triangle_primitive(const json& gltf)
{
    for (const json& node : gltf.value("nodes", json::array())) {
        if (!node.contains("mesh")) continue;
        for (const json& primitive : gltf.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives")) {
            if (primitive.value("mode", 4) >= 4) return true;
        }
    }
    return false;
}

void expect_one_clear_line(const std::string& error, const std::filesystem::path& file)
{
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_TRUE(error.starts_with(file.string() + ": ")) << error;
    EXPECT_GT(error.size(), file.string().size() + 10) << error;
}

TEST(GltfFiles, EveryFileOfTheCollectionIsLoadedOrRefusedAsExpected)
{
    const std::filesystem::path folder = shared_folder() / "gltf";
    std::ifstream stream(folder / "manifest.json");
    if (!stream) GTEST_SKIP() << "no collection of glTF files in $CONEBOOK_SHARED/gltf";
    const std::set<std::string> supported = {"KHR_lights_punctual", "KHR_materials_emissive_strength",
                                             "KHR_materials_specular", "KHR_materials_unlit", "KHR_texture_transform"};
    int loaded = 0, refused = 0;
    for (const json& entry : json::parse(stream)) {
        const std::filesystem::path file = folder / entry.at("file").get<std::string>();
        SCOPED_TRACE(file.string() + " (" + entry.at("what").get<std::string>() + ")");
        const std::string expect = entry.at("expect");
        std::string unsupported;
        for (const json& extension : entry.at("extensionsRequired")) {
            if (!supported.contains(extension)) unsupported = extension;
        }
        std::string error, fault;
        bool has_warnings = false;
        try {
            const Scene scene = load_scene(file);
            fault = scene_fault(scene);
            has_warnings = !scene.warnings.empty();
            ++loaded;
        } catch (const std::runtime_error& e) {
            error = e.what();
            expect_one_clear_line(error, file);
            ++refused;
        }
        EXPECT_EQ(fault, "");
        if (!unsupported.empty()) {
            EXPECT_NE(error.find(unsupported), std::string::npos) << "must name " << unsupported << ": " << error;
        } else if (expect == "refuse") {
            EXPECT_NE(error, "") << "was loaded";
        } else if (expect == "warn") {
            EXPECT_TRUE(has_warnings || !error.empty()) << "was loaded without a warning";
        } else if (!has_triangle_primitive(read_gltf_json(file))) {
            EXPECT_NE(error.find("no triangles"), std::string::npos) << error;
        } else {
            EXPECT_EQ(error, "");
        }
    }
    EXPECT_GT(loaded, 70);
    EXPECT_GT(refused, 30);
}

TEST(GltfFiles, TheScenesOfTheBookLoad)
{
    const std::filesystem::path folder = shared_folder() / "scenes";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no scenes in $CONEBOOK_SHARED/scenes";
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".glb") continue;
        SCOPED_TRACE(entry.path().string());
        const Scene scene = load_scene(entry.path());
        EXPECT_EQ(scene_fault(scene), "");
        // Oracle: the triangles that the file's accessors count, each mesh placed once per node.
        const json gltf = read_gltf_json(entry.path());
        std::size_t triangles = 0;
        for (const json& node : gltf.at("nodes")) {
            if (!node.contains("mesh")) continue;
            for (const json& p : gltf.at("meshes").at(node.at("mesh").get<std::size_t>()).at("primitives")) {
                triangles +=
                    gltf.at("accessors").at(p.at("indices").get<std::size_t>()).at("count").get<std::size_t>() / 3;
            }
        }
        EXPECT_EQ(scene.triangle_count(), triangles);
        EXPECT_FALSE(scene.has_default_light);
        EXPECT_EQ(scene.cameras.size(), 1u);
    }
}

// Blender wrote these files' tangents with MikkTSpace. Ours, made without them, must point the same way.
TEST(GltfFiles, GeneratedTangentsAgreeWithThoseOfTheExporter)
{
    for (const std::string name : {"05_metallic_sphere_light", "02_node_hierarchy", "02_shared_mesh"}) {
        SCOPED_TRACE(name);
        const std::filesystem::path source = shared_folder() / "gltf/load" / name;
        if (!std::filesystem::exists(source)) GTEST_SKIP() << "no " << name << " in $CONEBOOK_SHARED/gltf";
        const TemporaryFolder folder;
        std::filesystem::copy(source / (name + ".bin"), folder.path());
        write_file(folder.path() / "flat.png", GltfBuilder::png({128, 128, 255, 255}, 1, 1));
        json gltf = read_gltf_json(source / (name + ".gltf"));
        // A normal map is what makes the loader compute tangents.
        gltf["images"] = {{{"uri", "flat.png"}}};
        gltf["textures"] = {{{"source", 0}}};
        gltf["materials"] = {{{"normalTexture", {{"index", 0}}}}};
        for (json& mesh : gltf["meshes"]) {
            for (json& primitive : mesh["primitives"]) primitive["material"] = 0;
        }
        const Scene given = load_scene(write_file(folder.path() / "given.gltf", gltf.dump()));
        for (json& mesh : gltf["meshes"]) {
            for (json& primitive : mesh["primitives"]) ASSERT_EQ(primitive["attributes"].erase("TANGENT"), 1u);
        }
        const Scene generated = load_scene(write_file(folder.path() / "generated.gltf", gltf.dump()));
        ASSERT_EQ(given.indices.size(), generated.indices.size());
        std::size_t same_side = 0;
        double cosine_sum = 0.0;
        for (std::size_t i = 0; i < given.indices.size(); ++i) {
            const glm::vec4 a = given.vertices[given.indices[i]].tangent;
            const glm::vec4 b = generated.vertices[generated.indices[i]].tangent;
            same_side += a.w == b.w;
            cosine_sum += glm::dot(glm::vec3(a), glm::vec3(b));
        }
        const auto corners = static_cast<double>(given.indices.size());
        EXPECT_GT(static_cast<double>(same_side) / corners, 0.995);
        EXPECT_GT(cosine_sum / corners, 0.98);
    }
}

}  // namespace
}  // namespace conebook::test
