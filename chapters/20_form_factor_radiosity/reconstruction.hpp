// From one value a patch to light without steps: values at the corners, which the rasterizer interpolates.
#pragma once

#include "20_form_factor_radiosity/lamps.hpp"
#include "20_form_factor_radiosity/radiosity_solver.hpp"

namespace conebook {

struct ReconstructionParams {
    // Values at corners, fitted to the patches around. Off: one value a patch, and its edges are seen.
    bool smooth = true;
    // Degrees between the normals of two patches across which light is continuous, 0 .. 180.
    float smooth_angle = 30.0f;
    bool operator==(const ReconstructionParams&) const = default;
};
void add_parameters(ParameterTable& table, ReconstructionParams& params);

// Values at the three corners of each patch, in the order of its node's corners.
using CornerValues = std::vector<std::array<glm::vec3, 3>>;

// Which patches are one surface: neighbours over edges, and round corners.
class Surfaces {
public:
    Surfaces(const Patches& patches, const ReconstructionParams& params);

    // Neighbours of a patch over its edges on the same surface: not where the angle is too large, and not where a
    // third patch rises from the edge on this side (the foot of a wall), for its shadow ends there.
    const std::vector<std::uint32_t>& neighbours(std::uint32_t patch) const { return neighbours_[patch]; }

    // A linear function of the position is fitted (weighted least squares) to the patches round each corner and their
    // neighbours. A linear field is met exactly, at borders too, where a mean would lag by half a patch.
    // Of `values`, the part `from_lamps` is not fitted but found anew at the corner, where rays ask for the lamps:
    // shadows keep their edges. Corners inside something solid are fitted.
    CornerValues corners(const Irradiance& values, const Irradiance& from_lamps, const Lamps& lamps) const;

private:
    const Patches* patches_;
    ReconstructionParams params_;
    std::vector<std::vector<std::uint32_t>> neighbours_;
};

}  // namespace conebook
