// The list of occupied voxels and what their faces are made of: means over all fragments, exact and repeatable.
#pragma once

#include <map>

#include "04_conservative_voxelization/conservative_voxelizer.hpp"
#include "app/statistics.hpp"
#include "gl/made_from.hpp"

namespace conebook {

// A compute shader that runs over the list of fragments, one thread a fragment, material by material, since only one
// material's textures are bound at a time; in variants that read no more than the material has.
class FragmentPrograms {
public:
    // `shaders` must outlive it.
    FragmentPrograms(gl::Shaders& shaders, const std::string& file) : shaders_(&shaders), file_(file) {}
    // `more`: defines beside those of the materials.
    void run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer,
             const gl::Defines& more = {});

private:
    const gl::Program& of(const GpuScene& scene, std::size_t material, const gl::Defines& more);
    gl::Shaders* shaders_;
    std::string file_;
    std::map<gl::Defines, gl::Program> programs_;
};

// What the programs that average are made without where the scene has none of it.
std::vector<Need> voxel_material_needs(const GpuScene& scene);

// Lists of what is occupied. Passes over voxels work on these instead of on the whole grid.
class VoxelFaces {
public:
    // `shaders` and `voxelizer` must outlive it.
    VoxelFaces(gl::Shaders& shaders, const ConservativeVoxelizer& voxelizer);

    // Make the lists from voxelizer.occupancy(), add up all fragments, divide. Reads two counters back to the CPU to
    // size the buffers; throws std::runtime_error when there are more faces than an index (2^26) or a storage block
    // holds. Does nothing while the voxelizer has not run again; says whether it did.
    // `voxelizer`: the one of the constructor.
    bool run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer);

    // Changes whenever the lists or the means do.
    Revision revision() const { return revision_; }
    std::size_t voxel_count() const { return counted_.voxels; }
    std::size_t face_count() const { return counted_.faces; }
    const shared::VoxelStatistics& counted() const { return counted_; }

    const gl::Texture& face_index() const { return face_index_; }      // r32ui, grid size: first face << 6 | mask
    const gl::Buffer& voxel_list() const { return voxel_list_; }       // uint a voxel: pack_voxel()
    const gl::Buffer& face_list() const { return face_list_; }         // uint a face: pack_voxel() | face << 27
    const gl::Buffer& faces() const { return faces_; }                 // shared::VoxelFace a face
    const gl::Buffer& statistics_buffer() const { return *statistics_; }
    const gl::Buffer& face_groups() const { return face_groups_; }     // indirect dispatch: 64 faces a work group
    const gl::Buffer& voxel_groups() const { return voxel_groups_; }   // indirect dispatch: 64 voxels a work group
    // Frees the sums, of which the means are all that the light needs; the next run makes them anew.
    void free_scratch() { sums_ = {}; }
    std::vector<gl::Resource> resources() const;

    // kVoxelCounterBinding, kVoxelListBinding, kFaceListBinding, kFaceBinding, kFaceIndexUnit.
    void bind() const;

private:
    void allocate(const VoxelGrid& grid);
    void make_lists(const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer);
    gl::Program count_blocks_, scan_blocks_, write_list_, resolve_;
    FragmentPrograms accumulate_;
    gl::Texture face_index_;
    gl::Buffer block_counts_, voxel_list_, face_list_, sums_, faces_, face_groups_, voxel_groups_;
    const gl::Buffer* statistics_;  // of the voxelizer
    shared::VoxelStatistics counted_{};
    MadeFrom<Revision> made_from_;
    Revision revision_ = 0;
};

// Which part of a face to show.
struct FaceQuantity {
    const gl::Buffer* buffer = nullptr;  // of vec4
    int stride = 1, offset = 0;          // in vec4
    int show = 0;                        // 0 colour, 1 direction, 2 alpha, 3 `packed` instead, 4 their difference
    const gl::Texture* packed = nullptr;
    const gl::Buffer* plus = nullptr;    // added, as `buffer` with the next two
    int plus_stride = 1, plus_offset = 0;
};

class FaceViewPass {
public:
    explicit FaceViewPass(gl::Shaders& shaders);
    // RGBA32F, alpha 0 where no voxel is met.
    const gl::Texture& run(const VoxelGrid& grid, const gl::Texture& occupancy, const VoxelFaces& faces,
                           const FaceQuantity& quantity, const gl::Buffer& camera, glm::ivec2 size);

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
