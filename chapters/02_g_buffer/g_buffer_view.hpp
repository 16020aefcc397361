// The attachments of the g-buffer as pictures, for --view.
#pragma once

#include <string>
#include <vector>

#include "02_g_buffer/g_buffer.hpp"
#include "app/options.hpp"

namespace conebook {

// emission, base_color, normal, depth: the views that all chapters have.
std::vector<View> surface_views();
// And one for everything else in the g-buffer: geometric_normal, metallic, roughness, f0, f90, position.
std::vector<View> attachment_views();

class GBufferViewPass {
public:
    explicit GBufferViewPass(gl::Shaders& shaders);

    const gl::Program& program() const { return program_; }

    // RGBA32F of one of the views above, nothing when the name is none of them. Normals are * 0.5 + 0.5, depth and
    // position in m, alpha 1 where there is a surface. Valid until the next call.
    const gl::Texture* run(const GBuffer& g_buffer, const std::string& view);

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
