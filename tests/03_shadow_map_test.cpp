// Chapter 03: shadows against exact geometry in double precision. A box stands on a floor; whether a point of the floor
// is lit follows from one ray against one box. Acne: lit points that the map calls shadowed; leak (peter-panning):
// shadowed points further than 1.5 texels inside the shadow's edge that it calls lit (hard-cases.md, "Light").
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "02_g_buffer/direct_lighting.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "03_shadow_map/shadow_maps.hpp"
#include "scene_builder.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

constexpr double kPiD = 3.14159265358979323846;
constexpr int kMapSize = 512;       // texels
constexpr glm::ivec2 kPicture(192, 192);
constexpr double kLeakTexels = 1.5;
constexpr double kAcneShare = 0.001;

const glm::vec3 kBoxLow(-0.5f, 0.0f, -0.3f), kBoxHigh(0.5f, 0.8f, 0.3f);

ShadowMapParams map_params(bool receiver_plane = true)
{
    ShadowMapParams params;
    params.shadow_map_size = kMapSize;
    params.shadow_receiver_plane = receiver_plane;
    return params;
}

// Share of the light that arrives at each pixel, -1 where nothing is or the light gives nothing; and positions.
struct Shaded {
    ImageF visibility, position, normal;
};
Shaded shade(const Scene& scene, const Camera& camera, const ShadowMapParams& params)
{
    gl::Shaders& shaders = test_gl().shaders;
    const GpuScene gpu_scene(scene);
    GBuffer g_buffer(shaders, kPicture);
    g_buffer.draw(gpu_scene, camera_data(camera, kPicture, scene.bounds));
    ShadowMaps maps(shaders, gpu_scene, params);
    maps.draw(gpu_scene);
    DirectLightingPass with(shaders, Shadows::maps), without(shaders, Shadows::none);
    maps.bind(with.program());
    const ImageF shadowed = read_picture(with.run(g_buffer, gpu_scene, LightingOutput::direct));
    const ImageF open = read_picture(without.run(g_buffer, gpu_scene, LightingOutput::direct));
    GBufferViewPass views(shaders);
    Shaded result{open, read_picture(*views.run(g_buffer, "position")), {}};
    result.normal = read_picture(*views.run(g_buffer, "geometric_normal"));
    for (std::size_t i = 0; i < open.pixels.size(); ++i)
        result.visibility.pixels[i].r =
            open.pixels[i].r > 0.0f ? shadowed.pixels[i].r / open.pixels[i].r : -1.0f;
    return result;
}

// Does something stand between p and p + s? The open box (slabs), or the floor, when p lies below it.
bool is_blocked(glm::dvec3 p, glm::dvec3 s)
{
    if (p.y < -1e-9) return true;
    double enter = 0.0, leave = 1.0;
    for (int a = 0; a < 3; ++a) {
        if (std::abs(s[a]) < 1e-15) {
            if (p[a] <= kBoxLow[a] || p[a] >= kBoxHigh[a]) return false;
            continue;
        }
        double t0 = (double(kBoxLow[a]) - p[a]) / s[a], t1 = (double(kBoxHigh[a]) - p[a]) / s[a];
        if (t0 > t1) std::swap(t0, t1);
        enter = std::max(enter, t0);
        leave = std::min(leave, t1);
    }
    return enter < leave - 1e-12;
}

// A point of the surface: which coordinate its plane fixes, and the exact value of it (the g-buffer's is rounded).
struct SurfacePoint {
    glm::dvec3 position;
    int axis;
};
SurfacePoint on_surface(glm::dvec3 position, glm::vec3 encoded_normal)
{
    const glm::vec3 n = 2.0f * encoded_normal - 1.0f, a = glm::abs(n);
    const int axis = a.x > a.y && a.x > a.z ? 0 : a.y > a.z ? 1 : 2;
    const bool floor = axis == 1 && position.y < 0.4;
    position[axis] = floor ? 0.0 : n[axis] > 0.0f ? double(kBoxHigh[axis]) : double(kBoxLow[axis]);
    return {position, axis};
}

glm::dvec3 to_light(const Light& light, glm::dvec3 p)
{
    return light.type == LightType::directional ? -100.0 * glm::dvec3(light.direction) : glm::dvec3(light.position) - p;
}

// The point of the same plane that is (du, dv) texels away in the light's map.
glm::dvec3 neighbour(const glm::dmat4& clip_from_scene, const glm::dmat4& scene_from_clip, const SurfacePoint& p,
                     double du, double dv)
{
    const glm::dvec4 clip = clip_from_scene * glm::dvec4(p.position, 1.0);
    const auto unproject = [&](double depth) {
        const glm::dvec4 q = scene_from_clip * glm::dvec4(clip.x / clip.w + 2.0 * du / kMapSize,
                                                  clip.y / clip.w + 2.0 * dv / kMapSize, depth, 1.0);
        return glm::dvec3(q) / q.w;
    };
    const glm::dvec3 a = unproject(0.9), b = unproject(0.1);
    glm::dvec3 q = a + (b - a) * ((p.position[p.axis] - a[p.axis]) / (b[p.axis] - a[p.axis]));
    q[p.axis] = p.position[p.axis];
    return q;
}

// Is the light's answer the same everywhere within that many texels?
bool is_certain(const glm::dmat4& map, const Light& light, const SurfacePoint& p, bool lit, double texels)
{
    const glm::dmat4 inverse = glm::inverse(map);
    for (int k = 0; k < 16; ++k) {
        const double phi = 2.0 * kPiD * k / 16;
        const glm::dvec3 q = neighbour(map, inverse, p, texels * std::cos(phi), texels * std::sin(phi));
        if (lit == is_blocked(q, to_light(light, q))) return false;
    }
    return true;
}

const glm::mat4& map_of(const std::vector<glm::mat4>& maps, const Light& light, glm::dvec3 p)
{
    if (maps.size() == 1) return maps[0];
    const glm::dvec3 d = p - glm::dvec3(light.position), a = glm::abs(d);
    const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return maps[std::size_t(2 * axis + (d[axis] < 0.0 ? 1 : 0))];
}

struct Faults {
    int lit = 0, shadowed = 0;        // pixels whose answer is certain: the same 1.5 texels around
    int acne = 0, leaks = 0, edge = 0;
    double acne_share() const { return lit > 0 ? double(acne) / lit : 0.0; }
};

// Compares every pixel of floor and box with the geometry. `acne` counts lit pixels that lose more than 1 % of the
// light, `leaks` shadowed ones that get more than half of it.
Faults compare_with_geometry(const Scene& scene, const Shaded& shaded, int light_index = 0)
{
    const Light& light = scene.lights[std::size_t(light_index)];
    const std::vector<glm::mat4> maps = shadow_matrices(light, scene.bounds, kMapSize);
    Faults faults;
    for (std::size_t i = 0; i < shaded.visibility.pixels.size(); ++i) {
        const float visibility = shaded.visibility.pixels[i].r;
        if (visibility < 0.0f) continue;
        EXPECT_TRUE(std::isfinite(visibility));
        const SurfacePoint p = on_surface(glm::dvec3(shaded.position.pixels[i]), glm::vec3(shaded.normal.pixels[i]));
        const bool lit = !is_blocked(p.position, to_light(light, p.position));
        const glm::dmat4 map(map_of(maps, light, p.position));
        // The corners of the filter reach sqrt(2) times as far as its sides. Half of it as well: a thin shadow may fit
        // between centre and circle.
        const double reach = std::sqrt(2.0) * kLeakTexels;
        if (!is_certain(map, light, p, lit, reach) || !is_certain(map, light, p, lit, 0.5 * reach)) {
            ++faults.edge;
            continue;
        }
        ++(lit ? faults.lit : faults.shadowed);
        if (lit && visibility < 0.99f) ++faults.acne;
        if (!lit && visibility > 0.5f) ++faults.leaks;
    }
    return faults;
}

SceneBuilder box_on_floor(float floor_half = 2.0f)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-floor_half, 0, floor_half}, {2 * floor_half, 0, 0}, {0, 0, -2 * floor_half}, grey);
    b.box(kBoxLow, kBoxHigh, grey);
    return b;
}

// Seen steeply, so that floor and top fill the picture, and from the light's side, so that lit walls are in it.
std::array<Camera, 2> cameras(const glm::vec3& towards_light)
{
    const glm::vec3 side = glm::normalize(glm::vec3(towards_light.x, 0.0f, towards_light.z) + glm::vec3(1e-4f, 0, 0));
    return {look_at({0.3f, 4.5f, 0.2f}, {0, 0, 0}, 0.9f), look_at(3.0f * side + glm::vec3(0, 1.2f, 0), {0, 0.3f, 0}, 0.7f)};
}

void expect_clean(const Scene& scene, const glm::vec3& towards_light, int least_shadowed, const std::string& what)
{
    int shadowed = 0;
    for (const Camera& camera : cameras(towards_light)) {
        const Faults f = compare_with_geometry(scene, shade(scene, camera, map_params()));
        EXPECT_GT(f.lit, 1000) << what;
        EXPECT_LT(f.acne_share(), kAcneShare) << what << ": " << f.acne << " of " << f.lit;
        EXPECT_EQ(f.leaks, 0) << what << ": of " << f.shadowed;
        shadowed += f.shadowed;
    }
    EXPECT_GE(shadowed, least_shadowed) << what;
}

class LightAngle : public testing::TestWithParam<int> {};

glm::vec3 direction_to_light(double theta_deg, double azimuth_deg)
{
    const double t = theta_deg * kPiD / 180.0, a = azimuth_deg * kPiD / 180.0;
    return {std::sin(t) * std::cos(a), std::cos(t), std::sin(t) * std::sin(a)};
}

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
        const glm::mat4 map = shadow_matrices(scene.lights[0], scene.bounds, kMapSize)[0];
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
    EXPECT_EQ(shadow_matrices(scene.lights[0], scene.bounds, kMapSize).size(), 6u);
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
    const ShadowMaps maps(test_gl().shaders, gpu_scene, map_params());
    EXPECT_EQ(maps.layers(), 0 + 1 + 1 + 6);
    // One colour a light: the picture of all of them is the sum of the pictures of one each.
    GBuffer g_buffer(test_gl().shaders, kPicture);
    const auto direct = [&](const Scene& s) {
        const GpuScene gpu(s);
        g_buffer.draw(gpu, camera_data(cameras({1, 1, 1})[0], kPicture, s.bounds));
        ShadowMaps own(test_gl().shaders, gpu, map_params());
        own.draw(gpu);
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
    const ShadowMaps maps(test_gl().shaders, gpu_scene, params);
    EXPECT_EQ(maps.layers(), 360);
    EXPECT_EQ(maps.size(), 512);
    EXPECT_LE(maps.depth().bytes(), std::size_t(1) << 30);
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
