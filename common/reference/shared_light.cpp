#include "reference/shared_light.hpp"

#include <algorithm>
#include <atomic>
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

struct LightAndAlbedo {
    glm::vec3 light{0.0f}, rho{0.0f};
};

// One direction of the tent: the means of light and albedo over what lies on the surface of each pixel.
std::vector<LightAndAlbedo> tent(const std::vector<LightAndAlbedo>& in, const std::vector<VisibleSurface>& surfaces,
                                 int width, int height, glm::ivec2 along, float plane_tolerance, int threads)
{
    std::vector<LightAndAlbedo> out(in.size());
    for_each_row(height, threads, [&](int y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t here = std::size_t(y) * std::size_t(width) + std::size_t(x);
            const VisibleSurface& center = surfaces[here];
            if (!center.covered) continue;
            LightAndAlbedo sum;
            float weights = 0.0f;
            for (int i = -kReach; i <= kReach; ++i) {
                const glm::ivec2 other = glm::ivec2(x, y) + i * along;
                if (other.x < 0 || other.y < 0 || other.x >= width || other.y >= height) continue;
                const std::size_t there = std::size_t(other.y) * std::size_t(width) + std::size_t(other.x);
                const VisibleSurface& neighbour = surfaces[there];
                const float off_plane = glm::dot(neighbour.position - center.position, center.geometric_normal);
                if (!neighbour.covered || std::abs(off_plane) >= plane_tolerance ||
                    glm::dot(neighbour.shading_normal, center.shading_normal) <= kMinCosine)
                    continue;
                const float weight = float(kReach + 1 - std::abs(i));
                sum.light += weight * in[there].light;
                sum.rho += weight * in[there].rho;
                weights += weight;
            }
            out[here] = {sum.light / weights, sum.rho / weights};
        }
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
    std::vector<LightAndAlbedo> values(surfaces.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = {glm::vec3(indirect_diffuse.pixels[i]), surfaces[i].rho};
    for (const glm::ivec2 along : {glm::ivec2(1, 0), glm::ivec2(0, 1)})
        values = tent(values, surfaces, width, height, along, plane_tolerance, threads);
    ImageF shared = indirect_diffuse;
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (!surfaces[i].covered) continue;  // an edge whose middle sees nothing keeps what it has
        for (int c = 0; c < 3; ++c)
            if (values[i].rho[c] > 0.0f)
                shared.pixels[i][c] = values[i].light[c] * surfaces[i].rho[c] / values[i].rho[c];
    }
    return shared;
}

}  // namespace conebook
