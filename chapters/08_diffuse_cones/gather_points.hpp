// The points that gather for the pixels around them, and how they share what they gathered.
#pragma once

#include "02_g_buffer/g_buffer.hpp"
#include "04_conservative_voxelization/voxel_grid.hpp"

namespace conebook {

// One of every scale x scale pixels.
class GatherPoints {
public:
    explicit GatherPoints(gl::Shaders& shaders);
    // `sample`: as in ConeDirections; each has other pixels as points.
    void run(const GBuffer& g_buffer, const VoxelGrid& grid, int scale, int sample);
    // For programs that include 08_diffuse_cones/points.glsl: unit 16 and its uniforms.
    void bind(const gl::Program& program) const;
    glm::ivec2 size() const { return points_.size_2d(); }
    int scale() const { return scale_; }
    gl::Resource resource() const { return points_.resource(); }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture points_;  // RGBA32UI, see points.glsl
    gl::Framebuffer framebuffer_;
    int scale_ = 1;
    glm::ivec2 offset_{0};
};

// The mean over a tent of 7 x 7 points, of those that lie on the same surface.
class PointFilter {
public:
    explicit PointFilter(gl::Shaders& shaders);
    // RGBA32F of the points' size. Valid until the next call.
    const gl::Texture& run(const gl::Texture& gathered, const GBuffer& g_buffer, const GatherPoints& points);
    std::vector<gl::Resource> resources() const { return {rows_.resource(), columns_.resource()}; }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture rows_, columns_;
    gl::Framebuffer rows_framebuffer_, columns_framebuffer_;
};

}  // namespace conebook
