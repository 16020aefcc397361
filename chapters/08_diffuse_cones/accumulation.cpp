#include "08_diffuse_cones/accumulation.hpp"

#include <utility>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, AccumulationParams& params)
{
    table.add("accumulate", params.accumulate, "while nothing changes, frames add up to a better picture");
}

Accumulation::Accumulation(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "08_diffuse_cones/accumulate.frag"}))
{
}

const gl::Texture& Accumulation::add(const gl::Texture& picture, int sample)
{
    std::swap(mean_[0], mean_[1]);
    std::swap(framebuffer_[0], framebuffer_[1]);
    gl::fit_to_pixels(mean_[0], framebuffer_[0], "mean of frames", GL_RGBA32F, picture.size_2d());
    gl::fit_to_pixels(mean_[1], framebuffer_[1], "mean of frames", GL_RGBA32F, picture.size_2d());
    picture.bind(16);
    mean_[1].bind(17);
    program_.set("share", 1.0f / float(sample + 1));
    gl::draw_pixels(program_, framebuffer_[0], no_vertices_, picture.size_2d());
    return mean_[0];
}

}  // namespace conebook
