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
    // `more`: defines beside those of the materials. `first_face`: for programs that leave out the faces before it.
    void run(const GpuScene& scene, const VoxelGrid& grid, const FragmentList& fragments, const gl::Defines& more = {},
             GLuint first_face = 0);

private:
    const gl::Program& of(const GpuScene& scene, std::size_t material, const gl::Defines& more);
    gl::Shaders* shaders_;
    std::string file_;
    std::map<gl::Defines, gl::Program> programs_;
};

// What the programs that average are made without where the scene has none of it.
std::vector<Need> voxel_material_needs(const GpuScene& scene);

// Lists of what is occupied, and means. Passes over voxels work on these instead of on the whole grid.
struct FaceLists {
    gl::Texture face_index;              // r32ui, grid size: first face << 6 | mask
    gl::Buffer voxel_list;               // uint a voxel: pack_voxel()
    gl::Buffer face_list;                // uint a face: pack_voxel() | face << 27
    gl::Buffer sums;                     // 2 kSumCount words a face
    gl::Buffer faces;                    // shared::VoxelFace a face
    gl::Buffer face_groups, voxel_groups;  // indirect dispatch of 64 a work group
    shared::VoxelStatistics counted{};   // the same is in the voxelizer's statistics_buffer()
    // The first `kept` faces are where they are as long as `order` stays the same.
    GLuint kept = 0;
    Revision order = 0;
    void count_groups();                 // face_groups and voxel_groups from `counted`
};
// Bytes of a face in FaceLists::sums.
constexpr std::size_t kBytesOfSums = 2 * shared::kSumCount * sizeof(GLuint);

class VoxelFaces {
public:
    // `shaders` and `voxelizer` must outlive it.
    VoxelFaces(gl::Shaders& shaders, const ConservativeVoxelizer& voxelizer);

    // Make the lists from voxelizer.occupancy(), add up all fragments, divide. Reads two counters back to the CPU to
    // size the buffers; throws std::runtime_error when there are more faces than an index (2^26) or a storage block
    // holds. Does nothing while the voxelizer has not run again; says whether it did.
    // `voxelizer`: the one of the constructor.
    bool run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer);

    // Two steps of run(), for some of the faces of the lists: adds these fragments to the sums of those in faces from
    // `first_face` on; divides the sums of `count` faces from there on.
    void add(const GpuScene& scene, const VoxelGrid& grid, const FragmentList& fragments, GLuint first_face);
    void divide(const VoxelGrid& grid, GLuint first_face, GLuint count);

    // Changes whenever the lists or the means do.
    Revision revision() const { return revision_; }
    std::size_t voxel_count() const { return lists_.counted.voxels; }
    std::size_t face_count() const { return lists_.counted.faces; }
    const shared::VoxelStatistics& counted() const { return lists_.counted; }
    GLuint kept() const { return lists_.kept; }
    Revision order() const { return lists_.order; }
    // All of it, for who puts in or takes out voxels; counts up revision().
    FaceLists& edit()
    {
        ++revision_;
        return lists_;
    }

    const gl::Texture& face_index() const { return lists_.face_index; }
    const gl::Buffer& voxel_list() const { return lists_.voxel_list; }
    const gl::Buffer& face_list() const { return lists_.face_list; }
    const gl::Buffer& faces() const { return lists_.faces; }
    const gl::Buffer& statistics_buffer() const { return *statistics_; }
    const gl::Buffer& face_groups() const { return lists_.face_groups; }
    const gl::Buffer& voxel_groups() const { return lists_.voxel_groups; }
    // Frees the sums, of which the means are all that the light needs; the next run makes them anew.
    void free_scratch() { lists_.sums = {}; }
    std::vector<gl::Resource> resources() const;

    // kVoxelCounterBinding, kVoxelListBinding, kFaceListBinding, kFaceBinding, kFaceIndexUnit.
    void bind() const;

private:
    void allocate(const VoxelGrid& grid);
    void make_lists(const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer);
    gl::Program count_blocks_, scan_blocks_, write_list_, resolve_;
    FragmentPrograms accumulate_;
    FaceLists lists_;
    gl::Buffer block_counts_;
    const gl::Buffer* statistics_;  // of the voxelizer
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
