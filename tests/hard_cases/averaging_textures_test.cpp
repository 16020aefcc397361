// Textures and alpha masks in voxels, against what their texels say.
#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace conebook
