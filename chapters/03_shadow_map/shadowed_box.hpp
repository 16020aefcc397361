// Where the shadows of a light fall: what its map has to hold, and no more.
#pragma once

#include <optional>
#include <vector>

#include "gl/gpu_scene.hpp"

namespace conebook {

// Normalized device coordinates of a light's view: x, y in -1..1, z the depth, 1 near .. 0 far.
struct NdcBox {
    glm::dvec3 low, high;
};

// The box of all places where, seen by the light, a surface lies behind another, and all depths within it. Surfaces
// that turn their back to the light receive none and count as what is in front only, unless their material has two
// sides. A plane of 4 km on which stands a box of 1 m gives the box and its shadow: the plane is behind nothing else.
// Not searched to its end: a box more than an eighth as wide and as high as the view becomes all of the view, and so
// does one that takes too long to find. Nothing: no shadow falls anywhere. Triangles may reach beyond the view;
// `diameter_m`: of the scene, for tolerances.
std::optional<NdcBox> shadowed_box(const glm::dmat4& clip_from_scene, const std::vector<Triangle>& triangles,
                                   double diameter_m);

}  // namespace conebook
