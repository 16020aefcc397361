// How much cones look up: their shaders once more, compiled to count as well.
#pragma once

#include "12_second_bounce/camera_light.hpp"

namespace conebook {

// Means over the points that gather, and over the pixels that have a specular lobe.
struct FetchCounts {
    double diffuse_steps = 0.0, specular_steps = 0.0;  // texels of the walk volume
    double diffuse = 0.0, specular = 0.0;              // filtered texels of the pyramids
    double points_per_pixel = 0.0;                     // of the pixels that show a surface
    double largest = 0.0;                              // steps and fetches of one point or pixel
};

class FetchCounter {
public:
    explicit FetchCounter(gl::Shaders& shaders);

    // Trace the cones and rays of the last frame once more, those of its first sample.
    void run(const SceneLight& scene_light, const CameraLight& camera_light, const CameraLightParams& params,
             bool has_specular);
    // Reads the counts back. Exact to 2^24 a pixel.
    FetchCounts counts(const GBuffer& g_buffer) const;

    // RGBA32F: look-ups of the diffuse, the specular and all cones in red, green and blue; alpha 1 where there is a
    // surface.
    const gl::Texture& show(const GBuffer& g_buffer);
    // RGBA8: the sum as a heat map from black (0) through red and yellow to white (`largest`).
    const gl::Texture& heat_map(const GBuffer& g_buffer, double largest);

private:
    void draw(gl::Texture& color, gl::Framebuffer& framebuffer, GLenum format, const GBuffer& g_buffer, float largest);
    gl::ProgramVariants diffuse_, specular_;
    int scale_ = 1;
    gl::Program view_;
    gl::VertexArray no_vertices_;
    gl::Texture diffuse_counts_, specular_counts_, shown_, heat_map_;
    gl::Framebuffer diffuse_framebuffer_, specular_framebuffer_, shown_framebuffer_, heat_map_framebuffer_;
};

}  // namespace conebook
