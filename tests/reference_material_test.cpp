// The path tracer's materials: GGX against a quadrature in double, textures, masks, normal maps, sides of surfaces.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "reference_helpers.hpp"

namespace conebook {
namespace {

// Directional albedo of the specular lobe in double: the integral over half vectors, with tan^2 = alpha^2 u / (1 - u)
// (which makes D cos dw uniform in u and phi), of F G2 / (4 n.l n.v) * 4 (h.v) n.l / n.h; G2 = 1 / (1 + L(v) + L(l)),
// Heitz 2014 eq. 72 and 99. Independent of the tracer's code.
double specular_albedo(double f0, double f90, double roughness, double cosine)
{
    const double alpha = roughness * roughness;
    const glm::dvec3 v(std::sqrt(1.0 - cosine * cosine), 0.0, cosine);
    const auto lambda = [&](const glm::dvec3& w) {
        const double tan2 = (1.0 - w.z * w.z) / (w.z * w.z);
        return 0.5 * (std::sqrt(1.0 + alpha * alpha * tan2) - 1.0);
    };
    constexpr int n = 1000;
    double sum = 0.0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double u = (i + 0.5) / n, phi = 2.0 * kPiD * (j + 0.5) / n;
            const double c = 1.0 / std::sqrt(1.0 + alpha * alpha * u / (1.0 - u)), s = std::sqrt(1.0 - c * c);
            const glm::dvec3 h(s * std::cos(phi), s * std::sin(phi), c);
            const double vh = glm::dot(v, h);
            const glm::dvec3 l = 2.0 * vh * h - v;
            if (l.z <= 0.0 || vh <= 0.0) continue;
            const double f = f0 + (f90 - f0) * std::pow(1.0 - vh, 5.0);
            sum += f * vh / ((1.0 + lambda(v) + lambda(l)) * v.z * c);
        }
    return sum / (double(n) * n);
}

TEST(Ggx, MetalUnderConstantSkyReturnsItsDirectionalAlbedo)
{
    for (const double roughness : {0.1, 0.3, 0.6, 1.0})
        for (const double angle : {0.1, 1.0, 1.4}) {
            SceneBuilder b;
            b.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10},
                   b.material(metal(glm::vec3(0.9f, 0.5f, 1.0f), float(roughness))));
            const glm::vec3 eye(std::sin(angle), std::cos(angle), 0);
            PathTraceOptions o = options(1, 64);
            o.sky = glm::vec3(1);
            expect_radiance(measure(b.build(), at_point(eye, {}), o),
                            specular_albedo(0.9, 1.0, roughness, std::cos(angle)));
        }
}

TEST(Ggx, DielectricAddsItsLobes)
{
    Material m = lambert(0.3f);
    m.specular = 0.8f;
    m.specular_color = glm::vec3(0.5f, 1, 1);
    m.roughness = 0.5f;
    SceneBuilder b;
    b.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, b.material(m));
    PathTraceOptions o = options(1, 64);
    o.sky = glm::vec3(1);
    o.parts = {Part::indirect_specular};
    const Camera camera = at_point({std::sin(1.2f), std::cos(1.2f), 0}, {});
    const double specular = specular_albedo(0.04 * 0.5 * 0.8, 0.8, 0.5, std::cos(1.2));
    expect_radiance(measure(b.build(), camera, o), specular, 0.02);
    o.parts = {Part::final};
    expect_radiance(measure(b.build(), camera, o), 0.3 + specular);
}

TEST(Ggx, PunctualHighlightIsTheFormula)
{
    SceneBuilder b;
    b.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, b.material(metal(glm::vec3(0.7f), 0.4f)));
    b.directional_light({-1, -1, 0}, glm::vec3(2));
    const glm::dvec3 l = glm::normalize(glm::dvec3(1, 1, 0)), v = glm::normalize(glm::dvec3(-0.8, 1, 0.2));
    const glm::dvec3 h = glm::normalize(l + v);
    const double a2 = std::pow(0.4, 4), nh2 = h.y * h.y;
    const double d = a2 / (kPiD * std::pow(nh2 * (a2 - 1.0) + 1.0, 2));
    const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1.0 + a2 * (1.0 - c * c) / (c * c)) - 1.0); };
    const double g = 1.0 / (1.0 + lambda(l.y) + lambda(v.y));
    const double f = 0.7 + 0.3 * std::pow(1.0 - glm::dot(v, h), 5);
    const double radiance = f * d * g / (4.0 * l.y * v.y) * l.y * 2.0;
    // 0.1 degrees of view: the highlight bends by under 1e-3 inside the picture.
    expect_radiance(measure(b.build(), at_point(glm::vec3(v) * 3.0f, {}), options(0)), radiance, 0.005, 1e-3);
}

TEST(Sidedness, BacksBlockButCameraPasses)
{
    SceneBuilder b;
    b.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, b.material(lambert(0.5f)));
    b.quad({-5, 1, 5}, {10, 0, 0}, {0, 0, -10}, b.material(emitter(3.0f)));  // faces up: its back is towards the floor
    b.directional_light({0, -1, 0}, glm::vec3(1));
    const Scene scene = b.build();
    PathTraceOptions o = options(1);
    o.sky = glm::vec3(2);
    // From below the roof's back is culled: sky. The floor is in full shadow.
    EXPECT_EQ(measure(scene, at_point({0, 0.5f, 0}, {0, 2, 0}), o).mean, 2.0);
    EXPECT_EQ(measure(scene, at_point({0, 0.5f, 0.01f}, {0, 0, 0}), options(0)).mean, 0.0);
    o.sky = glm::vec3(0);
    EXPECT_EQ(measure(scene, at_point({0, 0.5f, 0.01f}, {0, 0, 0}), o).mean, 0.0) << "a back does not shine";
    // The same roof double-sided shines down on the floor and is seen from below.
    Scene two_sided = scene;
    two_sided.materials[1].double_sided = true;
    EXPECT_EQ(measure(two_sided, at_point({0, 0.5f, 0}, {0, 2, 0}), o).mean, 3.0);
    EXPECT_GT(measure(two_sided, at_point({0, 0.5f, 0.01f}, {0, 0, 0}), o).mean, 0.5 * 3.0 * 0.9);
}

TEST(Textures, AlphaMaskInCameraShadowAndBounceRays)
{
    // Two texels, alpha 0 and 1: bilinear alpha crosses 1/2 in the middle, or where uv_transform moves it.
    for (const float shift : {0.0f, 0.25f}) {
        SceneBuilder b;
        b.quad({0, 0, 1}, {1, 0, 0}, {0, 0, -1}, b.material(lambert(0.5f)));
        Material mask = lambert(glm::vec3(0.5f));
        mask.alpha_mode = AlphaMode::mask;
        mask.double_sided = true;
        mask.base_color_texture.image = b.image(2, 1, {255, 255, 255, 0, 255, 255, 255, 255});
        mask.base_color_texture.wrap_s = mask.base_color_texture.wrap_t = Wrap::clamp_to_edge;
        mask.base_color_texture.uv_transform[2][0] = shift;
        b.quad({0, 0.5f, 1}, {1, 0, 0}, {0, 0, -1}, b.material(mask));
        b.directional_light({0, -1, 0}, glm::vec3(2));
        const Scene scene = b.build();
        const double open = 0.5 - shift;  // share of the square that the mask leaves open
        const auto down = [](float height) {
            return look_at_orthographic({0.5f, height, 0.5f}, {0.5f, 0, 0.5f}, 0.5f, 0.5f);
        };
        const double lit = 0.5 / kPiD * 2.0;
        expect_radiance(measure(scene, down(0.3f), options(0)), open * lit, 0.01);  // shadow rays
        expect_radiance(measure(scene, down(1.0f), options(0)), lit,
                        0.01);  // both lit: mask, and floor seen through it

        // Bounce rays: an emitting sheet above; a real half sheet must give the same.
        Scene glow = scene;
        glow.lights.clear();
        Scene cut = glow;
        for (Vertex& v : cut.vertices)
            if (v.position.y > 0.4f && v.position.x < 0.5f) v.position.x = float(open);
        cut.materials[1].alpha_mode = AlphaMode::opaque;
        PathTraceOptions o = options(1);
        o.sky = glm::vec3(1);
        const auto a = measure(glow, down(0.3f), o), c = measure(cut, down(0.3f), o);
        EXPECT_NEAR(a.mean, c.mean, 3.0 * std::hypot(a.error, c.error));
        EXPECT_LT(a.error, 0.005 * a.mean);
    }
}

TEST(Textures, NormalMapTiltsAndFlipsOnTheBack)
{
    SceneBuilder b;
    Material m = lambert(0.5f);
    m.double_sided = true;
    const std::array<int, 3> stored{192, 128, 238};  // about 30 degrees towards the tangent
    m.normal_texture.image =
        b.image(1, 1, {std::uint8_t(stored[0]), std::uint8_t(stored[1]), std::uint8_t(stored[2]), 255});
    b.quad({-5, 0, 5}, {10, 0, 0}, {0, 0, -10}, b.material(m));  // tangent +x, bitangent -z
    b.directional_light({-1, -2, 0.3f}, glm::vec3(2));
    const auto decoded = [&](int i) { return stored[i] / 255.0 * 2.0 - 1.0; };
    const glm::dvec3 n = glm::normalize(glm::dvec3(decoded(0), decoded(2), -decoded(1)));
    const glm::dvec3 l = -glm::normalize(glm::dvec3(-1, -2, 0.3f));
    expect_radiance(measure(b.build(), at_point({0, 1, 0.1f}, {}), options(0)), 0.5 / kPiD * 2.0 * glm::dot(n, l));
    Scene below = b.build();
    below.lights[0].direction = -below.lights[0].direction;
    expect_radiance(measure(below, at_point({0, -1, 0.1f}, {}), options(0)), 0.5 / kPiD * 2.0 * glm::dot(n, l));
}

TEST(Textures, SrgbIsDecodedBeforeItIsMixedAndVertexColoursMultiply)
{
    SceneBuilder b;
    Material m = lambert(1.0f);
    m.base_color_texture.image = b.image(2, 1, {0, 0, 0, 255, 255, 255, 255, 255});
    b.quad({0, 0, 1}, {1, 0, 0}, {0, 0, -1}, b.material(m));
    b.directional_light({0, -1, 0}, glm::vec3(float(kPiD)));
    Scene scene = b.build();
    for (Vertex& v : scene.vertices) v.color = glm::vec4(0.25f);
    // Halfway between black and white is 0.5 in linear light (mixed as stored values it would be 0.21).
    expect_radiance(measure(scene, look_at({0.5f, 1, 0.5f}, {0.5f, 0, 0.5f}, 1e-4f), options(0)), 0.5 * 0.25, 0.005,
                    1e-4);
}

}  // namespace
}  // namespace conebook
