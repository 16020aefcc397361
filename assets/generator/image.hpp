// Small pictures for textures, and a PNG writer without compression: the same bytes with any library version.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <glm/glm.hpp>

namespace conebook::generator {

struct Picture {
    int width = 0, height = 0, channels = 3;  // 3: RGB, 4: RGBA; 8 bits each, first row on top
    std::vector<std::uint8_t> texels;
};

// Fill a picture from a function of the texel (column, row); values 0..255.
Picture make_picture(int width, int height, int channels, const std::function<glm::ivec4(int, int)>& texel);

// PNG 1.2 (RFC 2083) with stored deflate blocks (RFC 1951, section 3.2.4).
std::vector<std::uint8_t> encode_png(const Picture& picture);

}  // namespace conebook::generator
