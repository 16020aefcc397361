// "640x480" of the command lines.
#pragma once

#include <string>

#include <glm/glm.hpp>

namespace conebook {

// WIDTHxHEIGHT in pixels, each 1 .. 16384, which is what OpenGL 4.5 promises for textures (table 23.53). Throws
// std::runtime_error that names --size.
glm::ivec2 parse_picture_size(const std::string& text);

}  // namespace conebook
