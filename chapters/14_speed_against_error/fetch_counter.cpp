#include "14_speed_against_error/fetch_counter.hpp"

#include <algorithm>

#include "gl/pixel_pass.hpp"

namespace conebook {

FetchCounter::FetchCounter(gl::Shaders& shaders)
    : diffuse_(shaders, {"common/fullscreen.vert", "14_speed_against_error/count_gather.frag"}),
      specular_(shaders, {"common/fullscreen.vert", "14_speed_against_error/count_lobe.frag"}),
      view_(shaders.load({"common/fullscreen.vert", "14_speed_against_error/fetches.frag"}))
{
}

void FetchCounter::run(const SceneLight& scene_light, const CameraLight& camera_light, const CameraLightParams& params,
                       bool has_specular)
{
    const GBuffer& g_buffer = camera_light.g_buffer();
    const Emitters& emitters = scene_light.emitters();
    const ConeVolumes volumes = scene_light.volumes();
    scale_ = camera_light.diffuse_cones().points().scale();
    const glm::ivec2 points = camera_light.diffuse_cones().points().size();
    gl::fit_to_pixels(diffuse_counts_, diffuse_framebuffer_, "look-ups, diffuse", GL_RGBA32F, points);
    gl::fit_to_pixels(specular_counts_, specular_framebuffer_, "look-ups, specular", GL_RGBA32F, g_buffer.size());
    g_buffer.bind();
    volumes.bind();
    // snippet: count
    gl::Defines defines = {{"EMITTERS", emitters.are_apart() ? "1" : "0"}};
    defines.merge(cone_defines(params.cones, volumes));
    const gl::Program& diffuse = diffuse_.with(defines);
    camera_light.diffuse_cones().points().bind(diffuse);
    camera_light.directions().bind(diffuse, params.cones);
    gl::draw_pixels(diffuse, diffuse_framebuffer_, no_vertices_, points);
    // end snippet
    specular_counts_.clear();
    if (!has_specular) return;
    const gl::Program& specular = specular_.with(defines);
    camera_light.specular_cones().bind(specular, params.cones, params.specular, 0);
    emitters.bind_emission();
    gl::draw_pixels(specular, specular_framebuffer_, no_vertices_, g_buffer.size());
}

FetchCounts FetchCounter::counts(const GBuffer& g_buffer) const
{
    const std::vector<float> diffuse = gl::read_floats(diffuse_counts_, 0, 4);
    const std::vector<float> specular = gl::read_floats(specular_counts_, 0, 4);
    FetchCounts counts;
    double points = 0.0, pixels = 0.0, lobes = 0.0;
    for (const float depth : gl::read_floats(g_buffer.depth(), 0, 1)) pixels += depth > 0.0f ? 1.0 : 0.0;
    for (std::size_t i = 0; i < diffuse.size(); i += 4) {
        points += double(diffuse[i + 3]);
        counts.diffuse_steps += double(diffuse[i]);
        counts.diffuse += double(diffuse[i + 1]);
        counts.largest = std::max(counts.largest, double(diffuse[i]) + double(diffuse[i + 1]));
    }
    for (std::size_t i = 0; i < specular.size(); i += 4) {
        lobes += double(specular[i + 3]);
        counts.specular_steps += double(specular[i]);
        counts.specular += double(specular[i + 1]);
        counts.largest = std::max(counts.largest, double(specular[i]) + double(specular[i + 1]));
    }
    counts.diffuse_steps /= std::max(points, 1.0);
    counts.diffuse /= std::max(points, 1.0);
    counts.specular_steps /= std::max(lobes, 1.0);
    counts.specular /= std::max(lobes, 1.0);
    counts.points_per_pixel = points / std::max(pixels, 1.0);
    return counts;
}

void FetchCounter::draw(gl::Texture& color, gl::Framebuffer& framebuffer, GLenum format, const GBuffer& g_buffer,
                        float largest)
{
    gl::fit_to_pixels(color, framebuffer, "view of fetches", format, g_buffer.size());
    g_buffer.bind();
    diffuse_counts_.bind(16);
    specular_counts_.bind(17);
    view_.set("largest", largest);
    view_.set("gather_scale", scale_);
    gl::draw_pixels(view_, framebuffer, no_vertices_, g_buffer.size());
}

const gl::Texture& FetchCounter::show(const GBuffer& g_buffer)
{
    draw(shown_, shown_framebuffer_, GL_RGBA32F, g_buffer, 0.0f);
    return shown_;
}

const gl::Texture& FetchCounter::heat_map(const GBuffer& g_buffer, double largest)
{
    draw(heat_map_, heat_map_framebuffer_, GL_RGBA8, g_buffer, std::max(float(largest), 1.0f));
    return heat_map_;
}

}  // namespace conebook
