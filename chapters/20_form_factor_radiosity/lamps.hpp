// Emitters that are few: what each would give to a point, in closed form, and rays that ask whether it is hidden.
#pragma once

#include "20_form_factor_radiosity/patches.hpp"

namespace conebook {

// Of a small surface at x, normal n, towards a triangle that nothing hides, its part below the horizon cut off:
// Lambert's formula (Baum et al. 1989, "Improving radiosity solutions through the use of analytically determined
// form-factors", 3).
double point_to_triangle(const glm::dvec3& x, const glm::dvec3& n, const std::array<glm::dvec3, 3>& corners);

class Lamps {
public:
    static constexpr std::size_t kMost = 96;  // patches; more are left to rays, which then meet many of them

    Lamps() = default;  // none
    // The patches that emit and are no mirrors; none of them when they are more than kMost.
    explicit Lamps(const Patches& patches);

    bool empty() const { return lamps_.empty(); }
    bool has(std::uint32_t patch) const { return !empty() && is_lamp_[patch]; }

    // Calls found(patch, form factor) for each lamp that a surface at `x` (on it, not above) with normal n sees, by
    // `rays` rays to each; sample k of `seed` is another one each time. Returns the number of rays.
    template <typename Found>
    int see(const Patches& patches, const glm::vec3& x, const glm::vec3& n, std::uint32_t k, std::uint64_t seed,
            std::uint32_t rays, Found found) const
    {
        int traced = 0;
        for (const Lamp& lamp : lamps_) {
            if (glm::dot(lamp.normal, glm::dvec3(x) - lamp.corners[0]) <= 0.0) continue;
            const double factor = point_to_triangle(glm::dvec3(x), glm::dvec3(n), lamp.corners);
            if (!(factor > 0.0)) continue;
            std::uint32_t open = 0;
            for (std::uint32_t r = 0; r < rays; ++r) open += sees(patches, lamp, x, n, k * rays + r, seed) ? 1u : 0u;
            traced += int(rays);
            if (open > 0) found(lamp.patch, factor * open / rays);
        }
        return traced;
    }

    // Irradiance at a corner of the mesh from all lamps, W/m^2, by 64 rays or more.
    glm::vec3 irradiance(const Patches& patches, const glm::vec3& x, const glm::vec3& n, std::uint64_t seed) const;

private:
    struct Lamp {
        std::uint32_t patch;
        std::array<glm::dvec3, 3> corners;
        glm::dvec3 normal;
    };
    static bool sees(const Patches& patches, const Lamp& lamp, const glm::vec3& x, const glm::vec3& n, std::uint32_t k,
                     std::uint64_t seed);
    std::vector<Lamp> lamps_;
    std::vector<bool> is_lamp_;
};

}  // namespace conebook
