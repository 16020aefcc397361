// Chapter 02: what the g-buffer gives back against what was put in, positions against rays in double precision, and
// the deferred picture against the forward one.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "01_first_light/forward_pass.hpp"
#include "01_first_light/tone_map.hpp"
#include "02_g_buffer/direct_lighting.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "scene_builder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

// A g-buffer with a scene in it.
class Deferred {
public:
    Deferred(const Scene& scene, const Camera& camera, glm::ivec2 size)
        : g_buffer_(test_gl().shaders, size), scene_(scene), view_(test_gl().shaders)
    {
        g_buffer_.draw(scene_, camera_data(camera, size, scene.bounds));
    }
    ImageF view(const std::string& name) { return read_picture(*view_.run(g_buffer_, name)); }
    const GBuffer& g_buffer() const { return g_buffer_; }
    const GpuScene& scene() const { return scene_; }

private:
    GBuffer g_buffer_;
    GpuScene scene_;
    GBufferViewPass view_;
};

// The ray through the centre of a pixel (row 0 on top), in double precision and from the camera alone.
struct Ray {
    glm::dvec3 origin, direction;
};
Ray pixel_ray(const Camera& camera, glm::ivec2 size, int x, int y)
{
    const double ndc_x = 2.0 * (x + 0.5) / size.x - 1.0, ndc_y = 1.0 - 2.0 * (y + 0.5) / size.y;
    const glm::dmat4 world_from_camera(camera.world_from_camera);
    if (camera.orthographic)
        return {glm::dvec3(world_from_camera * glm::dvec4(ndc_x * camera.x_mag, ndc_y * camera.y_mag, 0, 1)),
                glm::dvec3(world_from_camera * glm::dvec4(0, 0, -1, 0))};
    const double tangent = std::tan(0.5 * double(camera.y_fov)), aspect = double(size.x) / size.y;
    return {glm::dvec3(world_from_camera[3]),
            glm::dvec3(world_from_camera * glm::dvec4(ndc_x * tangent * aspect, ndc_y * tangent, -1, 0))};
}

// What the position may be off by. A rasterizer snaps vertices to a grid of subpixels (8 bits on llvmpipe and on GPUs)
// and takes the depth of the snapped triangle: 1/256 of a pixel, on the plane. And floats: 6e-8 of the coordinates,
// 16 roundings for the depth, the inverse projection and the rotation.
double position_tolerance_m(double pixel_m, double coordinate_m) { return pixel_m / 256.0 + 1.0e-6 * coordinate_m; }

// A square plane of 2 * extent m is all that is in the scene: however far away the camera is, coordinates are no larger.
void expect_positions(const Camera& camera, glm::dvec3 plane_point, glm::dvec3 plane_normal, float extent)
{
    const glm::vec3 n(plane_normal), p(plane_point);
    const glm::vec3 u = glm::normalize(std::abs(n.x) < 0.9f ? glm::cross(n, glm::vec3(1, 0, 0))
                                                            : glm::cross(n, glm::vec3(0, 1, 0)));
    const glm::vec3 v = glm::cross(n, u);
    const double distance = glm::length(plane_point - glm::dvec3(camera.world_from_camera[3]));
    SceneBuilder b;
    Material m = lambert(0.5f);
    m.double_sided = true;
    b.quad(p - extent * (u + v), 2.0f * extent * u, 2.0f * extent * v, b.material(m));
    const glm::ivec2 size(48, 32);
    Deferred deferred(b.build(), camera, size);
    const ImageF positions = deferred.view("position"), depths = deferred.view("depth");
    double worst = 0.0;  // of the tolerance
    int compared = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const Ray ray = pixel_ray(camera, size, x, y);
            const double cosine = glm::dot(ray.direction, plane_normal);
            const double t = glm::dot(plane_point - ray.origin, plane_normal) / cosine;
            // Where the plane is seen at less than 6 degrees, a hair of the ray's direction is metres on the plane.
            if (t <= 0.0 || std::abs(cosine) / glm::length(ray.direction) < 0.1) continue;
            const glm::dvec3 truth = ray.origin + t * ray.direction;
            const double sine_to_plane = std::abs(cosine) / glm::length(ray.direction);
            const double pixel_m = camera.orthographic
                                       ? 2.0 * camera.y_mag / size.y
                                       : 2.0 * std::tan(0.5 * double(camera.y_fov)) / size.y * t;
            const double coordinate_m = std::min(glm::length(t * ray.direction) + glm::length(ray.origin),
                                                 2.0 * std::sqrt(2.0) * extent + glm::length(plane_point));
            const double scale = position_tolerance_m(pixel_m, coordinate_m) / sine_to_plane;
            if (glm::length(truth - plane_point) > 0.95 * extent) continue;  // beyond the quad
            ASSERT_EQ(positions.at(x, y).a, 1.0f);
            worst = std::max(worst, glm::length(glm::dvec3(positions.at(x, y)) - truth) / scale);
            const glm::dvec3 axis = -glm::dvec3(camera.world_from_camera[2]);
            const double depth = glm::dot(truth - ray.origin, axis);
            worst = std::max(worst, std::abs(depths.at(x, y).r - depth) / (scale + 1.0e-6 * depth));
            ++compared;
        }
    EXPECT_GT(compared, 200);
    EXPECT_LT(worst, 1.0) << "at " << distance << " m, extent " << extent << " m";
}

TEST(GBuffer, PositionFromDepthPerspective)
{
    for (const double distance : {0.01, 0.1, 1.0, 30.0, 1000.0, 1.0e5})  // the near plane is at 1 mm
        for (const glm::dvec3 normal : {glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(0.6, 0.3, 0.5)),
                                        glm::normalize(glm::dvec3(-0.2, 0.9, 0.3))}) {
            const glm::vec3 eye(0.2f, 0.1f, 0.3f);
            const glm::vec3 forward = glm::normalize(glm::vec3(0.1f, -0.2f, -1.0f));
            expect_positions(look_at(eye, eye + forward, 0.9f), glm::dvec3(eye) + distance * glm::dvec3(forward), normal,
                             float(5.0 * distance));
        }
}

// A telescope: the plane fills the picture and more, and the error is to be small against it, not against the distance.
TEST(GBuffer, PositionFromDepthFarAway)
{
    for (const double distance : {30.0, 1.0e3, 1.0e5, 1.0e7})
        for (const float size : {0.02f, 2.0f, 300.0f})
            for (const glm::vec3 towards_eye : {glm::vec3(0, 0, 1), glm::normalize(glm::vec3(0.2f, 0.5f, 1.0f))}) {
                // The axes of a camera are floats, and so it may look past a small thing far away; not along z.
                if (distance < 3.0 * size || (towards_eye.x > 0.0f && distance > 1.0e6 * size)) continue;
                for (const double zoom : {1.0, 1.0e4}) {  // until pixels are no larger than the error of a float
                    Camera camera = look_at(float(distance) * towards_eye, {0, 0, 0}, float(0.8 * size / distance / zoom));
                    expect_positions(camera, glm::dvec3(0.0), glm::normalize(glm::dvec3(0.3, 0.4, 1.0)), 0.5f * size);
                    camera.z_near = 10.0f;
                    camera.z_far = float(2.0 * distance);
                    expect_positions(camera, glm::dvec3(0.0), glm::normalize(glm::dvec3(-0.8, 0.1, 0.5)), 0.5f * size);
                }
            }
}

TEST(GBuffer, PositionFromDepthOrthographic)
{
    for (const glm::dvec3 normal : {glm::dvec3(0, 0, 1), glm::normalize(glm::dvec3(0.6, 0.3, 0.5))})
        for (const float z_far : {0.0f, 20.0f, 8.0e3f, 1.0e7f})
            for (const float distance : {3.0f, 1.0e3f, 1.0e6f}) {
                if (z_far > 0.0f && z_far < 2.0f * distance) continue;
                Camera camera = look_at_orthographic(distance * glm::normalize(glm::vec3(0.2f, 0.1f, 1.0f)), {0, 0, 0}, 1.5f, 1);
                camera.z_near = 0.0f;
                camera.z_far = z_far;
                expect_positions(camera, {0.15, 0.2, 0.0}, normal, 3.0f);
            }
}

// glTF 2.0, 3.10.2: what is nearer than znear or beyond zfar is not seen; a perspective without zfar has no end.
TEST(GBuffer, NearAndFarPlanesClip)
{
    constexpr glm::ivec2 kSize(20, 4);
    for (const bool orthographic : {false, true})
        for (const float metres_per_unit : {1e-3f, 1.0f, 5e4f}) {
            // Nine walls at 1, 2 ... 9 units, each a tenth of the picture wide and beside the one before.
            SceneBuilder b;
            const int grey = b.material(lambert(0.5f));
            const float u = metres_per_unit;
            const glm::vec3 axis = glm::normalize(glm::vec3(0.3f, -0.4f, -1.0f));
            Camera camera = orthographic ? look_at_orthographic(glm::vec3(0.0f), axis, u, u) : look_at(glm::vec3(0.0f), axis, 0.9f);
            const glm::vec3 right(camera.world_from_camera[0]), up(camera.world_from_camera[1]);
            const float tangent = std::tan(0.45f), aspect = float(kSize.x) / float(kSize.y);
            for (int wall = 1; wall <= 9; ++wall) {
                const float half = orthographic ? u : float(wall) * u * tangent, width = orthographic ? u : half * aspect;
                const glm::vec3 left = float(wall) * u * axis + (float(wall - 1) / 5.0f - 1.0f) * width * right - half * up;
                b.quad(left, width / 5.0f * right, 2.0f * half * up, grey);
            }
            const Scene scene = b.build();
            for (const auto& [z_near, z_far] : {std::pair(0.5f, 0.0f), {0.5f, 4.5f}, {2.5f, 0.0f}, {3.5f, 7.25f}, {9.5f, 12.0f}, {0.2f, 0.4f}}) {
                camera.z_near = z_near * u;
                camera.z_far = z_far * u;
                Deferred deferred(scene, camera, kSize);
                ForwardPass forward(test_gl().shaders);
                const ImageF depths = deferred.view("depth"),
                             drawn = read_picture(forward.run(deferred.scene(), camera_data(camera, kSize, scene.bounds),
                                                              kSize, ForwardOutput::depth));
                for (int wall = 1; wall <= 9; ++wall) {
                    const bool seen = float(wall) > z_near && (z_far == 0.0f || float(wall) < z_far);
                    EXPECT_EQ(depths.at(2 * wall - 1, 2).a, seen ? 1.0f : 0.0f) << wall << " in " << z_near << ", " << z_far;
                    EXPECT_EQ(drawn.at(2 * wall - 1, 2).a, seen ? 1.0f : 0.0f) << wall << " in " << z_near << ", " << z_far;
                    EXPECT_NEAR(depths.at(2 * wall - 1, 2).r, seen ? float(wall) * u : 0.0f, 1e-5f * u);
                }
            }
        }
}

// Half a step h = 0.5 / 32767 in both numbers moves the point of the octahedron by (h, h, -2h), sqrt(6) h, and in the
// middle of a face, 1/sqrt(3) from the origin, that is an angle of sqrt(18) h.
TEST(GBuffer, NormalsAreKeptTo16Bits)
{
    const int n = 40;
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) b.quad({i, j, 0}, {1, 0, 0}, {0, 1, 0}, grey);
    Scene scene = b.build();
    std::mt19937 random(1);
    std::normal_distribution<float> gauss;
    std::vector<glm::vec3> normals;
    for (int k = 0; k < n * n; ++k) {
        glm::vec3 normal = glm::normalize(glm::vec3(gauss(random), gauss(random), gauss(random)));
        if (k < 27) {  // axes, edges and corners, where the octahedron is folded
            const glm::vec3 corner(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
            if (corner != glm::vec3(0.0f)) normal = glm::normalize(corner);
        }
        normals.push_back(normal);
        for (int v = 0; v < 4; ++v) scene.vertices[std::size_t(4 * k + v)].normal = normal;
    }
    const float half = 0.5f * n;
    Deferred deferred(scene, look_at_orthographic({half, half, 5}, {half, half, 0}, half, half), {n, n});
    const ImageF shown = deferred.view("normal");
    double worst_rad = 0.0;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const glm::dvec3 read = 2.0 * glm::dvec3(shown.at(i, n - 1 - j)) - 1.0;
            const glm::dvec3 truth(normals[std::size_t(j * n + i)]);
            worst_rad = std::max(worst_rad, glm::length(glm::cross(truth, read)));
            ASSERT_GT(glm::dot(truth, read), 0.0);
        }
    EXPECT_LT(worst_rad, std::sqrt(18.0) * 0.5 / 32767.0 + 3e-7);
}

TEST(GBuffer, MaterialsComeBackWithinTheirFormats)
{
    std::mt19937 random(2);
    std::uniform_real_distribution<float> uniform;
    for (int k = 0; k < 20; ++k) {
        Material m;
        m.base_color = {uniform(random), uniform(random), uniform(random), 1.0f};
        m.metallic = uniform(random);
        m.roughness = 0.03f + 0.97f * uniform(random);
        m.specular = uniform(random);
        m.specular_color = {uniform(random), uniform(random), uniform(random)};
        m.emission = glm::vec3(std::pow(10.0f, 10.0f * uniform(random) - 3.0f), 1.0f, 0.0f);  // 1e-3 .. 1e7
        SceneBuilder b;
        b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, b.material(m));
        Deferred deferred(b.build(), look_at({0, 0, 1}, {0, 0, 0}, 0.8f), {4, 4});
        const auto value = [&](const char* view) { return deferred.view(view).at(2, 2); };
        const double step = 0.5 / 65535.0 + 1e-6;  // RGBA16
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(value("base_color")[c], m.base_color[c], step);
            const double f0 = glm::mix(std::min(0.04 * double(m.specular_color[c]), 1.0) * m.specular,
                                       double(m.base_color[c]), double(m.metallic));
            EXPECT_NEAR(value("f0")[c], f0, step);
            EXPECT_NEAR(value("emission")[c], m.emission[c], 1e-6 * double(m.emission[c]));
        }
        EXPECT_NEAR(value("metallic").r, m.metallic, step);
        EXPECT_NEAR(value("f90").r, glm::mix(m.specular, 1.0f, m.metallic), step);
        EXPECT_NEAR(value("roughness").r, m.roughness, 1e-6);
    }
}

TEST(GBuffer, NormalsFaceTheSideThatIsSeen)
{
    Material m = lambert(0.5f);
    m.double_sided = true;
    SceneBuilder b;
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, b.material(m));
    Scene scene = b.build();
    const glm::vec3 shading = glm::normalize(glm::vec3(0.3f, 0.1f, 1.0f));
    for (Vertex& v : scene.vertices) v.normal = shading;
    for (const float side : {1.0f, -1.0f}) {
        Deferred deferred(scene, look_at({0.1f, 0.2f, side}, {0, 0, 0}, 0.8f), {8, 8});
        const glm::vec3 normal = 2.0f * glm::vec3(deferred.view("normal").at(4, 4)) - 1.0f;
        const glm::vec3 geometric = 2.0f * glm::vec3(deferred.view("geometric_normal").at(4, 4)) - 1.0f;
        EXPECT_NEAR(glm::dot(normal, side * shading), 1.0f, 1e-6f);
        EXPECT_NEAR(geometric.z, side, 1e-6f);
    }
}

TEST(GBuffer, NothingWhereNothingIs)
{
    SceneBuilder b;
    b.quad({-0.1f, -0.1f, 0}, {0.2f, 0, 0}, {0, 0.2f, 0}, b.material(emitter(3.0f, 0.5f)));
    b.directional_light({0, 0, -1}, glm::vec3(2.0f));
    Deferred deferred(b.build(), look_at({0, 0, 1}, {0, 0, 0}, 0.8f), {32, 32});
    DirectLightingPass lighting(test_gl().shaders, Shadows::none);
    const ImageF image =
        read_picture(lighting.run(deferred.g_buffer(), deferred.scene(), LightingOutput::direct_and_emission));
    EXPECT_EQ(image.at(0, 0), glm::vec4(0.0f));
    EXPECT_EQ(image.at(16, 16).a, 1.0f);
    EXPECT_NEAR(image.at(16, 16).r, 3.0 + 0.5 / 3.14159265 * 2.0, 1e-3);  // emission has 11 bits
}

TEST(GBuffer, AlphaMaskIsCutOut)
{
    SceneBuilder b;
    Material m = lambert(0.5f);
    m.alpha_mode = AlphaMode::mask;
    m.base_color_texture.image = b.image(2, 1, {255, 255, 255, 255, 255, 255, 255, 0});
    m.base_color_texture.mag_filter = m.base_color_texture.min_filter = Filter::nearest;
    m.base_color_texture.mipmapped = false;
    b.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, b.material(m));
    Deferred deferred(b.build(), look_at_orthographic({0, 0, 1}, {0, 0, 0}, 1, 1), {16, 16});
    const ImageF image = deferred.view("base_color");
    for (int y = 0; y < 16; ++y)
        for (int x = 0; x < 16; ++x) EXPECT_EQ(image.at(x, y).a, x < 8 ? 1.0f : 0.0f) << x << " " << y;
}

std::vector<std::uint8_t> shown(const gl::Texture& linear)
{
    ToneMapPass pass(test_gl().shaders);
    const gl::Texture& display = pass.run(linear, Encoding::radiance, {});
    std::vector<std::uint8_t> bytes(std::size_t(4 * display.size().x * display.size().y));
    glGetTextureImage(display.id(), 0, GL_RGBA, GL_UNSIGNED_BYTE, GLsizei(bytes.size()), bytes.data());
    return bytes;
}

class SamePicture : public testing::TestWithParam<const char*> {};

TEST_P(SamePicture, AsForward)
{
    const Scene scene = load_scene(TestGl::root() + "/assets/" + GetParam() + ".glb");
    const Camera camera = choose_camera(scene, {});
    const glm::ivec2 size(256, 192);
    Deferred deferred(scene, camera, size);
    DirectLightingPass lighting(test_gl().shaders, Shadows::none);
    ForwardPass forward(test_gl().shaders);
    const auto a = shown(forward.run(deferred.scene(), camera_data(camera, size, scene.bounds), size, ForwardOutput::radiance));
    const auto b = shown(lighting.run(deferred.g_buffer(), deferred.scene(), LightingOutput::direct_and_emission));
    int largest = 0, lit = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        largest = std::max(largest, std::abs(int(a[i]) - int(b[i])));
        lit += i % 4 < 3 && a[i] > 20 ? 1 : 0;
    }
    EXPECT_GT(lit, 1000);
    EXPECT_LE(largest, 1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SamePicture,
                         testing::Values("cornell_box", "lights", "colonnade", "materials", "glossy_room",
                                         "emissive_shapes"),
                         [](const auto& info) { return std::string(info.param); });

TEST(GBuffer, NoOpenGlFaults) { EXPECT_EQ(test_gl().log.faults(), std::vector<std::string>{}); }

}  // namespace
}  // namespace conebook
