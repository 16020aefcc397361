#include "16_only_what_is_needed/brick_list.hpp"

#include <stdexcept>
#include <string>

namespace conebook {

void fit_list(gl::Texture& texture, const char* label, GLenum format, std::size_t items)
{
    GLint most = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
    const std::size_t rows = (items + shared::kListWidth - 1) / shared::kListWidth;
    if (rows > std::size_t(most))
        throw std::runtime_error(std::string(label) + ": " + std::to_string(items) +
                                 " texels, a list of this driver has " +
                                 std::to_string(shared::kListWidth * std::size_t(most)) +
                                 " (GL_MAX_TEXTURE_SIZE); use a smaller --set voxels=");
    const glm::ivec3 size(shared::kListWidth, int(rows), 1);
    if (!texture || texture.size() != size || texture.format() != format)
        texture = gl::texture_2d(label, format, glm::ivec2(size));
}

}  // namespace conebook
