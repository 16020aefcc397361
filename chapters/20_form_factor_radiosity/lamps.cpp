#include "20_form_factor_radiosity/lamps.hpp"

#include <cmath>

#include "reference/random.hpp"

namespace conebook {

double point_to_triangle(const glm::dvec3& x, const glm::dvec3& n, const std::array<glm::dvec3, 3>& corners)
{
    // The polygon above the horizon: at most four corners.
    std::array<glm::dvec3, 4> above;
    std::size_t count = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::dvec3 a = corners[k] - x, b = corners[(k + 1) % 3] - x;
        const double ha = glm::dot(a, n), hb = glm::dot(b, n);
        if (ha >= 0.0) above[count++] = a;
        if ((ha > 0.0 && hb < 0.0) || (ha < 0.0 && hb > 0.0)) above[count++] = a + (b - a) * (ha / (ha - hb));
    }
    if (count < 3) return 0.0;
    double sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
        const glm::dvec3 a = above[k], b = above[(k + 1) % count], axis = glm::cross(a, b);
        const double sine = glm::length(axis);
        if (sine > 0.0) sum += std::atan2(sine, glm::dot(a, b)) * glm::dot(axis, n) / sine;
    }
    return std::abs(sum) / (2.0 * double(kPi));
}

Lamps::Lamps(const Patches& patches) : is_lamp_(patches.size(), false)
{
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        const Patch& patch = patches[i];
        if (patch.emitted == glm::vec3(0.0f) || patch.mirror) continue;
        Lamp lamp{i, {}, glm::dvec3(patch.normal)};
        const PatchNode& node = patches.mesh().nodes()[patch.node];
        for (std::size_t k = 0; k < 3; ++k) lamp.corners[k] = glm::dvec3(patches.mesh().points()[node.corners[k]]);
        lamps_.push_back(lamp);
        is_lamp_[i] = true;
    }
    if (lamps_.size() > kMost) lamps_.clear();
}

bool Lamps::sees(const Patches& patches, const Lamp& lamp, const glm::vec3& x, const glm::vec3& n, std::uint32_t k,
                 std::uint64_t seed)
{
    const std::uint64_t bits = mix_bits(mix_bits(seed + 1) + lamp.patch);
    const glm::vec3 w = triangle_weights(sequence_02(k, std::uint32_t(bits), std::uint32_t(bits >> 32)));
    const glm::vec3 y(double(w.x) * lamp.corners[0] + double(w.y) * lamp.corners[1] + double(w.z) * lamp.corners[2]);
    const float offset = patches.tracer().surface_offset();
    return !patches.tracer().occluded(x + offset * n, y + offset * glm::vec3(lamp.normal));
}

glm::vec3 Lamps::irradiance(const Patches& patches, const glm::vec3& x, const glm::vec3& n, std::uint64_t seed) const
{
    constexpr std::size_t kRays = 64;
    const auto rays = std::uint32_t((kRays + lamps_.size() - 1) / std::max<std::size_t>(lamps_.size(), 1));
    glm::vec3 sum(0.0f);
    see(patches, x, n, 0, seed, rays,
        [&](std::uint32_t lamp, double factor) { sum += float(factor) * patches[lamp].emitted; });
    return sum;
}

}  // namespace conebook
