#include "11_emissives/emitter_light.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

EmitterLight::EmitterLight(gl::Shaders& shaders)
    : sample_(shaders, {"common/fullscreen.vert", "11_emissives/sample_emitters.frag"}),
      add_(shaders, {"common/fullscreen.vert", "11_emissives/add_emitters.frag"}),
      arriving_filter_(shaders),
      unshadowed_filter_(shaders)
{
}

const gl::Texture& EmitterLight::run(const GBuffer& g_buffer, const ConeVolumes& volumes, const Emitters& emitters,
                                     const DiffuseCones& cones, const gl::Texture& gathered, const ConeParams& params,
                                     int sample)
{
    if (!emitters.are_apart()) return gathered;
    const GatherPoints& points = cones.points();
    gl::Defines defines = volumes.defines();
    defines.merge(emitters.defines());

    // Every point aims rays at a set of parts.
    if (!arriving_ || arriving_.size_2d() != points.size()) {
        arriving_ = gl::texture_2d("light arriving from emitters", GL_RGBA32F, points.size());
        unshadowed_ = gl::texture_2d("light of emitters, unshadowed", GL_RGBA32F, points.size());
        samples_framebuffer_ =
            gl::Framebuffer("samples of emitters", std::vector<const gl::Texture*>{&arriving_, &unshadowed_});
    }
    g_buffer.bind();
    volumes.bind();
    const gl::Program& aim = sample_.with(defines);
    points.bind(aim);
    set_cones(aim, params);
    emitters.bind(aim);
    aim.set("start_offset", params.start_offset);
    aim.set("first_set", 5 * sample);  // 5 and the 16 sets have no common factor: all come in turn
    gl::draw_pixels(aim, samples_framebuffer_, no_vertices_, points.size());

    // Points of one surface share the rays.
    const gl::Texture& arriving = arriving_filter_.run(arriving_, g_buffer, points);
    const gl::Texture& unshadowed = unshadowed_filter_.run(unshadowed_, g_buffer, points);

    // Exact light times the share that arrives.
    gl::fit_to_pixels(light_, light_framebuffer_, "indirect diffuse and emitters' light", GL_RGBA32F, g_buffer.size());
    const gl::Program& add = add_.with(defines);
    points.bind(add);
    set_cones(add, params);
    emitters.bind(add);
    add.set("start_offset", params.start_offset);
    arriving.bind(17);
    unshadowed.bind(18);
    gathered.bind(19);
    gl::draw_pixels(add, light_framebuffer_, no_vertices_, g_buffer.size());
    return light_;
}

std::vector<gl::Resource> EmitterLight::resources() const
{
    std::vector<gl::Resource> all = {arriving_.resource(), unshadowed_.resource(), light_.resource()};
    for (const auto& part : {arriving_filter_.resources(), unshadowed_filter_.resources()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

}  // namespace conebook
