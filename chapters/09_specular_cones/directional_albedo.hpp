// How much of a uniformly bright surrounding the specular lobe sends to the eye.
#pragma once

#include <vector>

#include <glm/glm.hpp>

namespace conebook {

// The two integrals of the split sum (Karis 2013, "Environment BRDF"): albedo = F0 * x + F90 * y, for the
// single-scattering GGX lobe of shaders/common/brdf.glsl. n_dot_v 0..1, alpha = roughness^2 > 0. Computed in double
// precision with `samples` visible normals (Heitz 2018) of a Hammersley set.
glm::dvec2 directional_albedo(double n_dot_v, double alpha, int samples);

// Table of size * size entries, row by row: n_dot_v along a row, roughness from row to row, both
// i / (size - 1), from 0 to 1.
std::vector<glm::vec2> directional_albedo_table(int size, int samples);

}  // namespace conebook
