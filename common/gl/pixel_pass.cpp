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
    program.use();
    glBindVertexArray(no_vertices.id());
    glBlendFunc(GL_ONE, GL_ONE);
    if (write == Write::add) glEnable(GL_BLEND);
    glDrawArrays(GL_TRIANGLES, 0, 3);  // common/fullscreen.vert: one triangle that covers everything
    if (write == Write::add) glDisable(GL_BLEND);
}

}  // namespace conebook::gl
