// Text and colour bars for sheet: black on white, in display-referred linear light.
#pragma once

#include <string>

#include "image/image.hpp"

namespace conebook {

// IEC 61966-2-1, to linear light
float srgb_decode(float v);

// The picture below a line of text. Throws std::runtime_error when the text is wider than the picture or not ASCII.
ImageF labelled(const ImageF& picture, const std::string& text);

struct ScaleBar {
    // grey, heat: from 0 to `end`; difference: both signs, full at `end`, white at twice; counts: 1 to 16
    std::string colors;
    float end = 1.0f;
    std::string unit;  // what the numbers are
};

// A bar of these colours `width` pixels wide at most, with numbers and unit below.
ImageF scale_bar(const ScaleBar& bar, int width);

}  // namespace conebook
