#include "reference/shared_light.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <thread>

namespace conebook {

namespace {

constexpr int kReach = 6;  // pixels to each side: weights 7, 6 ... 1, so the tent is 14 pixels wide at its foot
constexpr float kMinCosine = 0.9f;  // as in shaders/08_diffuse_cones/points.glsl

void for_each_row(int rows, int threads, const std::function<void(int)>& work)
{
    std::atomic<int> next{0};
    std::vector<std::jthread> workers;
    const int count = threads > 0 ? threads : int(std::max(1u, std::thread::hardware_concurrency()));
    for (int t = 0; t < count; ++t)
        workers.emplace_back([&] {
            for (int y; (y = next++) < rows;) work(y);
        });
}

// One number of every pixel; loops over rows of them are what compilers turn into vector instructions.
using Plane = std::vector<float>;

// Position, geometric and shading normal. Where nothing is seen the normals are 0, which are like no other.
using Surfaces = std::array<Plane, 9>;
using LightAndAlbedo = std::array<Plane, 6>;

// One direction of the tent: the means of light and albedo over what lies on the surface of each pixel.
LightAndAlbedo tent(const LightAndAlbedo& in, const Surfaces& s, int width, int height, glm::ivec2 along,
                    float plane_tolerance, int threads)
{
    LightAndAlbedo out;
    for (Plane& plane : out) plane.assign(in[0].size(), 0.0f);
    for_each_row(height, threads, [&](int y) {
        Plane weights(std::size_t(width), 0.0f), row_weights(std::size_t(width), 0.0f);
        const auto row = std::ptrdiff_t(y) * width;
        for (int i = -kReach; i <= kReach; ++i) {
            if (y + i * along.y < 0 || y + i * along.y >= height) continue;
            const auto step = std::ptrdiff_t(i) * (along.x + along.y * width);
            const int first = std::max(0, -i * along.x), last = std::min(width, width - i * along.x);
            const float tent_weight = float(kReach + 1 - std::abs(i));
            const auto here = [&](int k) { return s[std::size_t(k)].data() + row; };
            const auto there = [&](int k) { return s[std::size_t(k)].data() + row + step; };
            const float *x = here(0), *y0 = here(1), *z = here(2), *gx = here(3), *gy = here(4), *gz = here(5);
            const float *nx = here(6), *ny = here(7), *nz = here(8), *ox = there(0), *oy = there(1), *oz = there(2);
            const float *mx = there(6), *my = there(7), *mz = there(8);
            for (int p = first; p < last; ++p) {
                const float off_plane = (ox[p] - x[p]) * gx[p] + (oy[p] - y0[p]) * gy[p] + (oz[p] - z[p]) * gz[p];
                const float cosine = mx[p] * nx[p] + my[p] * ny[p] + mz[p] * nz[p];
                const bool same = (std::abs(off_plane) < plane_tolerance) & (cosine > kMinCosine);
                weights[std::size_t(p)] = same ? tent_weight : 0.0f;
                row_weights[std::size_t(p)] += weights[std::size_t(p)];
            }
            for (std::size_t k = 0; k < in.size(); ++k) {
                float* sum = out[k].data() + row;
                const float* value = in[k].data() + row + step;
                for (int p = first; p < last; ++p) sum[p] += weights[std::size_t(p)] * value[p];
            }
        }
        for (Plane& plane : out)
            for (int p = 0; p < width; ++p)
                plane[std::size_t(row + p)] /= std::max(row_weights[std::size_t(p)], 1e-20f);
    });
    return out;
}

}  // namespace

std::vector<VisibleSurface> visible_surfaces(const SceneTracer& tracer, const Camera& camera, int width, int height,
                                             int threads)
{
    std::vector<VisibleSurface> surfaces(std::size_t(width) * std::size_t(height));
    const DepthRange depths = visible_depths(camera, tracer.scene().bounds);
    for_each_row(height, threads, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const auto hit =
                tracer.intersect_camera(camera_ray(camera, depths, float(x) + 0.5f, float(y) + 0.5f, width, height));
            if (hit)
                surfaces[std::size_t(y) * std::size_t(width) + std::size_t(x)] = {
                    true, hit->position, hit->geometric_normal, hit->shading_normal, hit->brdf.rho};
        }
    });
    return surfaces;
}

ImageF share_indirect_diffuse(const ImageF& indirect_diffuse, const std::vector<VisibleSurface>& surfaces,
                              float plane_tolerance, int threads)
{
    if (surfaces.size() != indirect_diffuse.pixels.size())
        throw std::logic_error("share_indirect_diffuse: another number of surfaces than of pixels");
    const int width = indirect_diffuse.width, height = indirect_diffuse.height;
    const std::size_t pixels = surfaces.size();
    Surfaces planes;
    LightAndAlbedo values;
    for (Plane& plane : planes) plane.resize(pixels);
    for (Plane& plane : values) plane.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) {
        const VisibleSurface& s = surfaces[i];
        const glm::vec3 parts[] = {s.position, s.covered ? s.geometric_normal : glm::vec3(0.0f),
                                   s.covered ? s.shading_normal : glm::vec3(0.0f)};
        for (int c = 0; c < 3; ++c) {
            for (int part = 0; part < 3; ++part) planes[std::size_t(3 * part + c)][i] = parts[part][c];
            values[std::size_t(c)][i] = indirect_diffuse.pixels[i][c];
            values[std::size_t(3 + c)][i] = s.rho[c];
        }
    }
    for (const glm::ivec2 along : {glm::ivec2(1, 0), glm::ivec2(0, 1)})
        values = tent(values, planes, width, height, along, plane_tolerance, threads);
    ImageF shared = indirect_diffuse;
    for (std::size_t i = 0; i < pixels; ++i) {
        if (!surfaces[i].covered) continue;  // an edge whose middle sees nothing keeps what it has
        for (int c = 0; c < 3; ++c)
            if (const float rho = values[std::size_t(3 + c)][i]; rho > 0.0f)
                shared.pixels[i][c] = values[std::size_t(c)][i] * surfaces[i].rho[c] / rho;
    }
    return shared;
}

}  // namespace conebook
