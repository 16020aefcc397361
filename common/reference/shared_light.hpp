// What chapter 08 does to its gathered light, done to the path tracer's: neighbours on the same surface share it. For fair
// comparisons at equal time, and no ground truth: the mean is biased at edges and wherever light changes within the window.
#pragma once

#include <vector>

#include "image/image.hpp"
#include "reference/scene_tracer.hpp"

namespace conebook {

// What the camera sees through the middle of a pixel.
struct VisibleSurface {
    bool covered = false;
    glm::vec3 position{0.0f};                                // scene space, m
    glm::vec3 geometric_normal{0.0f}, shading_normal{0.0f};  // unit
    glm::vec3 rho{0.0f};                                     // diffuse albedo
};

// Row by row from the top, as in ImageF. threads 0: all cores.
std::vector<VisibleSurface> visible_surfaces(const SceneTracer& tracer, const Camera& camera, int width, int height,
                                             int threads = 0);

// rgb of `indirect_diffuse` (W/(sr m^2)) is rho E / pi. Here E is the mean over the surface in a window of 14 x 14 pixels,
// a tent along rows and then one along columns: the window of chapter 08's filter at gather_scale=2. A neighbour is on the surface
// when it is within `plane_tolerance` (m) of its plane and the shading normals' cosine is above 0.9 (points.glsl). E is a
// quotient of means, sum of light over sum of rho, so that a dark texel counts as little as it knows. Alpha stays.
ImageF share_indirect_diffuse(const ImageF& indirect_diffuse, const std::vector<VisibleSurface>& surfaces,
                              float plane_tolerance, int threads = 0);

}  // namespace conebook
