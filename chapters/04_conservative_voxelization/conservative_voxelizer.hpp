// Which voxels do the triangles touch? All of them, however little, and no others.
#pragma once

#include "04_conservative_voxelization/voxel_grid.hpp"
#include "gl/gpu_scene.hpp"

namespace conebook {

enum class Voxelizer : int { raster = 0, compute = 1 };

struct VoxelizerParams {
    // raster: geometry shader and rasterizer find the columns; compute: one work group a triangle. Same voxels.
    int voxelizer = int(Voxelizer::raster);
    // false: plain rasterization, a pixel's centre and one voxel in depth; leaves holes. For chapter 04's comparison.
    bool conservative = true;
    // Keep how many fragments fell into each voxel: fragment_counts(). Costs a volume; for chapter 04's views.
    bool count_fragments = false;
};
// Enters `voxelizer`; the other two are chapter 04's own business.
void add_parameters(ParameterTable& table, VoxelizerParams& params);

// Runs a program over all columns that the triangles touch; the part that chapters 04 and 05 share. `program` is made of
// conservative.vert/.geom and a fragment shader, or of a compute shader, as `voxelizer` says.
void for_each_column(const gl::Program& program, Voxelizer voxelizer, const GpuScene& scene, const VoxelGrid& grid,
                     const gl::Framebuffer& column_plane);

class ConservativeVoxelizer {
public:
    ConservativeVoxelizer(gl::Shaders& shaders, const VoxelGrid& grid, const VoxelizerParams& params);

    // Fill occupancy() and its levels from the scene's triangles if these have changed; says whether they have.
    bool run(const GpuScene& scene, const VoxelGrid& grid);
    void forget() { made_from_.forget(); }  // the next run fills them whatever has changed, for measuring
    Revision revision() const { return revision_; }

    // r32ui, grid size: fragments in each voxel. Only with VoxelizerParams::count_fragments.
    const gl::Texture& fragment_counts() const { return fragment_counts_; }

    // r32ui, grid size, all levels: bit f is set when a triangle whose front (or, double-sided, back) faces direction f
    // overlaps the voxel; 0 is empty.
    const gl::Texture& occupancy() const { return occupancy_; }
    const gl::Buffer& statistics_buffer() const { return statistics_; }  // one shared::VoxelStatistics
    const gl::Framebuffer& column_plane() const { return column_plane_; }
    Voxelizer voxelizer() const { return voxelizer_; }
    std::vector<gl::Resource> resources() const;

private:
    MadeFrom<Revision> made_from_;
    Revision revision_ = 0;
    Voxelizer voxelizer_;
    gl::Program mark_, next_level_;
    gl::Texture occupancy_, fragment_counts_;
    gl::Buffer statistics_;
    gl::Framebuffer column_plane_;  // no attachments: the fragments write the volume
};

// Shows voxels as cubes, seen by the camera.
struct VoxelViewParams {
    int level = 0;       // 0 = finest
    bool shaded = true;  // checkered cubes lit from the camera, or flat colours by side
    // r32ui: colour the cubes by this number, 1 dark blue, 2 blue, 4 green, 8 yellow, 16 and more red (level 0 only).
    const gl::Texture* heat = nullptr;
};
void add_parameters(ParameterTable& table, VoxelViewParams& params);

class VoxelViewPass {
public:
    explicit VoxelViewPass(gl::Shaders& shaders);
    // RGBA16F of `size` pixels, alpha 0 where no voxel is met.
    const gl::Texture& run(const VoxelGrid& grid, const gl::Texture& occupancy, const VoxelViewParams& params,
                           const gl::Buffer& camera, glm::ivec2 size);

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
