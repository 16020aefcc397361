// Lists as textures, for shaders whose eight storage buffers are taken.
#pragma once

#include "16_only_what_is_needed/brick_structs.glsl"
#include "gl/handles.hpp"

namespace conebook {

// Room for a list in rows of kListWidth: shaders/16_only_what_is_needed/brick_list.glsl. Keeps the texture where it has the size.
void fit_list(gl::Texture& texture, const char* label, GLenum format, std::size_t items);

}  // namespace conebook
