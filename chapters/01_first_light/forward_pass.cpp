#include "01_first_light/forward_pass.hpp"

#include <iterator>

namespace conebook {

std::optional<ForwardOutput> forward_output(const std::string& view)
{
    // In the order of ForwardOutput.
    constexpr const char* kViews[] = {"final", "direct", "emission", "base_color", "normal", "depth"};
    for (std::size_t i = 0; i < std::size(kViews); ++i)
        if (view == kViews[i]) return ForwardOutput(i);
    return std::nullopt;
}

ForwardPass::ForwardPass(gl::Shaders& shaders)
    : program_(shaders.load({"01_first_light/scene.vert", "01_first_light/forward.frag"})),
      camera_buffer_("camera", sizeof(shared::CameraData))
{
}

const gl::Texture& ForwardPass::run(const GpuScene& scene, const shared::CameraData& camera, glm::ivec2 size,
                                    ForwardOutput output)
{
    if (color_.size_2d() != size) {
        color_ = gl::texture_2d("radiance", GL_RGBA32F, size);  // 32 bits: radiance next to a light passes 65504
        depth_ = gl::texture_2d("depth", GL_DEPTH_COMPONENT32F, size);
        framebuffer_ = gl::Framebuffer("forward", {&color_}, &depth_);
    }
    // snippet: forward_pass
    camera_buffer_.write(0, sizeof camera, &camera);
    camera_buffer_.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    framebuffer_.bind(size);
    constexpr float kNothing[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    constexpr float kFarthest = 0.0f;  // reversed depth: 1 at the near plane, 0 at the far one
    glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, 0, kNothing);
    glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &kFarthest);

    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    program_.set("shown", int(output));
    scene.draw(program_, Culling::back_of_single_sided);
    glDisable(GL_DEPTH_TEST);
    // end snippet
    return color_;
}

std::vector<gl::Resource> ForwardPass::resources() const { return {color_.resource(), depth_.resource()}; }

}  // namespace conebook
