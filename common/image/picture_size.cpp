#include "image/picture_size.hpp"

#include <cstdio>
#include <stdexcept>

namespace conebook {

glm::ivec2 parse_picture_size(const std::string& text)
{
    constexpr int kMaxSide = 16384;
    int width = 0, height = 0;
    char x = 0, rest = 0;
    const bool ok = std::sscanf(text.c_str(), "%d%c%d%c", &width, &x, &height, &rest) == 3 && x == 'x';
    if (!ok || width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
        throw std::runtime_error("--size " + text + ": expected WIDTHxHEIGHT, each 1 .. " + std::to_string(kMaxSide));
    return {width, height};
}

}  // namespace conebook
