// Which voxels do the triangles touch? All of them, however little, and no others.
#pragma once

#include "04_conservative_voxelization/voxel_grid.hpp"
#include "gl/gpu_scene.hpp"

namespace conebook {

enum class Voxelizer : int { raster = 0, compute = 1 };

struct VoxelizerParams {
    // raster: geometry shader and rasterizer find the columns; compute: a thread or some work groups a triangle. Both
    // give the same voxels; small triangles cost a software driver a third in compute shaders.
    Voxelizer voxelizer = Voxelizer::compute;
    // false: plain rasterization, a pixel's centre and one voxel in depth; leaves holes. For chapter 04's comparison.
    bool conservative = true;
    // Keep how many fragments fell into each voxel: fragment_counts(). Costs a volume; for chapter 04's views.
    bool count_fragments = false;
    bool operator==(const VoxelizerParams&) const = default;
};
// Enters `voxelizer`; the other two are chapter 04's own business.
void add_parameters(ParameterTable& table, VoxelizerParams& params);

// Pairs of a triangle and a voxel that overlap, as uvec2(triangle, pack_voxel()), in any order within a material; and
// where those of each material are.
class FragmentList {
public:
    // An empty list with room for so many of each material. Throws std::runtime_error when it would be longer than the
    // driver's storage blocks.
    void make_room(const std::vector<std::size_t>& of_materials);
    void clear();
    void bind() const;  // kFragmentBinding, kFragmentRangeBinding
    // Reads back how many the GPU has found; false, and room made for them, where there was no room for all.
    bool take_counts();

    const gl::Buffer& buffer() const { return fragments_; }
    const std::vector<shared::FragmentRange>& ranges() const { return ranges_; }
    std::size_t count() const;
    gl::Resource resource() const { return fragments_.resource(); }

private:
    std::vector<shared::FragmentRange> ranges_;  // as the GPU left them
    gl::Buffer fragments_, range_buffer_;
};

class ConservativeVoxelizer {
public:
    explicit ConservativeVoxelizer(gl::Shaders& shaders);

    // Fill occupancy() and its levels, and the list of fragments, from the scene's triangles if these, the grid or a
    // parameter have changed; says whether they have. Reads counters back to the CPU to size the list. Throws
    // std::runtime_error when it would be longer than the driver's storage blocks, and for parameters that do not go
    // together.
    bool run(const GpuScene& scene, const VoxelGrid& grid, const VoxelizerParams& params);
    // The same for some of the triangles, whatever has changed.
    void make(const GpuScene& scene, const VoxelGrid& grid, const VoxelizerParams& params,
              const std::vector<Range>& triangles);
    // Marks these triangles too, at level 0, and puts their fragments into `list`. `counters`: one shared::VoxelStatistics.
    void add(const GpuScene& scene, const VoxelGrid& grid, const VoxelizerParams& params,
             const std::vector<Range>& triangles, const gl::Buffer& counters, FragmentList& list);
    void forget() { made_from_.forget(); }  // the next run fills them whatever has changed, for measuring
    Revision revision() const { return revision_; }
    // Frees the fragments, which only chapter 05 needs, and the occupancy where nobody looks into it; the next run makes
    // them anew.
    void free_scratch(bool occupancy_too);

    // r32ui, grid size: fragments in each voxel. Only with VoxelizerParams::count_fragments.
    const gl::Texture& fragment_counts() const { return fragment_counts_; }

    // r32ui, grid size, all levels: bit f is set when a triangle whose front (or, double-sided, back) faces direction f
    // overlaps the voxel; 0 is empty.
    const gl::Texture& occupancy() const { return occupancy_; }
    const gl::Buffer& statistics_buffer() const { return statistics_; }  // one shared::VoxelStatistics

    const FragmentList& fragments() const { return fragments_; }
    std::vector<gl::Resource> resources() const;

private:
    void allocate(const VoxelGrid& grid, const VoxelizerParams& params);
    void mark(const GpuScene& scene, const VoxelGrid& grid, const VoxelizerParams& params,
              const std::vector<Range>& triangles, const gl::Buffer& counters, FragmentList& list);
    MadeFrom<Revision, Revision, VoxelizerParams> made_from_;  // geometry, grid
    MadeFrom<Revision> room_for_;                              // grid
    Revision revision_ = 0;
    gl::ProgramVariants raster_mark_, mark_small_, mark_large_;
    gl::Program next_level_;
    gl::Texture occupancy_, fragment_counts_;
    gl::Buffer statistics_, large_triangles_;
    FragmentList fragments_;
    gl::Framebuffer column_plane_;               // no attachments: the fragments write the volume
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
