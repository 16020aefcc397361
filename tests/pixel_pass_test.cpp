// Draws in slices: the same pixels as in one piece, in order, and given up without a trace in OpenGL's state.
#include <stdexcept>

#include <gtest/gtest.h>

#include "gl/pixel_pass.hpp"
#include "test_gl.hpp"

namespace conebook {
namespace {

constexpr glm::ivec2 kSize(131, 211);  // not a multiple of any slice

// The tone map of a smooth picture. test_gl() must have been called.
struct Drawing {
    gl::Shaders shaders{TestGl::root() + "/shaders"};
    gl::Program program = shaders.load({"common/fullscreen.vert", "01_first_light/tone_map.frag"});
    gl::Texture linear, display;
    gl::Framebuffer framebuffer;
    gl::VertexArray no_vertices;

    Drawing()
    {
        linear = gl::texture_2d("linear", GL_RGBA32F, kSize);
        std::vector<glm::vec4> pixels;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x) pixels.emplace_back(0.01f * float(x), 0.005f * float(y), 0.3f, 1.0f);
        glTextureSubImage2D(linear.id(), 0, 0, 0, kSize.x, kSize.y, GL_RGBA, GL_FLOAT, pixels.data());
        program.set("encoding", 0);
        program.set("exposure", 1.0f);
        program.set("white", 4.0f);
        program.set("data_scale", 1.0f);
    }
    std::vector<float> draw()
    {
        gl::fit_to_pixels(display, framebuffer, "display", GL_RGBA8, kSize);
        linear.bind(0);
        gl::draw_pixels(program, framebuffer, no_vertices, kSize);
        return gl::read_floats(display, 0, 4);
    }
};

TEST(Slices, AreTheSamePixels)
{
    test_gl();
    Drawing drawing;
    const std::vector<float> whole = drawing.draw();
    drawing.display.clear();
    int calls = 0;
    drawing.shaders.set_between_slices([&] { ++calls; });
    EXPECT_EQ(drawing.draw(), whole);
    EXPECT_GE(calls, 1);
    EXPECT_EQ(glIsEnabled(GL_SCISSOR_TEST), GL_FALSE);
    EXPECT_TRUE(test_gl().log.faults().empty());
}

TEST(Slices, AreGivenUpByThrowing)
{
    test_gl();
    Drawing drawing;
    const std::vector<float> whole = drawing.draw();
    drawing.display.clear();
    drawing.shaders.set_between_slices([] { throw std::runtime_error("enough"); });
    EXPECT_THROW(drawing.draw(), std::runtime_error);
    EXPECT_EQ(glIsEnabled(GL_SCISSOR_TEST), GL_FALSE);
    const std::vector<float> part = gl::read_floats(drawing.display, 0, 4);
    EXPECT_EQ(part.front(), whole.front());
    EXPECT_EQ(part.back(), 0.0f) << "the last row was drawn although the draw was given up after the first slice";
    drawing.shaders.set_between_slices({});
    EXPECT_EQ(drawing.draw(), whole);
}

}  // namespace
}  // namespace conebook
