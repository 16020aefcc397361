#include "gl/pixel_pass.hpp"

namespace conebook::gl {

void fit_to_pixels(Texture& color, Framebuffer& framebuffer, const std::string& label, GLenum format, glm::ivec2 size)
{
    if (color && color.size_2d() == size) return;
    color = texture_2d(label, format, size);
    framebuffer = Framebuffer(label, {&color});
}

void draw_pixels(const Program& program, const Framebuffer& framebuffer, const VertexArray& no_vertices,
                 glm::ivec2 size, Write write)
{
    framebuffer.bind(size);
    glDisable(GL_DEPTH_TEST);
    (write == Write::add ? glEnable : glDisable)(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
    program.use();
    draw_fullscreen_triangle(no_vertices);
}

}  // namespace conebook::gl
