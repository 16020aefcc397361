// Emissive triangles as light sources: chosen by emitted power, sampled uniformly by area.
#pragma once

#include <optional>
#include <vector>

#include "reference/surface.hpp"
#include "scene/scene.hpp"

namespace conebook {

struct EmitterSample {
    glm::vec3 position{0.0f};  // scene space
    glm::vec3 normal{0.0f};    // unit, towards the point that is lit
    glm::vec3 radiance{0.0f};  // towards it
    float pdf_area = 0.0f;     // 1/m^2
};

class EmitterSampler {
public:
    explicit EmitterSampler(const Scene& scene);
    bool empty() const { return cumulative_.empty(); }

    // A point on an emitter as seen from `point`; nothing when the point chosen does not shine there.
    std::optional<EmitterSample> sample(const glm::vec3& point, float choice, const glm::vec2& u) const;

    // Density per area with which sample() chooses a point of the triangle that was hit.
    float pdf_area(const SurfaceHit& hit) const;

private:
    struct Emitter {
        std::uint32_t draw, triangle;
        float pdf_area;  // probability of the triangle / its area
    };
    const Scene* scene_;
    std::vector<Emitter> emitters_;
    std::vector<double> cumulative_;               // of the triangles' probabilities, last is 1
    std::vector<std::vector<float>> pdf_by_draw_;  // pdf_area per triangle; empty for draws that do not shine
};

}  // namespace conebook
