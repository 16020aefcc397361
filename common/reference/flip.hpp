// FLIP: how strongly a viewer who flips between two pictures sees their difference, 0 (nothing) to 1.
// LDR: Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem & Fairchild 2020, "FLIP: A Difference Evaluator for
// Alternating Images". HDR: Andersson, Nilsson, Shirley & Akenine-Moeller 2021, "Visualizing Errors in Rendered High
// Dynamic Range Images": the maximum of LDR-FLIP over a range of exposures.
#pragma once

#include <vector>

#include "image/image.hpp"

namespace conebook {

// Pixels per degree of the papers' viewer: 0.7 m from a screen 0.7 m wide with 3840 pixels.
constexpr float kFlipPixelsPerDegree = 67.0206f;

// One value per pixel. Values outside 0..1 (linear RGB) are clamped.
std::vector<float> ldr_flip(const ImageF& image, const ImageF& reference);
std::vector<float> hdr_flip(const ImageF& image, const ImageF& reference);

// Mean of hdr_flip over the pixels whose reference alpha is above 0.
double hdr_flip_mean(const ImageF& image, const ImageF& reference);

}  // namespace conebook
