// How often the cones of a pixel read a texture: their shaders once more, compiled to count instead of to gather.
#pragma once

#include "12_second_bounce/lit_pixels.hpp"

namespace conebook {

// Means over the pixels that show a surface.
struct FetchCounts {
    double diffuse = 0.0, specular = 0.0;  // diffuse: with the aimed rays
    double largest = 0.0;                  // both together, of one pixel
};

class FetchCounter {
public:
    // `emission_apart`: Emitters::are_apart().
    FetchCounter(gl::Shaders& shaders, bool emission_apart);

    // Trace the cones and rays that DiffuseCones, Emitters and SpecularCones would, for every pixel of the g-buffer.
    // `specular`: null where there are none.
    void run(const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid, const Emitters& emitters,
             const DiffuseConeUniforms& cones, const SpecularCones* specular, const LitPixelParams& params);
    // Reads the counts back. Exact to 2^24 a pixel.
    FetchCounts counts(const GBuffer& g_buffer) const;

    // RGBA32F: fetches of the diffuse, the specular and all cones in red, green and blue; alpha 1 where there is a
    // surface.
    const gl::Texture& show(const GBuffer& g_buffer);
    // RGBA8: the sum as a heat map from black (0) through red and yellow to white (`largest`).
    const gl::Texture& heat_map(const GBuffer& g_buffer, double largest);

private:
    void draw(gl::Texture& color, gl::Framebuffer& framebuffer, GLenum format, const GBuffer& g_buffer, float largest);
    PyramidProgram diffuse_, aimed_, specular_;
    gl::Program view_;
    gl::VertexArray no_vertices_;
    gl::Texture diffuse_counts_, specular_counts_, shown_, heat_map_;
    gl::Framebuffer diffuse_framebuffer_, specular_framebuffer_, shown_framebuffer_, heat_map_framebuffer_;
};

}  // namespace conebook
