// Chapter 01 against closed forms in double precision: Lambert planes under each light type, GGX, the tone curve.
#include <cmath>
#include <functional>

#include <gtest/gtest.h>

#include "01_first_light/forward_pass.hpp"
#include "01_first_light/tone_map.hpp"
#include "reference/brdf.hpp"
#include "scene_builder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr float kRho = 0.6f;
constexpr int kSize = 32;          // pixels
constexpr float kHalfWidth = 0.1f; // m, of the orthographic picture
constexpr double kTolerance = 0.005;  // hard-cases.md, "Light"

double radians(double degrees) { return degrees * kPiD / 180.0; }

ImageF render(const Scene& scene, const Camera& camera, glm::ivec2 size = {kSize, kSize},
              ForwardOutput output = ForwardOutput::radiance)
{
    ForwardPass pass(test_gl().shaders);  // the context comes first
    const GpuScene gpu_scene(scene);
    return read_picture(pass.run(gpu_scene, camera_data(camera, size, scene.bounds), size, output));
}

// A floor y = 0 that is larger than every picture of it.
SceneBuilder floor_scene(const Material& material)
{
    SceneBuilder b;
    b.quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, b.material(material));
    return b;
}

// Straight down on the floor round (x, 0, 0); look_at's up is then -z.
Camera camera_above(float x, float half_width = kHalfWidth)
{
    return look_at_orthographic({x, 10, 0}, {x, 0, 0}, half_width, half_width);
}

// Point of the floor under the centre of a pixel of camera_above.
glm::dvec3 floor_point(double center_x, int x, int y, int size = kSize, double half_width = kHalfWidth)
{
    const double step = 2.0 * half_width / size;
    return {center_x - half_width + (x + 0.5) * step, 0.0, -half_width + (y + 0.5) * step};
}

// Largest relative error of every channel over the picture against `expected` radiance.
void expect_radiance(const ImageF& image, double center_x, const std::function<double(glm::dvec3)>& expected)
{
    double worst = 0.0;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double truth = expected(floor_point(center_x, x, y, image.width));
            ASSERT_GT(truth, 0.0);
            for (int c = 0; c < 3; ++c) worst = std::max(worst, std::abs(image.at(x, y)[c] / truth - 1.0));
            ASSERT_EQ(image.at(x, y).a, 1.0f);
        }
    EXPECT_LT(worst, kTolerance);
}

class PlaneAtAngle : public testing::TestWithParam<double> {};

TEST_P(PlaneAtAngle, DirectionalLight)
{
    const double theta = radians(GetParam());
    SceneBuilder b = floor_scene(lambert(kRho));
    b.directional_light({-std::sin(theta), -std::cos(theta), 0}, glm::vec3(3.0f));
    expect_radiance(render(b.build(), camera_above(0)), 0.0,
                    [&](glm::dvec3) { return kRho / kPiD * 3.0 * std::cos(theta); });
}

TEST_P(PlaneAtAngle, PointLight)
{
    const double theta = radians(GetParam()), height = 2.0, x = height * std::tan(theta);
    SceneBuilder b = floor_scene(lambert(kRho));
    b.point_light({0, height, 0}, glm::vec3(7.0f));
    expect_radiance(render(b.build(), camera_above(float(x))), x, [&](glm::dvec3 p) {
        const double d2 = glm::dot(p, p) + height * height;
        return kRho / kPiD * 7.0 * (height / std::sqrt(d2)) / d2;  // rho/pi I cos / d^2
    });
}

TEST_P(PlaneAtAngle, SpotLightInsideItsInnerCone)
{
    const double theta = radians(GetParam()), height = 2.0, x = height * std::tan(theta);
    SceneBuilder b = floor_scene(lambert(kRho));
    b.spot_light({0, height, 0}, {x, -height, 0}, glm::vec3(7.0f), 0.3f, 0.5f);
    expect_radiance(render(b.build(), camera_above(float(x))), x, [&](glm::dvec3 p) {
        const double d2 = glm::dot(p, p) + height * height;
        return kRho / kPiD * 7.0 * (height / std::sqrt(d2)) / d2;
    });
}

// KHR_lights_punctual: attenuation = ((cos - cos_outer) / (cos_inner - cos_outer))^2 between the two cones.
TEST_P(PlaneAtAngle, SpotLightBetweenItsCones)
{
    const double theta = radians(GetParam()), height = 2.0, x = height * std::tan(theta);
    const double inner = 0.1, outer = 0.5, off_axis = 0.3;
    SceneBuilder b = floor_scene(lambert(kRho));
    const glm::dvec3 axis(std::sin(theta - off_axis), -std::cos(theta - off_axis), 0.0);
    b.spot_light({0, height, 0}, glm::vec3(axis), glm::vec3(7.0f), float(inner), float(outer));
    expect_radiance(render(b.build(), camera_above(float(x))), x, [&](glm::dvec3 p) {
        const glm::dvec3 from_light = p - glm::dvec3(0, height, 0);
        const double d = glm::length(from_light), cosine = glm::dot(from_light, axis) / d;
        const double edge = (cosine - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
        return kRho / kPiD * 7.0 * edge * edge * (height / d) / (d * d);
    });
}

// KHR_lights_punctual: window = max(min(1 - (d / range)^4, 1), 0).
TEST_P(PlaneAtAngle, PointLightWithRange)
{
    const double theta = radians(GetParam()), height = 2.0, x = height * std::tan(theta), range = 5.0;
    SceneBuilder b = floor_scene(lambert(kRho));
    b.point_light({0, height, 0}, glm::vec3(7.0f), float(range));
    expect_radiance(render(b.build(), camera_above(float(x))), x, [&](glm::dvec3 p) {
        const double d2 = glm::dot(p, p) + height * height;
        return kRho / kPiD * 7.0 * (1.0 - d2 * d2 / std::pow(range, 4)) * (height / std::sqrt(d2)) / d2;
    });
}

INSTANTIATE_TEST_SUITE_P(Degrees, PlaneAtAngle, testing::Values(0.0, 60.0));

TEST(FirstLight, LightsAddUp)
{
    SceneBuilder b = floor_scene(emitter(0.25f, kRho));
    b.directional_light({0, -1, 0}, {1, 2, 3});
    b.directional_light({0.6f, -0.8f, 0}, {5, 5, 5});
    const ImageF image = render(b.build(), camera_above(0));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image.at(7, 9)[c], 0.25 + kRho / kPiD * (1.0 + c + 5.0 * 0.8), 1e-5);
}

// The path tracer's BRDF was written independently of the shader's.
TEST(FirstLight, GgxIsThePathTracersBrdf)
{
    for (const float roughness : {0.0f, 0.1f, 0.35f, 0.7f, 1.0f})
        for (const float metallic : {0.0f, 0.4f, 1.0f})
            for (const float specular : {0.3f, 1.0f}) {
                Material m = lambert(glm::vec3(0.8f, 0.5f, 0.1f));
                m.metallic = metallic;
                m.roughness = roughness;
                m.specular = specular;
                SceneBuilder b = floor_scene(m);
                b.directional_light({0.5f, -0.8f, 0.1f}, glm::vec3(2.0f));
                const Scene scene = b.build();
                // Near the mirror direction, and away from it.
                for (const glm::vec3 to_eye : {glm::vec3(0.45f, 0.8f, 0.05f), glm::vec3(-0.7f, 0.6f, 0.4f)}) {
                    const Camera camera = look_at_orthographic(10.0f * to_eye, {0, 0, 0}, 0.01f, 0.01f);
                    const ImageF image = render(scene, camera, {2, 2});
                    const Brdf brdf = Brdf::from_metallic_roughness(m.base_color, metallic, roughness, specular,
                                                                    glm::vec3(1.0f));
                    const Frame frame(glm::vec3(0, 1, 0));
                    const glm::vec3 wi = frame.to_local(-scene.lights[0].direction);
                    const glm::vec3 wo = frame.to_local(glm::normalize(to_eye));
                    const glm::vec3 truth = evaluate_brdf(brdf, wo, wi).sum() * 2.0f * wi.z;
                    for (int c = 0; c < 3; ++c)
                        EXPECT_NEAR(image.at(1, 1)[c] / truth[c], 1.0, kTolerance)
                            << "roughness " << roughness << " metallic " << metallic << " specular " << specular;
                }
            }
}

TEST(FirstLight, LightVeryNearIsFiniteAndRight)
{
    // Nearer, the rounding of positions on a floor of 100 m is no longer small; tests/robustness/odd_scenes_test.cpp has
    // whole scenes of a micrometre.
    for (const double height : {1e-4, 2e-4, 1e-2}) {
        SceneBuilder b = floor_scene(lambert(kRho));
        b.point_light({0, float(height), 0}, glm::vec3(1.0f));
        const ImageF image = render(b.build(), camera_above(0, float(height)), {33, 33});
        for (const glm::vec4& pixel : image.pixels) ASSERT_TRUE(std::isfinite(pixel.r) && pixel.r > 0.0f);
        EXPECT_NEAR(image.at(16, 16).r / (kRho / kPiD / (height * height)), 1.0, kTolerance) << height;
    }
}

TEST(FirstLight, LightNearerThanTheClampIsBounded)
{
    const double clamp_m = kMinLightDistance;
    for (const float height : {1e-15f, 1e-16f, 1e-18f}) {
        SceneBuilder b = floor_scene(lambert(kRho));
        b.point_light({0, height, 0}, glm::vec3(1.0f));
        for (const glm::vec4& pixel : render(b.build(), camera_above(0, 1e-15f), {33, 33}).pixels)
            ASSERT_TRUE(pixel.r >= 0.0f && pixel.r <= 1.001 * kRho / kPiD / (clamp_m * clamp_m)) << height;
    }
}

TEST(FirstLight, LightInsideTheSurfaceIsFinite)
{
    SceneBuilder b = floor_scene(metal(glm::vec3(0.9f), 0.0f));
    b.point_light({0, 0, 0}, glm::vec3(1000.0f));
    b.spot_light({0, 0, 0}, {0, -1, 0}, glm::vec3(1000.0f), 0.0f, 0.5f);
    for (const glm::vec4& pixel : render(b.build(), camera_above(0, 1e-4f), {33, 33}).pixels)
        for (int c = 0; c < 3; ++c) ASSERT_TRUE(std::isfinite(pixel[c]) && pixel[c] >= 0.0f);
}

TEST(FirstLight, SpotEndsContinuouslyAtItsCutoff)
{
    const double height = 2.0, outer = 0.5, edge_x = height * std::tan(outer);
    for (const double inner : {0.0, 0.45}) {
        SceneBuilder b = floor_scene(lambert(kRho));
        b.spot_light({0, height, 0}, {0, -1, 0}, glm::vec3(7.0f), float(inner), float(outer));
        const int size = 256;
        const ImageF image = render(b.build(), camera_above(float(edge_x)), {size, size});
        const double on_axis = kRho / kPiD * 7.0 / (height * height);
        for (int x = 1; x < size; ++x) {
            const glm::dvec3 p = floor_point(edge_x, x, size / 2, size);
            const double cosine = height / std::sqrt(glm::dot(p, p) + height * height);
            if (cosine < std::cos(outer)) {
                EXPECT_EQ(image.at(x, size / 2).r, 0.0f) << x;
            }
            // 0.2 m hold the whole transition of the narrower ring: a continuous curve moves under 2 % a pixel.
            EXPECT_LT(std::abs(image.at(x, size / 2).r - image.at(x - 1, size / 2).r), 0.02 * on_axis) << x;
        }
    }
}

TEST(FirstLight, SpotWithEqualConesIsFinite)
{
    SceneBuilder b = floor_scene(lambert(kRho));
    b.spot_light({0, 2, 0}, {0, -1, 0}, glm::vec3(7.0f), 0.5f, 0.5f);
    const ImageF image = render(b.build(), camera_above(0));
    EXPECT_NEAR(image.at(16, 16).r / (kRho / kPiD * 7.0 / 4.0), 1.0, kTolerance);
}

TEST(FirstLight, ZeroIntensityGivesExactlyNothing)
{
    SceneBuilder b = floor_scene(metal(glm::vec3(0.9f), 0.2f));
    b.point_light({0, 2, 0}, glm::vec3(0.0f));
    b.directional_light({0, -1, 0}, glm::vec3(0.0f));
    b.spot_light({0, 2, 0}, {0, -1, 0}, glm::vec3(0.0f), 0.1f, 0.5f);
    for (const glm::vec4& pixel : render(b.build(), camera_above(0)).pixels) EXPECT_EQ(glm::vec3(pixel), glm::vec3(0.0f));
}

TEST(FirstLight, LightFromBehindAndBelowGivesNothing)
{
    SceneBuilder b = floor_scene(lambert(kRho));
    b.point_light({0, -1, 0}, glm::vec3(10.0f));
    b.directional_light({0, 1, 0}, glm::vec3(10.0f));
    for (const glm::vec4& pixel : render(b.build(), camera_above(0)).pixels) EXPECT_EQ(glm::vec3(pixel), glm::vec3(0.0f));
}

TEST(FirstLight, BackFacesAreLeftOutOrTurned)
{
    for (const bool double_sided : {false, true}) {
        Material m = lambert(kRho);
        m.double_sided = double_sided;
        SceneBuilder b = floor_scene(m);
        b.directional_light({0, 1, 0}, glm::vec3(2.0f));  // from below, where the camera is too
        const Camera below = look_at_orthographic({0, -10, 0}, {0, 0, 0}, 0.1f, 0.1f);
        const glm::vec4 pixel = render(b.build(), below).at(5, 5);
        EXPECT_EQ(pixel.a, double_sided ? 1.0f : 0.0f);
        EXPECT_NEAR(pixel.r, double_sided ? kRho / kPiD * 2.0 : 0.0, 1e-5);
    }
}

TEST(FirstLight, UnlitShinesWithItsColour)
{
    Material m = lambert(glm::vec3(0.2f, 0.4f, 0.8f));
    m.unlit = true;
    SceneBuilder b = floor_scene(m);
    b.directional_light({0, -1, 0}, glm::vec3(100.0f));
    const glm::vec4 pixel = render(b.build(), camera_above(0)).at(5, 5);
    EXPECT_NEAR(pixel.r, 0.2f, 1e-6f);
    EXPECT_NEAR(pixel.b, 0.8f, 1e-6f);
}

TEST(FirstLight, NormalMapTurnsTheLight)
{
    // A constant map that leans 30 degrees towards the tangent (+x): n = (sin, 0, cos) in tangent space.
    SceneBuilder b;
    Material m = lambert(kRho);
    const auto texel = [](double v) { return std::uint8_t(std::lround((0.5 + 0.5 * v) * 255.0)); };
    m.normal_texture.image =
        b.image(1, 1, {texel(std::sin(radians(30))), texel(0.0), texel(std::cos(radians(30))), 255});
    b.quad({-50, 0, 50}, {100, 0, 0}, {0, 0, -100}, b.material(m));
    b.directional_light({-std::sin(float(radians(30))), -std::cos(float(radians(30))), 0}, glm::vec3(2.0f));
    // 8 bits a channel: the normal is 0.3 degrees off at most, its cosine with the light 2e-5.
    EXPECT_NEAR(render(b.build(), camera_above(0)).at(5, 5).r, kRho / kPiD * 2.0, 1e-4);
}

// The curve of tone_map.frag in double precision.
double display_value(double channel, double luminance, double white)
{
    const double shown = luminance * (1.0 + luminance / (white * white)) / (1.0 + luminance);
    const double linear = std::min(1.0, luminance > 0.0 ? channel * shown / luminance : 0.0);
    return 255.0 * (linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055);
}

TEST(ToneMap, IsReinhardThenSrgbOnce)
{
    const int n = 64;
    std::vector<glm::vec4> pixels(std::size_t(n * n));
    for (int i = 0; i < n * n; ++i) {
        const float base = std::pow(10.0f, -4.0f + 6.0f * float(i) / float(n * n));  // 1e-4 .. 1e2
        pixels[std::size_t(i)] = {base, base * float(i % 7) / 7.0f, base * float(i % 3) / 3.0f, 1.0f};
    }
    ToneMapPass pass(test_gl().shaders);
    const gl::Texture linear = gl::texture_2d("test", GL_RGBA32F, {n, n});
    glTextureSubImage2D(linear.id(), 0, 0, 0, n, n, GL_RGBA, GL_FLOAT, pixels.data());
    for (const double exposure : {1.0, 0.25}) {
        DisplayParams params;
        params.exposure = float(exposure);
        const gl::Texture& shown = pass.run(linear, Encoding::radiance, params);
        std::vector<std::uint8_t> bytes(std::size_t(4 * n * n));
        glGetTextureImage(shown.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(bytes.size()), bytes.data());
        for (int i = 0; i < n * n; ++i) {
            const glm::dvec3 c = exposure * glm::dvec3(pixels[std::size_t(i)]);
            const double luminance = 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
            for (int k = 0; k < 3; ++k)
                // Half a step of rounding, and what pow() of the driver may be off.
                ASSERT_NEAR(bytes[std::size_t(4 * i + k)], display_value(c[k], luminance, params.white), 0.51) << i;
        }
    }
}

TEST(ToneMap, LeavesDataAsItIs)
{
    ToneMapPass pass(test_gl().shaders);
    const gl::Texture linear = gl::texture_2d("test", GL_RGBA32F, {1, 1});
    const float value[4] = {0.25f, 0.5f, 2.0f, 0.0f};
    glTextureSubImage2D(linear.id(), 0, 0, 0, 1, 1, GL_RGBA, GL_FLOAT, value);
    std::uint8_t bytes[4];
    glGetTextureImage(pass.run(linear, Encoding::data, {}).id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, 4, bytes);
    EXPECT_EQ(bytes[0], 64);
    EXPECT_EQ(bytes[1], 128);
    EXPECT_EQ(bytes[2], 255);
    EXPECT_EQ(bytes[3], 255);
    glGetTextureImage(pass.run(linear, Encoding::color, {}).id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, 4, bytes);
    EXPECT_EQ(bytes[1], 188);  // sRGB of 0.5: 0.7354 * 255
}

TEST(FirstLight, NoOpenGlFaults) { EXPECT_EQ(test_gl().log.faults(), std::vector<std::string>{}); }

}  // namespace
}  // namespace conebook
