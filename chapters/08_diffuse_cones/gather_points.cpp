#include "08_diffuse_cones/gather_points.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

GatherPoints::GatherPoints(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "08_diffuse_cones/points.frag"}))
{
}

void GatherPoints::run(const GBuffer& g_buffer, const VoxelGrid& grid, int scale, int sample)
{
    scale_ = scale;
    offset_ = glm::ivec2(sample, sample / scale) % scale;
    gl::fit_to_pixels(points_, framebuffer_, "points", GL_RGBA32UI, (g_buffer.size() + scale - 1) / scale);
    g_buffer.bind();
    grid.bind();
    program_.set("gather_scale", scale_);
    program_.set("gather_offset", offset_);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, size());
}

void GatherPoints::bind(const gl::Program& program) const
{
    points_.bind(16);
    program.set("gather_scale", scale_);
    program.set("gather_offset", offset_);
}

PointFilter::PointFilter(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "08_diffuse_cones/filter.frag"}))
{
}

const gl::Texture& PointFilter::run(const gl::Texture& gathered, const GBuffer& g_buffer, const GatherPoints& points)
{
    gl::fit_to_pixels(rows_, rows_framebuffer_, "filtered along rows", GL_RGBA32F, points.size());
    gl::fit_to_pixels(columns_, columns_framebuffer_, "filtered light", GL_RGBA32F, points.size());
    g_buffer.bind();
    points.bind(program_);
    gathered.bind(17);
    program_.set("along", glm::ivec2(1, 0));
    gl::draw_pixels(program_, rows_framebuffer_, no_vertices_, points.size());
    rows_.bind(17);
    program_.set("along", glm::ivec2(0, 1));
    gl::draw_pixels(program_, columns_framebuffer_, no_vertices_, points.size());
    return columns_;
}

}  // namespace conebook
