#include "14_speed_against_error/fetch_counter.hpp"

#include <algorithm>

#include "gl/pixel_pass.hpp"

namespace conebook {

namespace {

gl::Defines counting(bool emission_apart)
{
    return {{"COUNT_FETCHES", "1"}, {"PLAIN", "0"}, {"EMITTED", emission_apart ? "1" : "0"}};
}

}  // namespace

FetchCounter::FetchCounter(gl::Shaders& shaders, bool emission_apart)
    : diffuse_(shaders, {"common/fullscreen.vert", "08_diffuse_cones/diffuse.frag"}, counting(emission_apart)),
      aimed_(shaders, {"common/fullscreen.vert", "11_emissives/aimed.frag"}, counting(true)),
      specular_(shaders, {"common/fullscreen.vert", "09_specular_cones/specular.frag"}, counting(emission_apart)),
      view_(shaders.load({"common/fullscreen.vert", "14_speed_against_error/fetches.frag"}))
{
}

void FetchCounter::run(const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid,
                       const Emitters& emitters, const DiffuseConeUniforms& cones, const SpecularCones* specular,
                       const LitPixelParams& params)
{
    gl::fit_to_pixels(diffuse_counts_, diffuse_framebuffer_, "fetches, diffuse", GL_R32F, g_buffer.size());
    gl::fit_to_pixels(specular_counts_, specular_framebuffer_, "fetches, specular", GL_R32F, g_buffer.size());
    g_buffer.bind();
    grid.bind();
    pyramid.bind();
    // snippet: count
    const gl::Program& diffuse = diffuse_.reading(pyramid);
    cones.bind(diffuse, params.cones);
    emitters.near_light().bind(diffuse);
    gl::draw_pixels(diffuse, diffuse_framebuffer_, no_vertices_, g_buffer.size());
    // end snippet
    emitters.add_aimed(aimed_, g_buffer, grid, pyramid, cones, params.cones, diffuse_framebuffer_);
    specular_counts_.clear();
    if (specular == nullptr) return;
    const gl::Program& program = specular_.reading(pyramid);
    specular->bind(program, params.cones, params.specular);
    emitters.all_light().bind(program);
    gl::draw_pixels(program, specular_framebuffer_, no_vertices_, g_buffer.size());
}

FetchCounts FetchCounter::counts(const GBuffer& g_buffer) const
{
    const std::vector<float> diffuse = gl::read_floats(diffuse_counts_, 0, 1);
    const std::vector<float> specular = gl::read_floats(specular_counts_, 0, 1);
    const std::vector<float> depth = gl::read_floats(g_buffer.depth(), 0, 1);
    FetchCounts counts;
    std::size_t covered = 0;
    for (std::size_t i = 0; i < depth.size(); ++i) {
        if (depth[i] == 0.0f) continue;  // the far plane: no surface
        ++covered;
        counts.diffuse += double(diffuse[i]);
        counts.specular += double(specular[i]);
        counts.largest = std::max(counts.largest, double(diffuse[i]) + double(specular[i]));
    }
    counts.diffuse /= double(std::max<std::size_t>(covered, 1));
    counts.specular /= double(std::max<std::size_t>(covered, 1));
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
