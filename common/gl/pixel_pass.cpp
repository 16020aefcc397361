#include "gl/pixel_pass.hpp"

#include <algorithm>
#include <chrono>

namespace conebook::gl {

void fit_to_pixels(Texture& color, Framebuffer& framebuffer, const std::string& label, GLenum format, glm::ivec2 size)
{
    if (color && color.size_2d() == size) return;
    color = texture_2d(label, format, size);
    framebuffer = Framebuffer(label, {&color});
}

namespace {

// While it lives, only the pixels of some rows are written.
class RowsOnly {
public:
    RowsOnly() { glEnable(GL_SCISSOR_TEST); }
    ~RowsOnly() { glDisable(GL_SCISSOR_TEST); }
    RowsOnly(const RowsOnly&) = delete;
    RowsOnly& operator=(const RowsOnly&) = delete;
    void choose(int width, int first, int count) const { glScissor(0, first, width, count); }
};

// While it lives, what is written is added, if that is asked for.
class Blending {
public:
    explicit Blending(Write write)
    {
        glBlendFunc(GL_ONE, GL_ONE);
        if (write == Write::add) glEnable(GL_BLEND);
    }
    ~Blending() { glDisable(GL_BLEND); }
    Blending(const Blending&) = delete;
    Blending& operator=(const Blending&) = delete;
};

// common/fullscreen.vert: one triangle that covers everything.
void draw_all(const VertexArray& no_vertices)
{
    glBindVertexArray(no_vertices.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void draw_in_bands(const VertexArray& no_vertices, glm::ivec2 size, const std::function<void()>& between)
{
    constexpr int kFirstRows = 16;  // even: derivatives are taken over 2 x 2 pixels
    const RowsOnly rows;
    int count = kFirstRows;
    for (int first = 0; first < size.y;) {
        const auto start = std::chrono::steady_clock::now();
        rows.choose(size.x, first, count);
        draw_all(no_vertices);
        glFinish();
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
        first += count;
        if (first >= size.y) break;
        between();
        // As many rows as fit, but not many more at once: the next ones may be harder.
        const double fit = double(count) * kSlice_s / taken.count();
        count = int(std::clamp(fit / kFirstRows, 1.0, 4.0 * count / kFirstRows)) * kFirstRows;
    }
}

}  // namespace

void draw_pixels(const Program& program, const Framebuffer& framebuffer, const VertexArray& no_vertices,
                 glm::ivec2 size, Write write)
{
    framebuffer.bind(size);
    program.use();
    const Blending blending(write);
    if (program.between_slices())
        draw_in_bands(no_vertices, size, program.between_slices());
    else
        draw_all(no_vertices);
}

}  // namespace conebook::gl
