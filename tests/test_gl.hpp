// An OpenGL context without a display and the shaders of the repository, for tests of passes. Header only.
#pragma once

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "app/context.hpp"
#include "gl/debug_log.hpp"
#include "gl/handles.hpp"
#include "gl/shaders.hpp"
#include "image/image.hpp"

namespace conebook {

// One for all tests of a program.
struct TestGl {
    Context context = Context::headless();
    gl::DebugLog log;
    gl::Shaders shaders;
    TestGl() : shaders(root() + "/shaders") { glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE); }
    static std::string root()
    {
        const char* folder = std::getenv("CONEBOOK_ROOT");
        if (!folder) throw std::runtime_error("CONEBOOK_ROOT is not set");
        return folder;
    }
};
inline TestGl& test_gl()
{
    static TestGl gl;
    return gl;
}

// Colour texture -> picture, top row first.
inline ImageF read_picture(const gl::Texture& texture)
{
    const std::vector<float> values = gl::read_floats(texture, 0, 4);
    const glm::ivec2 size = texture.size_2d();
    ImageF image{size.x, size.y, std::vector<glm::vec4>(std::size_t(size.x) * std::size_t(size.y))};
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const float* v = &values[4 * (std::size_t(y) * std::size_t(size.x) + std::size_t(x))];
            image.at(x, size.y - 1 - y) = {v[0], v[1], v[2], v[3]};
        }
    return image;
}

}  // namespace conebook
