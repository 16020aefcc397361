#include "02_g_buffer/g_buffer_view.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

std::vector<View> surface_views()
{
    return {{"emission", Encoding::radiance, "emitted light, W/(sr m^2)"},
            {"base_color", Encoding::color, "base colour, linear in .exr"},
            {"normal", Encoding::data, "shading normal in scene space, * 0.5 + 0.5"},
            {"depth", Encoding::data, "distance along the camera's axis, m in .exr, scaled in .png"}};
}

std::vector<View> attachment_views()
{
    return {{"geometric_normal", Encoding::data, "normal of the triangle, * 0.5 + 0.5"},
            {"metallic", Encoding::data, "0 dielectric .. 1 metal"},
            {"roughness", Encoding::data, "perceptual roughness"},
            {"f0", Encoding::color, "specular reflectance at normal incidence, linear in .exr"},
            {"f90", Encoding::data, "specular reflectance at grazing incidence"},
            {"position", Encoding::data, "position from depth, scene space, m"}};
}

GBufferViewPass::GBufferViewPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "02_g_buffer/g_buffer_view.frag"}))
{
}

const gl::Texture* GBufferViewPass::run(const GBuffer& g_buffer, const std::string& view)
{
    // In the order of the shader's cases.
    std::vector<View> views = surface_views();
    for (const View& v : attachment_views()) views.push_back(v);
    std::size_t attachment = 0;
    while (attachment < views.size() && views[attachment].name != view) ++attachment;
    if (attachment == views.size()) return nullptr;

    gl::fit_to_pixels(color_, framebuffer_, "view", GL_RGBA32F, g_buffer.size());
    g_buffer.bind();
    program_.set("attachment", int(attachment));
    gl::draw_pixels(program_, framebuffer_, no_vertices_, g_buffer.size());
    return &color_;
}

}  // namespace conebook
