#include "04_conservative_voxelization/conservative_voxelizer.hpp"

#include <algorithm>
#include <stdexcept>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, VoxelizerParams& params)
{
    table.add("voxelizer", params.voxelizer, {"raster", "compute"}, "who finds the columns; both give the same voxels");
}

void add_parameters(ParameterTable& table, VoxelViewParams& params)
{
    table.add("level", params.level, 0, 6, "", "level of the pyramid that voxel views show, 0 = finest");
    table.add("shaded", params.shaded, "voxel view: shade the cubes");
}

void for_each_column(const gl::Program& program, Voxelizer voxelizer, const GpuScene& scene, const VoxelGrid& grid,
                     const gl::Framebuffer& column_plane)
{
    grid.bind();
    if (voxelizer == Voxelizer::compute) {
        scene.dispatch_triangles(program);
        return;
    }
    const glm::ivec3 size = grid.size();
    column_plane.bind(glm::ivec2(std::max({size.x, size.y, size.z})));
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    scene.draw(program, Culling::none);
}

namespace {

gl::Program load_mark(gl::Shaders& shaders, const VoxelizerParams& params)
{
    const gl::Defines defines = {{"CONSERVATIVE", params.conservative ? "1" : "0"},
                                 {"COUNT_FRAGMENTS", params.count_fragments ? "1" : "0"},
                                 {"ATTRIBUTES", "0"}};
    if (Voxelizer(params.voxelizer) == Voxelizer::compute) {
        if (!params.conservative) throw std::runtime_error("conservative=off is for voxelizer=raster only");
        return shaders.load({"04_conservative_voxelization/mark.comp"}, defines);
    }
    return shaders.load({"04_conservative_voxelization/conservative.vert",
                         "04_conservative_voxelization/conservative.geom", "04_conservative_voxelization/mark.frag"},
                        defines);
}

}  // namespace

ConservativeVoxelizer::ConservativeVoxelizer(gl::Shaders& shaders, const VoxelGrid& grid, const VoxelizerParams& params)
    : voxelizer_(Voxelizer(params.voxelizer)),
      mark_(load_mark(shaders, params)),
      next_level_(shaders.load({"04_conservative_voxelization/occupancy_level.comp"})),
      occupancy_(gl::texture_3d("occupancy", GL_R32UI, grid.size(), grid.levels())),
      statistics_("voxel statistics", sizeof(shared::VoxelStatistics)),
      column_plane_("column plane", glm::ivec2(std::max({grid.size().x, grid.size().y, grid.size().z})))
{
    if (params.count_fragments) fragment_counts_ = gl::texture_3d("fragment counts", GL_R32UI, grid.size());
}

std::vector<gl::Resource> ConservativeVoxelizer::resources() const
{
    std::vector<gl::Resource> resources = {occupancy_.resource()};
    if (fragment_counts_) resources.push_back(fragment_counts_.resource());
    return resources;
}

bool ConservativeVoxelizer::run(const GpuScene& scene, const VoxelGrid& grid)
{
    if (!made_from_.differs(scene.geometry_revision())) return false;
    ++revision_;
    // Clear what the last frame marked.
    occupancy_.clear();
    statistics_.clear();
    if (fragment_counts_) {
        fragment_counts_.clear();
        fragment_counts_.bind_image(1, 0, GL_READ_WRITE);
    }

    // Mark every voxel that a triangle overlaps.
    statistics_.bind(GL_SHADER_STORAGE_BUFFER, shared::kVoxelCounterBinding);
    occupancy_.bind_image(0, 0, GL_READ_WRITE);
    for_each_column(mark_, voxelizer_, scene, grid, column_plane_);

    // Carry the marks to the coarser levels.
    next_level_.use();
    for (int level = 1; level < grid.levels(); ++level) {
        glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
        occupancy_.bind_image(0, level - 1, GL_READ_ONLY);
        occupancy_.bind_image(1, level, GL_WRITE_ONLY);
        const glm::ivec3 groups = (glm::max(grid.size() >> level, glm::ivec3(1)) + 3) / 4;
        glDispatchCompute(GLuint(groups.x), GLuint(groups.y), GLuint(groups.z));
    }
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                    GL_SHADER_STORAGE_BARRIER_BIT);
    return true;
}

VoxelViewPass::VoxelViewPass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "04_conservative_voxelization/voxel_view.frag"}))
{
}

const gl::Texture& VoxelViewPass::run(const VoxelGrid& grid, const gl::Texture& occupancy,
                                      const VoxelViewParams& params, const gl::Buffer& camera, glm::ivec2 size)
{
    gl::fit_to_pixels(color_, framebuffer_, "voxel view", GL_RGBA16F, size);
    grid.bind();
    camera.bind(GL_UNIFORM_BUFFER, shared::kCameraBlock);
    occupancy.bind(shared::kOccupancyUnit);
    program_.set("level", std::min(params.level, grid.levels() - 1));
    program_.set("shaded", params.shaded);
    program_.set("show_heat", params.heat != nullptr);
    (params.heat != nullptr ? *params.heat : occupancy).bind(shared::kPackedColorUnit);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, size);
    return color_;
}

}  // namespace conebook
