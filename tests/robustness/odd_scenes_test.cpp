// Scenes that are sound and strange, through the programs: the right picture, or one line that names the file.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "image/image.hpp"
#include "program.hpp"
#include "robustness/gltf_builder.hpp"

namespace conebook::test {
namespace {

// A run of a chapter on a scene: its output, and its picture when it ended well.
struct Rendering {
    int code = -1;
    std::string output;
    ImageF picture;
};

Rendering render(const std::string& program, const GltfBuilder& gltf)
{
    const TemporaryFolder folder;
    const std::filesystem::path scene = write_file(folder / "odd.glb", gltf.glb()), picture = folder / "x.exr";
    const std::string grid =
        program.size() > 3 && std::isdigit(program[0]) && program >= "04" ? " --set voxels=16" : "";
    const ProgramRun done = run_program(program, "--headless --size 32x32 --scene '" + scene.string() + "'" + grid +
                                                     " --output '" + picture.string() + "'");
    return {done.code, done.output, done.code == 0 ? read_exr(picture) : ImageF{}};
}

bool is_black(const ImageF& picture)
{
    return std::all_of(picture.pixels.begin(), picture.pixels.end(),
                       [](const glm::vec4& pixel) { return glm::vec3(pixel) == glm::vec3(0.0f); });
}

// Three ways in which no triangle has an area, so that no voxel is occupied.
TEST(OddScenes, NothingToSeeIsABlackPictureInEveryChapter)
{
    const auto expect_black = [](const GltfBuilder& gltf, const std::string& program, const std::string& what) {
        const Rendering done = render(program, gltf);
        EXPECT_EQ(done.code, 0) << program << ", " << what << ": " << done.output;
        EXPECT_EQ(done.picture.pixels.size(), 32u * 32u);
        EXPECT_TRUE(is_black(done.picture)) << program << ", " << what;
    };
    GltfBuilder line = one_triangle();
    primitive(line)["attributes"]["POSITION"] = line.add_floats({0, 0, 0, 1, 0, 0, 2, 0, 0}, 3);
    for (const std::string& program : chapters()) expect_black(line, program, "a line");
    GltfBuilder point = one_triangle(), flattened = one_triangle();
    primitive(point)["attributes"]["POSITION"] = point.add_floats({1, 2, 3, 1, 2, 3, 1, 2, 3}, 3);
    flattened.root["nodes"][0]["scale"] = {0, 0, 0};
    for (const std::string program :
         {"08_diffuse_cones", "12_second_bounce", "13_ground_truth", "14_speed_against_error"}) {
        expect_black(point, program, "a point");
        expect_black(flattened, program, "a node of scale 0");
    }
}

// OpenGL takes labels of 256 bytes at least, and no longer ones than it says.
TEST(OddScenes, NamesMayBeLong)
{
    for (const std::string& piece : {std::string("n"), std::string("\xc3\xa9"), std::string("\xe2\x82\xac")}) {
        std::string name;
        while (name.size() < 900) name += piece;
        GltfBuilder gltf = one_triangle();
        gltf.add_texture({255, 255, 255, 255}, 1, 1);
        gltf.root["images"][0]["name"] = name;
        gltf.root["materials"] = {
            {{"name", name}, {"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        primitive(gltf)["material"] = 0;
        primitive(gltf)["attributes"]["TEXCOORD_0"] = gltf.add_floats({0, 0, 1, 0, 0, 1}, 2);
        gltf.root["nodes"][0]["name"] = gltf.root["meshes"][0]["name"] = name;
        const Rendering done = render("12_second_bounce", gltf);
        EXPECT_EQ(done.code, 0) << done.output;
        EXPECT_FALSE(is_black(done.picture));
    }
}

}  // namespace
}  // namespace conebook::test
