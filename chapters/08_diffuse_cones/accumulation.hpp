// Many pictures of the same thing, each with other cones and a camera moved by less than a pixel: their mean.
#pragma once

#include "app/parameters.hpp"
#include "gl/handles.hpp"
#include "gl/shaders.hpp"

namespace conebook {

struct AccumulationParams {
    // While nothing changes, frames add up: edges become smooth, and the noise of few cones goes with 1 / frames.
    bool accumulate = true;
};
void add_parameters(ParameterTable& table, AccumulationParams& params);

class Accumulation {
public:
    explicit Accumulation(gl::Shaders& shaders);
    // RGBA32F: the mean of the pictures of samples 0 .. `sample`, of which this is the last one and the others were given
    // before, in order. Valid until the next call.
    const gl::Texture& add(const gl::Texture& picture, int sample);
    std::vector<gl::Resource> resources() const { return {mean_[0].resource(), mean_[1].resource()}; }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture mean_[2];
    gl::Framebuffer framebuffer_[2];
};

}  // namespace conebook
