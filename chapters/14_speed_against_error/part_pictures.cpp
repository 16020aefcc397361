#include "14_speed_against_error/part_pictures.hpp"

#include <cmath>
#include <stdexcept>

#include "image/image.hpp"

namespace conebook {

void write_part_pictures(const std::filesystem::path& output, LitPixels& pixels)
{
    for (const std::string part : {"final", "direct", "indirect_diffuse", "indirect_specular"}) {
        const gl::Texture& texture = pixels.composite(part);
        const std::vector<float> floats = gl::read_floats(texture, 0, 4);
        const std::filesystem::path file = output.parent_path() / (output.stem().string() + "_" + part + ".exr");
        const glm::ivec2 size = texture.size_2d();
        ImageF picture{size.x, size.y, std::vector<glm::vec4>(std::size_t(size.x) * std::size_t(size.y))};
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x)
                for (int c = 0; c < 4; ++c) {
                    // OpenGL's bottom row comes first.
                    const std::size_t texel = std::size_t(size.y - 1 - y) * std::size_t(size.x) + std::size_t(x);
                    const float value = floats[4 * texel + std::size_t(c)];
                    if (!std::isfinite(value))
                        throw std::runtime_error(file.string() +
                                                 ": not written, the picture holds a value that is "
                                                 "not finite");
                    picture.at(x, y)[c] = value;
                }
        write_exr(file, picture);
    }
}

}  // namespace conebook
