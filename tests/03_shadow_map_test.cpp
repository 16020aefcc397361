// Chapter 03: shadows against exact geometry in double precision.
#include "shadow_geometry.hpp"

namespace conebook {
namespace {

class LightAngle : public testing::TestWithParam<int> {};

TEST_P(LightAngle, DirectionalHasNoAcneAndNoLeak)
{
    for (const double azimuth : {0.0, 27.0, 200.0}) {
        const glm::vec3 towards = direction_to_light(GetParam(), azimuth);
        SceneBuilder b = box_on_floor();
        b.directional_light(-towards, glm::vec3(3.0f));
        expect_clean(b.build(), towards, GetParam() >= 30 ? 200 : 0, "azimuth " + std::to_string(azimuth));
    }
}

TEST_P(LightAngle, SpotHasNoAcneAndNoLeak)
{
    for (const double azimuth : {27.0, 200.0}) {
        const glm::vec3 towards = direction_to_light(GetParam(), azimuth);
        SceneBuilder b = box_on_floor();
        b.spot_light(3.0f * towards, -towards, glm::vec3(30.0f), 0.5f, 0.75f);
        expect_clean(b.build(), towards, GetParam() >= 30 ? 100 : 0, "azimuth " + std::to_string(azimuth));
    }
}

TEST_P(LightAngle, PointHasNoAcneAndNoLeak)
{
    for (const double azimuth : {27.0, 200.0}) {
        const glm::vec3 towards = direction_to_light(GetParam(), azimuth);
        SceneBuilder b = box_on_floor();
        b.point_light(3.0f * towards, glm::vec3(30.0f));
        expect_clean(b.build(), towards, GetParam() >= 30 ? 100 : 0, "azimuth " + std::to_string(azimuth));
    }
}

INSTANTIATE_TEST_SUITE_P(Degrees, LightAngle, testing::Values(0, 10, 30, 45, 60, 75, 80, 85, 87, 89),
                         [](const auto& info) { return std::to_string(info.param); });

// The same measure finds the fault when the comparison is made naively: otherwise it would prove nothing.
TEST(ShadowMap, WithoutTheReceiversPlaneThereIsAcne)
{
    const glm::vec3 towards = direction_to_light(75, 27);
    SceneBuilder b = box_on_floor();
    b.directional_light(-towards, glm::vec3(3.0f));
    const Scene scene = b.build();
    const Faults f = compare_with_geometry(scene, shade(scene, cameras(towards)[0], map_params(false)));
    EXPECT_GT(f.acne_share(), 0.2);
}

// And a large bias cures the acne but lets light under the box.
TEST(ShadowMap, ALargeBiasLeaks)
{
    const glm::vec3 towards = direction_to_light(75, 27);
    SceneBuilder b = box_on_floor();
    b.directional_light(-towards, glm::vec3(3.0f));
    const Scene scene = b.build();
    ShadowMapParams params = map_params(false);
    params.shadow_bias = 10.0f;
    const Faults f = compare_with_geometry(scene, shade(scene, cameras(towards)[0], params));
    EXPECT_LT(f.acne_share(), 0.05);
    EXPECT_GT(f.leaks, 0);
}

// The half-lit line lies on the geometric edge: the mean of visibility - truth over the edge's pixels is a shift.
TEST(ShadowMap, TheEdgeIsWhereGeometrySaysItIs)
{
    for (const double theta : {20.0, 45.0, 70.0}) {
        const glm::vec3 towards = direction_to_light(theta, 0.0);  // the shadow of the top edge runs along z
        SceneBuilder b = box_on_floor(4.0f);
        b.directional_light(-towards, glm::vec3(3.0f));
        const Scene scene = b.build();
        const double edge_x = -0.5 - 0.8 * std::tan(theta * kPiD / 180.0);
        const float half = 0.05f;
        const Camera camera = look_at_orthographic({float(edge_x), 5, 0}, {float(edge_x), 0, 0}, half, half);
        const ImageF visibility = shade(scene, camera, map_params()).visibility;
        double lit_pixels = 0.0;
        for (const glm::vec4& v : visibility.pixels) lit_pixels += v.r;
        const double measured_x = edge_x - half + 2.0 * half * lit_pixels / (kPicture.x * kPicture.y);
        const glm::mat4 map = maps_of(scene, scene.lights[0])[0];
        const glm::vec4 moved = map * glm::vec4(float(measured_x - edge_x), 0, 0, 0);
        const double texels = glm::length(glm::vec2(moved)) * kMapSize / 2.0;
        EXPECT_LT(texels, 0.75) << theta;  // half a texel of the map's own steps, and the bias
    }
}

TEST(ShadowMap, WideSpotsUseSixMaps)
{
    SceneBuilder b = box_on_floor();
    b.spot_light({0.6f, 1.5f, 0.4f}, {-0.2f, -1, 0}, glm::vec3(30.0f), 1.3f, 1.5f);
    const Scene scene = b.build();
    EXPECT_EQ(maps_of(scene, scene.lights[0]).size(), 6u);
    expect_clean(scene, {0.6f, 1.5f, 0.4f}, 200, "wide spot");
}

// Across the edges and corners of a point light's six maps: a room round the light, nothing in it, all of it lit.
TEST(ShadowMap, NoSeamsBetweenTheFacesOfAPointLight)
{
    SceneBuilder b;
    b.box({-1, -1, -1}, {1, 1, 1}, b.material(lambert(0.5f)), true);
    b.point_light({0.13f, -0.21f, 0.17f}, glm::vec3(5.0f));
    const Scene scene = b.build();
    for (const glm::vec3 target : {glm::vec3(1, 1, 1), glm::vec3(-1, -1, 1), glm::vec3(1, -1, -1), glm::vec3(-1, 1, -1)}) {
        const Shaded shaded = shade(scene, look_at(-0.9f * target, target, 1.6f), map_params());
        // Where two walls meet, the filter of one reaches behind the other. The farthest wall is 1.21 m from the light,
        // the nearest 0.79 m: seen at a slant, a texel is 1.21 / 0.79 times as long on it, and sqrt(2) on its diagonal.
        const float texel_m = 2.0f / kMapSize * 1.21f * (1.21f / 0.79f) * std::sqrt(2.0f);
        const float corner_m = float(kLeakTexels * std::sqrt(2.0)) * texel_m;
        int dark = 0, pixels = 0;
        for (std::size_t i = 0; i < shaded.visibility.pixels.size(); ++i) {
            int walls = 0;
            for (int a = 0; a < 3; ++a) walls += std::abs(shaded.position.pixels[i][a]) > 1.0f - corner_m ? 1 : 0;
            if (walls > 1) continue;
            ++pixels;
            dark += shaded.visibility.pixels[i].r < 0.99f ? 1 : 0;
        }
        EXPECT_GT(pixels, 30000);
        EXPECT_EQ(dark, 0);
    }
}

// Facets of a convex body that turn to the light are lit, down to the terminator.
TEST(ShadowMap, NoAcneOnRoundThings)
{
    for (const int rings : {8, 32, 64}) {
        SceneBuilder b;
        b.sphere({0, 0, 0}, 1.0f, b.material(lambert(0.5f)), rings, false, true);
        const glm::vec3 towards = direction_to_light(50, 30);
        b.directional_light(-towards, glm::vec3(3.0f));
        const Scene scene = b.build();
        const Shaded shaded = shade(scene, look_at(glm::vec3(3, 1, 2), {0, 0, 0}, 0.7f), map_params());
        int lit = 0, acne = 0;
        for (std::size_t i = 0; i < shaded.visibility.pixels.size(); ++i) {
            if (shaded.visibility.pixels[i].r < 0.0f) continue;
            const glm::vec3 n = 2.0f * glm::vec3(shaded.normal.pixels[i]) - 1.0f;
            if (glm::dot(n, towards) < 1e-3f) continue;
            ++lit;
            acne += shaded.visibility.pixels[i].r < 0.99f ? 1 : 0;
        }
        EXPECT_GT(lit, 5000);
        EXPECT_LT(double(acne) / lit, kAcneShare) << rings << " rings: " << acne << " of " << lit;
    }
}

// Mean visibility of the floor under a sheet that covers all of it, from above.
double floor_visibility(const Material& sheet, bool face_down, SceneBuilder b = {})
{
    const int grey = b.material(lambert(0.5f));
    const int cover = b.material(sheet);
    b.quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, grey);
    if (face_down) b.quad({-3, 1, -3}, {6, 0, 0}, {0, 0, 6}, cover);
    else b.quad({-3, 1, 3}, {6, 0, 0}, {0, 0, -6}, cover);
    b.directional_light({0.1f, -1, 0.05f}, glm::vec3(3.0f));
    const Camera under = look_at({0, 0.9f, 0}, {0, 0, 0}, 0.9f);
    double sum = 0.0;
    const Shaded shaded = shade(b.build(), under, map_params());
    for (const glm::vec4& v : shaded.visibility.pixels) sum += v.r;
    return sum / double(shaded.visibility.pixels.size());
}

TEST(ShadowMap, BothFacesCastShadows)
{
    EXPECT_EQ(floor_visibility(lambert(0.5f), false), 0.0);
    EXPECT_EQ(floor_visibility(lambert(0.5f), true), 0.0);
}

TEST(ShadowMap, AlphaMasksLetLightThrough)
{
    SceneBuilder b;
    Material m = lambert(0.5f);
    m.alpha_mode = AlphaMode::mask;
    // 64 squares of which every other one is a hole, large against the filter.
    std::vector<std::uint8_t> texels;
    for (int i = 0; i < 64; ++i) texels.insert(texels.end(), {255, 255, 255, std::uint8_t((i + i / 8) % 2 ? 255 : 0)});
    m.base_color_texture.image = b.image(8, 8, texels);
    m.base_color_texture.mag_filter = m.base_color_texture.min_filter = Filter::nearest;
    m.base_color_texture.mipmapped = false;
    // What the camera sees is 0.87 m wide, the squares are 0.75 m: the share of light is known to an edge's width.
    EXPECT_GT(floor_visibility(m, false, b), 0.2);
    EXPECT_LT(floor_visibility(m, false, b), 0.8);
    m.alpha_cutoff = 0.0f;  // everything stays
    EXPECT_EQ(floor_visibility(m, false, b), 0.0);
}

TEST(ShadowMap, ManyLightsEachHaveTheirOwn)
{
    SceneBuilder b = box_on_floor();
    b.point_light({0, 2, 0}, glm::vec3(0.0f));  // gives nothing and needs no map
    b.directional_light({1, -1, 0}, {1, 0, 0});
    b.spot_light({2, 2, 0}, {-1, -1, 0}, {0, 10, 0}, 0.4f, 0.6f);
    b.point_light({0, 2, 2}, {0, 0, 10});
    const Scene scene = b.build();
    const GpuScene gpu_scene(scene);
    ShadowMaps maps(test_gl().shaders);
    maps.draw(gpu_scene, map_params());
    EXPECT_EQ(maps.layers(), 0 + 1 + 1 + 6);
    // One colour a light: the picture of all of them is the sum of the pictures of one each.
    GBuffer g_buffer(test_gl().shaders, kPicture);
    const auto direct = [&](const Scene& s) {
        const GpuScene gpu(s);
        g_buffer.draw(gpu, camera_data(cameras({1, 1, 1})[0], kPicture, s.bounds));
        ShadowMaps own(test_gl().shaders);
        own.draw(gpu, map_params());
        DirectLightingPass lighting(test_gl().shaders, Shadows::maps);
        own.bind(lighting.program());
        return read_picture(lighting.run(g_buffer, gpu, LightingOutput::direct));
    };
    const ImageF all = direct(scene);
    for (int k = 0; k < 3; ++k) {
        Scene one = scene;
        one.lights = {scene.lights[std::size_t(k + 1)]};
        const ImageF image = direct(one);
        for (std::size_t i = 0; i < all.pixels.size(); ++i)
            ASSERT_NEAR(all.pixels[i][k], image.pixels[i][k], 1e-6f * (1.0f + image.pixels[i][k])) << "light " << k;
    }
}

TEST(ShadowMap, ManyLightsShareALimitedMemory)
{
    SceneBuilder b = box_on_floor();
    for (int i = 0; i < 60; ++i) b.point_light({0.01f * float(i), 2, 0}, glm::vec3(0.1f));
    const Scene scene = b.build();
    ShadowMapParams params;
    params.shadow_map_size = 2048;  // 360 maps of 16 MiB each would be 5.6 GiB
    const GpuScene gpu_scene(scene);
    ShadowMaps maps(test_gl().shaders);
    maps.draw(gpu_scene, params);
    EXPECT_EQ(maps.layers(), 360);
    EXPECT_EQ(maps.size(), 512);
    EXPECT_LE(maps.depth().bytes(), std::size_t(1) << 30);
}

// More maps than an array has layers stand side by side in them.
TEST(ShadowMap, TheMapsOfManyLightsShareLayers)
{
    GLint most_layers = 0;
    test_gl();
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &most_layers);
    SceneBuilder b = box_on_floor();
    const glm::vec3 towards = direction_to_light(50, 27);
    for (int i = 0; i < most_layers; ++i) b.directional_light(-towards, glm::vec3(1e-6f));
    b.directional_light(-towards, glm::vec3(3.0f));
    const Scene scene = b.build();
    ShadowMapParams params = map_params();
    params.shadow_map_size = 128;
    const GpuScene gpu_scene(scene);
    ShadowMaps maps(test_gl().shaders);
    maps.draw(gpu_scene, params);
    EXPECT_EQ(maps.layers(), most_layers + 1);
    EXPECT_EQ(maps.depth().size(), glm::ivec3(256, 256, most_layers / 4 + 1));
    EXPECT_EQ(maps.layer(most_layers).place, glm::ivec4(0, 0, most_layers / 4, 128));
    EXPECT_EQ(maps.layer(7).place, glm::ivec4(128, 128, 1, 128));
}

TEST(ShadowMap, NoLightsIsNoFault)
{
    const Scene scene = box_on_floor().build();
    const Shaded shaded = shade(scene, cameras({1, 1, 1})[0], map_params());
    for (const glm::vec4& v : shaded.visibility.pixels) EXPECT_EQ(v.r, -1.0f);
}

TEST(ShadowMap, LightInAWallOrOnTheFloorIsFinite)
{
    for (const glm::vec3 position : {glm::vec3(0, 0, 0), glm::vec3(0.5f, 0.4f, 0), glm::vec3(1, 1e-4f, 0)}) {
        SceneBuilder b = box_on_floor();
        b.point_light(position, glm::vec3(1.0f));
        const Shaded shaded = shade(b.build(), cameras({1, 1, 1})[0], map_params());
        for (const glm::vec4& v : shaded.visibility.pixels) ASSERT_TRUE(std::isfinite(v.r));
    }
}

TEST(ShadowMap, NoOpenGlFaults) { EXPECT_EQ(test_gl().log.faults(), std::vector<std::string>{}); }

}  // namespace
}  // namespace conebook
