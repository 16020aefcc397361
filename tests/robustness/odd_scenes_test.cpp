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
    const std::string mode = program == "reference" ? "--spp 16 --bounces 2" : "--headless";
    const ProgramRun done = run_program(program, mode + " --size 32x32 --scene '" + scene.string() + "'" + coarse_settings(program) +
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

// Six pyramids of 400 voxels beside each other are wider than the 3D textures of some drivers.
TEST(OddScenes, GridsBeyondTheDriverAreRefusedByName)
{
    const TemporaryFolder folder;
    const std::filesystem::path scene = write_file(folder / "odd.glb", one_triangle().glb());
    const std::filesystem::path picture = folder / "x.exr";
    for (const std::string program : {"07_anisotropic_mips", "12_second_bounce", "14_speed_against_error"}) {
        const ProgramRun done = run_program(program, "--headless --size 32x32 --set voxels=400 --scene '" +
                                                         scene.string() + "' --output '" + picture.string() + "'");
        EXPECT_EQ(std::filesystem::exists(picture), done.code == 0) << program << ": " << done.output;
        std::filesystem::remove(picture);
        if (done.code == 0) continue;
        EXPECT_EQ(std::count(done.output.begin(), done.output.end(), '\n'), 1) << program << ": " << done.output;
        EXPECT_EQ(done.output.find("voxels=400: "), 0u) << program << ": " << done.output;
        EXPECT_NE(done.output.find("GL_MAX_3D_TEXTURE_SIZE"), std::string::npos) << program << ": " << done.output;
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

// A room of half side 1 with a screen and a point light, the same at every scale: lengths by s, intensities by s^2.
GltfBuilder room(double s)
{
    GltfBuilder gltf;
    const std::vector<float> quads = {-1,   -1, 1,  1,    -1, 1,  1,    -1,   -1, -1,   -1,   -1,  // floor
                                      -1,   1,  -1, 1,    1,  -1, 1,    1,    1,  -1,   1,    1,   // ceiling
                                      -1,   -1, -1, 1,    -1, -1, 1,    1,    -1, -1,   1,    -1,  // back
                                      -1,   -1, 1,  -1,   -1, -1, -1,   1,    -1, -1,   1,    1,   // left
                                      1,    -1, -1, 1,    -1, 1,  1,    1,    1,  1,    1,    -1,  // right
                                      0.1f, -1, 0,  0.7f, -1, 0,  0.7f, 0.2f, 0,  0.1f, 0.2f, 0};  // the screen
    std::vector<std::uint16_t> indices;
    for (const int quad : {0, 4, 8, 12, 16, 20})
        for (const int corner : {0, 1, 2, 0, 2, 3}) indices.push_back(std::uint16_t(quad + corner));
    gltf.root["materials"] = {
        {{"doubleSided", true},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0.7, 0.7, 0.7, 1}}, {"metallicFactor", 0}}},
         {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}}};
    gltf.add_mesh({{"attributes", {{"POSITION", gltf.add_floats(quads, 3)}}},
                   {"indices", gltf.add_accessor(indices, u16, "SCALAR")},
                   {"material", 0}});
    gltf.root["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 5.0 * s * s}}};
    gltf.root["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1.2}, {"znear", 0.01 * s}}}}};
    gltf.add_node({{"children", {1, 2, 3}}, {"scale", {s, s, s}}});
    gltf.add_node({{"mesh", 0}});
    gltf.add_node({{"translation", {-0.2, 0.7, 0.2}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    gltf.add_node({{"translation", {0, 0, 2.2}}, {"camera", 0}});
    return gltf;
}

// Radiance has no length in it. The path tracer takes the same paths, the chapters the same cones: what differs is the
// rounding of floats, 2e-4 at most as measured.
TEST(OddScenes, RadianceDoesNotDependOnTheScale)
{
    for (const std::string program : {"reference", "01_first_light", "03_shadow_map", "12_second_bounce"}) {
        const auto mean = [&](double scale) {
            const Rendering done = render(program, room(scale));
            EXPECT_EQ(done.code, 0) << done.output;
            double sum = 0.0;
            for (const glm::vec4& pixel : done.picture.pixels) sum += pixel.r;
            return sum / (32.0 * 32.0);
        };
        const double right = mean(1.0);
        EXPECT_GT(right, 0.05) << program;
        for (const double scale : {5e-7, 1e-4, 1e-2, 1e3, 4.9e8})
            EXPECT_NEAR(mean(scale) / right, 1.0, 1e-3) << program << " at " << scale << " m";
    }
}

}  // namespace
}  // namespace conebook::test
