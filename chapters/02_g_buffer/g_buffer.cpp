#include "02_g_buffer/g_buffer.hpp"

namespace conebook {

GBuffer::GBuffer(gl::Shaders& shaders, glm::ivec2 size)
    : program_(shaders.load({"01_first_light/scene.vert", "02_g_buffer/g_buffer.frag"})),
      camera_buffer_("camera", sizeof(shared::CameraData))
{
    resize(size);
}

void GBuffer::resize(glm::ivec2 size)
{
    if (depth_ && depth_.size_2d() == size) return;
    depth_ = gl::texture_2d("g-buffer depth", GL_DEPTH_COMPONENT32F, size);
    normal_ = gl::texture_2d("g-buffer normal", GL_RG16_SNORM, size);
    geometric_normal_ = gl::texture_2d("g-buffer geometric normal", GL_RG16_SNORM, size);
    base_color_metallic_ = gl::texture_2d("g-buffer base colour, metallic", GL_RGBA16, size);
    f0_f90_ = gl::texture_2d("g-buffer f0, f90", GL_RGBA16, size);
    emission_roughness_ = gl::texture_2d("g-buffer emission, roughness", GL_RGBA32F, size);
    framebuffer_ = gl::Framebuffer(
        "g-buffer", {&normal_, &geometric_normal_, &base_color_metallic_, &f0_f90_, &emission_roughness_}, &depth_);
}

void GBuffer::draw(const GpuScene& scene, const shared::CameraData& camera)
{
    camera_buffer_.write(0, sizeof camera, &camera);
    camera_buffer_.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    framebuffer_.bind(size());
    constexpr float kNothing[4] = {0.0f, 0.0f, 0.0f, 0.0f};
    constexpr float kFarthest = 0.0f;
    for (GLint i = 0; i < 5; ++i) glClearNamedFramebufferfv(framebuffer_.id(), GL_COLOR, i, kNothing);
    glClearNamedFramebufferfv(framebuffer_.id(), GL_DEPTH, 0, &kFarthest);

    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    drawn_ = scene.draw(program_, Culling::back_of_single_sided, &camera.clip_from_scene);
    glDisable(GL_DEPTH_TEST);
}

void GBuffer::bind() const
{
    GLuint unit = GLuint(shared::kFirstFreeUnit);
    for (const gl::Texture* texture :
         {&depth_, &normal_, &geometric_normal_, &base_color_metallic_, &f0_f90_, &emission_roughness_})
        texture->bind(unit++);
    camera_buffer_.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
}

std::vector<gl::Resource> GBuffer::resources() const
{
    return {depth_.resource(),  normal_.resource(), geometric_normal_.resource(), base_color_metallic_.resource(),
            f0_f90_.resource(), emission_roughness_.resource()};
}

}  // namespace conebook
