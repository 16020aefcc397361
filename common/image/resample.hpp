// Pictures made smaller on the CPU.
#pragma once

#include "image/image.hpp"

namespace conebook {

// IEC 61966-2-1:1999, section 5.2; 0..1 both.
double linear_from_srgb(double value);
double srgb_from_linear(double value);

enum class Encoding { linear, srgb };  // of R, G and B; alpha is always linear

// `image` with width x height pixels, 1 to its own: each is the mean over its area of the image (a box filter). sRGB
// is averaged in linear light.
Image8 shrink(const Image8& image, int width, int height, Encoding encoding);

}  // namespace conebook
