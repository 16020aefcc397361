// A box on a floor, and whether each pixel of a picture of it has the shadow that a ray in double precision says. Acne: lit
// points that the map calls shadowed; leak (peter-panning): shadowed points further than 1.5 texels inside the shadow's
// edge that it calls lit (hard-cases.md, "Light"). Header only.
#pragma once

#include <array>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "02_g_buffer/direct_lighting.hpp"
#include "02_g_buffer/g_buffer_view.hpp"
#include "03_shadow_map/shadow_maps.hpp"
#include "scene_builder.hpp"
#include "test_gl.hpp"

namespace conebook {

constexpr double kPiD = 3.14159265358979323846;
constexpr int kMapSize = 512;       // texels
constexpr glm::ivec2 kPicture(192, 192);
constexpr double kLeakTexels = 1.5;
constexpr double kAcneShare = 0.001;

inline const glm::vec3 kBoxLow(-0.5f, 0.0f, -0.3f), kBoxHigh(0.5f, 0.8f, 0.3f);

inline ShadowMapParams map_params(bool receiver_plane = true)
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
inline Shaded shade(const Scene& scene, const Camera& camera, const ShadowMapParams& params)
{
    gl::Shaders& shaders = test_gl().shaders;
    const GpuScene gpu_scene(scene);
    GBuffer g_buffer(shaders, kPicture);
    g_buffer.draw(gpu_scene, camera_data(camera, kPicture, scene.bounds));
    ShadowMaps maps(shaders);
    maps.draw(gpu_scene, params);
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
inline bool is_blocked(glm::dvec3 p, glm::dvec3 s)
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
inline SurfacePoint on_surface(glm::dvec3 position, glm::vec3 encoded_normal)
{
    const glm::vec3 n = 2.0f * encoded_normal - 1.0f, a = glm::abs(n);
    const int axis = a.x > a.y && a.x > a.z ? 0 : a.y > a.z ? 1 : 2;
    const bool floor = axis == 1 && position.y < 0.4;
    position[axis] = floor ? 0.0 : n[axis] > 0.0f ? double(kBoxHigh[axis]) : double(kBoxLow[axis]);
    return {position, axis};
}

inline glm::dvec3 to_light(const Light& light, glm::dvec3 p)
{
    return light.type == LightType::directional ? -100.0 * glm::dvec3(light.direction) : glm::dvec3(light.position) - p;
}

// The point of the same plane that is (du, dv) texels away in the light's map.
inline glm::dvec3 neighbour(const glm::dmat4& clip_from_scene, const glm::dmat4& scene_from_clip, const SurfacePoint& p,
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
inline bool is_certain(const glm::dmat4& map, const Light& light, const SurfacePoint& p, bool lit, double texels)
{
    const glm::dmat4 inverse = glm::inverse(map);
    for (int k = 0; k < 16; ++k) {
        const double phi = 2.0 * kPiD * k / 16;
        const glm::dvec3 q = neighbour(map, inverse, p, texels * std::cos(phi), texels * std::sin(phi));
        if (lit == is_blocked(q, to_light(light, q))) return false;
    }
    return true;
}

inline const glm::mat4& map_of(const std::vector<glm::mat4>& maps, const Light& light, glm::dvec3 p)
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

inline std::vector<glm::mat4> maps_of(const Scene& scene, const Light& light)
{
    const std::vector<Triangle> triangles = GpuScene(scene).triangles();
    return shadow_matrices(light, scene.bounds, &triangles, kMapSize);
}

// Compares every pixel of floor and box with the geometry. `acne` counts lit pixels that lose more than 1 % of the
// light, `leaks` shadowed ones that get more than half of it.
inline Faults compare_with_geometry(const Scene& scene, const Shaded& shaded, int light_index = 0)
{
    const Light& light = scene.lights[std::size_t(light_index)];
    const std::vector<glm::mat4> maps = maps_of(scene, light);
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

inline SceneBuilder box_on_floor(float floor_half = 2.0f)
{
    SceneBuilder b;
    const int grey = b.material(lambert(0.5f));
    b.quad({-floor_half, 0, floor_half}, {2 * floor_half, 0, 0}, {0, 0, -2 * floor_half}, grey);
    b.box(kBoxLow, kBoxHigh, grey);
    return b;
}

// Seen steeply, so that floor and top fill the picture, and from the light's side, so that lit walls are in it.
inline std::array<Camera, 2> cameras(const glm::vec3& towards_light)
{
    const glm::vec3 side = glm::normalize(glm::vec3(towards_light.x, 0.0f, towards_light.z) + glm::vec3(1e-4f, 0, 0));
    return {look_at({0.3f, 4.5f, 0.2f}, {0, 0, 0}, 0.9f), look_at(3.0f * side + glm::vec3(0, 1.2f, 0), {0, 0.3f, 0}, 0.7f)};
}

inline void expect_clean(const Scene& scene, const glm::vec3& towards_light, int least_shadowed, const std::string& what)
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

inline glm::vec3 direction_to_light(double theta_deg, double azimuth_deg)
{
    const double t = theta_deg * kPiD / 180.0, a = azimuth_deg * kPiD / 180.0;
    return {std::sin(t) * std::cos(a), std::cos(t), std::sin(t) * std::sin(a)};
}

}  // namespace conebook
