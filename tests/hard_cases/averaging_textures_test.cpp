// Textures and alpha masks in voxels, against what their texels say.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "soup_pipeline.hpp"

namespace conebook {
namespace {

// `every` 2: a and b in turn; 4: one texel of four is a.
std::vector<std::uint8_t> checkerboard(int side, glm::u8vec4 a, glm::u8vec4 b, int every)
{
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const glm::u8vec4 c = every == 2 ? ((x + y) % 2 ? b : a) : (x % 2 || y % 2 ? b : a);
            rgba.insert(rgba.end(), {c.r, c.g, c.b, c.a});
        }
    return rgba;
}

TEST(Averaging, TexturesAreAveragedInLinearLight)
{
    SceneBuilder builder;
    Material m = lambert(1.0f);
    m.base_color_texture.image = builder.image(256, 256, checkerboard(256, {255, 255, 255, 255}, {0, 0, 0, 255}, 2));
    builder.quad({4.2f, 4.2f, 8.5f}, {8, 0, 0}, {0, 8, 0}, builder.material(m));
    SoupPipeline pipeline(builder.build(), unit_bounds(32), 32);
    pipeline.average();
    for (const auto& face : pipeline.faces()) {
        if (face.albedo_area.a < 0.2f) continue;
        EXPECT_NEAR(face.albedo_area.r, 0.5f, 2.0f / 255.0f);  // 0.21 when sRGB values are averaged
    }
}

TEST(Averaging, TextureKeepsItsPlace)
{
    // A gradient from black to white across eight voxels, by way of UV: the mean of a voxel is the value in its middle.
    SceneBuilder builder;
    Material m = lambert(1.0f);
    std::vector<std::uint8_t> rgba;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
            const double linear = (x + 0.5) / 64.0;
            const double srgb = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
            const auto byte = std::uint8_t(std::lround(255.0 * srgb));
            rgba.insert(rgba.end(), {byte, byte, byte, 255});
        }
    m.base_color_texture.image = builder.image(64, 64, rgba);
    m.base_color_texture.wrap_s = m.base_color_texture.wrap_t = Wrap::clamp_to_edge;
    builder.quad({4, 4, 8.5f}, {8, 0, 0}, {0, 8, 0}, builder.material(m));
    SoupPipeline pipeline(builder.build(), unit_bounds(32), 32);
    pipeline.average();
    int compared = 0;
    for (const auto& [key, face] : pipeline.faces_by_voxel()) {
        if (face.albedo_area.a < 0.99f || key.first[0] < 5 || key.first[0] > 10) continue;  // filters reach over the edge
        EXPECT_NEAR(face.albedo_area.r, (key.first[0] - 4 + 0.5f) / 8.0f, 0.02f);
        ++compared;
    }
    EXPECT_EQ(compared, 6 * 8);
}

TEST(Averaging, CoverageFollowsTheMask)
{
    // One texel of four stays.
    SceneBuilder builder;
    Material m = lambert(0.5f);
    m.alpha_mode = AlphaMode::mask;
    m.base_color_texture.image = builder.image(128, 128, checkerboard(128, {255, 255, 255, 255}, {255, 255, 255, 0}, 4));
    builder.quad({4.2f, 4.2f, 8.5f}, {8, 0, 0}, {0, 8, 0}, builder.material(m));
    // Cut out as a whole: nothing of it may count.
    Material gone = lambert(0.5f);
    gone.alpha_mode = AlphaMode::mask;
    gone.base_color.a = 0.2f;
    builder.quad({4.2f, 4.2f, 20.5f}, {8, 0, 0}, {0, 8, 0}, builder.material(gone));
    SoupPipeline pipeline(builder.build(), unit_bounds(32), 32);
    pipeline.average();
    EXPECT_NEAR(pipeline.total_area_voxels(), 0.25 * 64.0, 0.01 * 16.0);
    for (const auto& [key, face] : pipeline.faces_by_voxel()) {
        EXPECT_TRUE(std::isfinite(face.albedo_area.r) && std::isfinite(face.normal.z));
        if (key.first[2] == 20) {
            EXPECT_EQ(face.albedo_area.a, 0.0f);
        } else if (face.albedo_area.a > 0.1f) {
            EXPECT_NEAR(face.albedo_area.r, 0.5f, 0.01f);
        }
    }
}

// What pixels show of a mask: base colour factor, vertex colour and texture, multiplied, against the cutoff.
struct MaskCase {
    std::string what;
    float (*vertex_alpha)(float x, float y);  // at (x, y) of the unit square
    std::vector<std::uint8_t> texture_alpha;  // of two kinds of texels in turn; empty: no texture
    float factor, cutoff;
    double covered;  // share of the square
};

TEST(Averaging, CoverageFollowsFactorVertexAndTexture)
{
    const auto one = [](float, float) { return 1.0f; };
    const auto under = [](float, float) { return 0.48f; };
    const auto over = [](float, float) { return 0.52f; };
    const auto along = [](float x, float) { return x; };
    const auto across = [](float x, float y) { return 0.5f * (x + y); };
    constexpr double kHalf = 128.0 / 255.0;
    const std::vector<MaskCase> cases = {
        {"white texture, vertex alpha under the cutoff", under, {255, 255}, 1.0f, 0.5f, 0.0},
        {"white texture, vertex alpha over it", over, {255, 255}, 1.0f, 0.5f, 1.0},
        {"no texture, vertex alpha under the cutoff", under, {}, 1.0f, 0.5f, 0.0},
        {"texture and factor under the cutoff", one, {153, 153}, 0.8f, 0.5f, 0.0},
        {"texture and factor over it", one, {153, 153}, 0.9f, 0.5f, 1.0},
        {"texture of two values", one, {255, 102}, 1.0f, 0.5f, 0.5},
        {"gradient", along, {}, 1.0f, 0.5f, 0.5},
        {"gradient and factor", along, {}, 0.8f, 0.5f, 1.0 - 0.5 / 0.8},
        {"gradient and white texture", along, {255, 255}, 1.0f, 0.3f, 0.7},
        {"gradient across", across, {}, 1.0f, 0.3f, 1.0 - 0.5 * 0.6 * 0.6},
        {"gradient and half alpha", along, {128, 128}, 1.0f, 0.2f, 1.0 - 0.2 / kHalf},
        {"gradient and texture of two values", along, {255, 128}, 1.0f, 0.4f, 0.5 * 0.6 + 0.5 * (1.0 - 0.4 / kHalf)},
        {"gradient across, factor and holes", across, {255, 0}, 0.9f, 0.36f, 0.5 * (1.0 - 0.5 * 0.8 * 0.8)},
    };
    for (const MaskCase& c : cases)
        for (const int cells : {1, 3, 40}) {  // triangles much larger, and smaller, than voxels
            SceneBuilder builder;
            Material m = lambert(0.5f);
            m.alpha_mode = AlphaMode::mask;
            m.alpha_cutoff = c.cutoff;
            m.base_color.a = c.factor;
            if (!c.texture_alpha.empty()) {
                const glm::u8vec4 a(255, 255, 255, c.texture_alpha[0]), b(255, 255, 255, c.texture_alpha[1]);
                m.base_color_texture.image = builder.image(64, 64, checkerboard(64, a, b, 2));
                m.base_color_texture.mag_filter = Filter::nearest;
            }
            const glm::vec3 corner(4.2f, 4.3f, 8.5f);
            builder.quad(corner, {8, 0, 0}, {0, 8, 0}, builder.material(m), cells);
            Scene scene = builder.build();
            for (Vertex& v : scene.vertices)
                v.color.a = c.vertex_alpha((v.position.x - corner.x) / 8.0f, (v.position.y - corner.y) / 8.0f);
            SoupPipeline pipeline(scene, unit_bounds(16), 16);
            pipeline.average();
            std::printf("%s, %d cells: covered %.4f, exact %.4f\n", c.what.c_str(), cells,
                        pipeline.total_area_voxels() / 64.0, c.covered);
            EXPECT_NEAR(pipeline.total_area_voxels() / 64.0, c.covered, 0.02) << c.what << ", " << cells << " cells";
        }
}

// Files of which one shows nothing of its masked surfaces and the other all: vertex alpha 0.48 and 0.52, cutoff 0.5.
TEST(Averaging, MaskedByVertexAlphaInFiles)
{
    const char* shared = std::getenv("CONEBOOK_SHARED");
    for (const std::string name : {"vertex_alpha_mask_tex", "vertex_alpha_mask_tex_visible"}) {
        const auto file = std::filesystem::path(shared ? shared : "") / "cases" / name / (name + ".glb");
        if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
        test_gl();
        const Scene scene = load_scene(file);
        double visible_m2 = 0.0;
        for (const Draw& draw : scene.draws) {
            const Material& m = scene.materials[std::size_t(draw.material)];
            if (m.alpha_mode == AlphaMode::mask && name == "vertex_alpha_mask_tex") continue;
            for (std::uint32_t i = draw.first_index; i < draw.first_index + draw.index_count; i += 3) {
                const auto corner = [&](std::uint32_t k) { return scene.vertices[scene.indices[i + k]].position; };
                visible_m2 += (m.double_sided ? 2.0 : 1.0) * 0.5 *
                              double(glm::length(glm::cross(corner(1) - corner(0), corner(2) - corner(0))));
            }
        }
        SoupPipeline pipeline(scene, 64);
        pipeline.average();
        const double side_m = double(pipeline.grid().voxel_size_m());
        EXPECT_NEAR(pipeline.total_area_voxels() * side_m * side_m / visible_m2, 1.0, 1e-3) << name;
    }
}

}  // namespace
}  // namespace conebook
