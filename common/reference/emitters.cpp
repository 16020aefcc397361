#include "reference/emitters.hpp"

#include <algorithm>
#include <cmath>

namespace conebook {
namespace {

glm::vec3 cross_of(const TrianglePoint& p)
{
    return glm::cross(p.v1->position - p.v0->position, p.v2->position - p.v0->position);
}

// Mean emitted radiance of a triangle, roughly: textures are looked at in a small grid of points. It only steers where
// samples go; a triangle whose texels were all missed is still found by the brdf's own samples, with full weight.
double rough_radiance(const Scene& scene, const Draw& draw, std::uint32_t triangle)
{
    constexpr int kGrid = 6;
    const Material& material = scene.materials[draw.material];
    double sum = 0.0;
    int count = 0;
    for (int i = 0; i < kGrid; ++i)
        for (int j = 0; i + j < kGrid; ++j, ++count) {
            const TrianglePoint p =
                triangle_point(scene, draw, triangle, (i + 1 / 3.0f) / kGrid, (j + 1 / 3.0f) / kGrid);
            const glm::vec3 le = emitted_radiance(scene, material, p);
            sum += le.x + le.y + le.z;
        }
    return sum / count;
}

}  // namespace

EmitterSampler::EmitterSampler(const Scene& scene) : scene_(&scene), pdf_by_draw_(scene.draws.size())
{
    std::vector<double> power;
    double total = 0.0;
    for (std::uint32_t d = 0; d < scene.draws.size(); ++d) {
        const Draw& draw = scene.draws[d];
        const Material& material = scene.materials[draw.material];
        if (!material.shines()) continue;
        for (std::uint32_t t = 0; t < draw.index_count / 3; ++t) {
            const double area = 0.5 * glm::length(cross_of(triangle_point(scene, draw, t, 0, 0)));
            const double weight = rough_radiance(scene, draw, t) * area * (material.double_sided ? 2.0 : 1.0);
            if (!(weight > 0.0)) continue;
            total += weight;
            power.push_back(weight);
            emitters_.push_back({d, t, float(weight / area)});
        }
    }
    double running = 0.0;
    for (std::size_t i = 0; i < emitters_.size(); ++i) {
        Emitter& e = emitters_[i];
        e.pdf_area = float(e.pdf_area / total);
        running += power[i] / total;
        cumulative_.push_back(running);
        auto& of_draw = pdf_by_draw_[e.draw];
        if (of_draw.empty()) of_draw.assign(scene.draws[e.draw].index_count / 3, 0.0f);
        of_draw[e.triangle] = e.pdf_area;
    }
}

std::optional<EmitterSample> EmitterSampler::sample(const glm::vec3& point, float choice, const glm::vec2& u) const
{
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), double(choice));
    const Emitter& e = emitters_[std::min<std::size_t>(found - cumulative_.begin(), emitters_.size() - 1)];
    const Draw& draw = scene_->draws[e.draw];
    const Material& material = scene_->materials[draw.material];
    // Uniform in a triangle (Turk 1990): the square root makes the density constant.
    const float s = std::sqrt(u.x);
    const TrianglePoint p = triangle_point(*scene_, draw, e.triangle, s * (1.0f - u.y), s * u.y);
    EmitterSample sample;
    sample.position = p.mix(&Vertex::position);
    sample.normal = glm::normalize(cross_of(p));
    if (glm::dot(sample.normal, point - sample.position) <= 0.0f) {
        if (!material.double_sided) return std::nullopt;
        sample.normal = -sample.normal;
    }
    if (!covers(*scene_, material, p)) return std::nullopt;
    sample.radiance = emitted_radiance(*scene_, material, p);
    if (sample.radiance == glm::vec3(0.0f)) return std::nullopt;
    sample.pdf_area = e.pdf_area;
    return sample;
}

float EmitterSampler::pdf_area(const SurfaceHit& hit) const
{
    const auto& of_draw = pdf_by_draw_[hit.draw];
    return of_draw.empty() ? 0.0f : of_draw[hit.triangle];
}

}  // namespace conebook
