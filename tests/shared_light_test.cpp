// What `reference --share` does to light: against sums that are known.
#include <cmath>
#include <cstdlib>
#include <functional>

#include <gtest/gtest.h>

#include "reference/shared_light.hpp"

namespace conebook {
namespace {

constexpr int kSize = 32;

// A floor, and from column `wall` on a wall that rises from it; a pixel is 0.1 m. rho differs from pixel to pixel.
std::vector<VisibleSurface> floor_and_wall(int wall)
{
    std::vector<VisibleSurface> surfaces;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x) {
            const bool on_wall = x >= wall;
            const glm::vec3 normal = on_wall ? glm::vec3(-1, 0, 0) : glm::vec3(0, 1, 0);
            const glm::vec3 position = 0.1f * (on_wall ? glm::vec3(wall, x - wall, y) : glm::vec3(x, 0, y));
            surfaces.push_back(
                {true, position, normal, normal, glm::vec3(0.1f, 0.5f, 0.3f + 0.1f * float((x + y) % 5))});
        }
    return surfaces;
}

ImageF picture(const std::vector<VisibleSurface>& surfaces,
               const std::function<glm::vec3(int x, int y)>& irradiance_over_pi)
{
    ImageF image{kSize, kSize, {}};
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            image.pixels.push_back(
                glm::vec4(surfaces[std::size_t(y * kSize + x)].rho * irradiance_over_pi(x, y), 0.5f));
    return image;
}

TEST(SharedLight, EvenLightStaysUnderAnyAlbedoAndDoesNotCrossAnEdge)
{
    constexpr int kWall = 13;
    const auto surfaces = floor_and_wall(kWall);
    const auto light = [](int x, int) { return x < kWall ? glm::vec3(1, 2, 3) : glm::vec3(40, 50, 60); };
    const ImageF before = picture(surfaces, light), after = share_indirect_diffuse(before, surfaces, 0.05f, 2);
    for (std::size_t i = 0; i < before.pixels.size(); ++i) {
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(after.pixels[i][c], before.pixels[i][c], 1e-5f * before.pixels[i][c]);
        EXPECT_EQ(after.pixels[i].a, 0.5f);
    }
}

TEST(SharedLight, OnePixelSpreadsAsATent)
{
    auto surfaces = floor_and_wall(kSize);
    for (VisibleSurface& surface : surfaces) surface.rho = glm::vec3(0.5f);
    const ImageF before = picture(surfaces, [](int x, int y) { return glm::vec3(x == 15 && y == 16 ? 1.0f : 0.0f); });
    const ImageF after = share_indirect_diffuse(before, surfaces, 0.05f, 1);
    for (int y = 7; y < kSize - 7; ++y)
        for (int x = 7; x < kSize - 7; ++x) {
            const double tent = std::max(0, 7 - std::abs(x - 15)) * std::max(0, 7 - std::abs(y - 16)) / (49.0 * 49.0);
            EXPECT_NEAR(after.pixels[std::size_t(y * kSize + x)].g, 0.5 * tent, 1e-7) << x << " " << y;
        }
}

TEST(SharedLight, WhatSeesNothingKeepsWhatItHas)
{
    auto surfaces = floor_and_wall(kSize);
    surfaces[5 * kSize + 5] = {};
    ImageF before = picture(surfaces, [](int, int) { return glm::vec3(1.0f); });
    before.pixels[5 * kSize + 5] = glm::vec4(0.2f, 0.3f, 0.4f, 0.1f);
    const ImageF after = share_indirect_diffuse(before, surfaces, 0.05f);
    EXPECT_EQ(after.pixels[5 * kSize + 5], before.pixels[5 * kSize + 5]);
    EXPECT_NEAR(after.pixels[5 * kSize + 6].r, 0.1f, 1e-6f);
}

}  // namespace
}  // namespace conebook
