// What every pass over pixels does: one shader invocation for each pixel of its output.
#pragma once

#include "gl/handles.hpp"
#include "gl/shaders.hpp"

namespace conebook::gl {

// Make `color` and its framebuffer again when the size changes, or when there is none yet.
void fit_to_pixels(Texture& color, Framebuffer& framebuffer, const std::string& label, GLenum format, glm::ivec2 size);

enum class Write { replace, add };

// Run `program` (common/fullscreen.vert and a fragment shader) for every pixel. The one place where passes over pixels
// draw: blending, depth test and culling are off between passes, here as everywhere, and a pass that needs one of them
// switches it on and off again.
// Where there is program.between_slices() to call, that is done in bands of rows of about kSlice_s, each finished before the
// call: the same pixels. What the call throws leaves some rows as they were.
constexpr double kSlice_s = 0.02;
void draw_pixels(const Program& program, const Framebuffer& framebuffer, const VertexArray& no_vertices,
                 glm::ivec2 size, Write write = Write::replace);

}  // namespace conebook::gl
