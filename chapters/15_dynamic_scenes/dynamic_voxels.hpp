// Voxels of what moves among those of what stands still, in the same volumes: what stands still is voxelized once, what
// moves is taken out of its last voxels and put into its new ones.
#pragma once

#include "12_second_bounce/bounces.hpp"
#include "15_dynamic_scenes/dynamic_structs.glsl"

namespace conebook {

// Where what moves and what stands still are in the same voxel. merge: its faces are means over both; drop: what stands
// still has it alone, for comparison (Villegas 2016, section 3.3.3).
enum class Overlap : int { merge = 0, drop = 1 };

struct DynamicVoxelParams {
    Overlap overlap = Overlap::merge;
    bool operator==(const DynamicVoxelParams&) const = default;
};
void add_parameters(ParameterTable& table, DynamicVoxelParams& params);

// Triangles [first, first + count) of the nodes that may move, and all others.
struct TriangleSets {
    std::vector<Range> still, moving;
};
TriangleSets triangle_sets(const Scene& scene);

class DynamicVoxels {
public:
    explicit DynamicVoxels(gl::Shaders& shaders);

    // The voxels and faces of `voxels` as LitVoxels::voxelize() makes them, but for the order of the lists; each of
    // the steps if something that it depends on has changed. Reads counters back to the CPU. Throws as
    // ConservativeVoxelizer and VoxelFaces do. `source` is the scene that `scene` was made from. Gives what of the
    // faces has changed, when it was what moves alone.
    FaceChange run(App& app, const Scene& source, const GpuScene& scene, LitVoxels& voxels,
                   const DynamicVoxelParams& params);

    const shared::DynamicCounts& counted() const { return counted_; }
    std::vector<gl::Resource> resources() const;
    std::vector<Count> counts() const;

private:
    void take_out(const LitVoxels::Parts& parts, FaceLists& lists);
    void put_in(const GpuScene& scene, const LitVoxels::Parts& parts, FaceLists& lists);
    void count_again(const LitVoxels::Parts& parts, FaceLists& lists) const;
    FaceChange change_since(Revision from, Revision to) const;
    void carry_up(const LitVoxels::Parts& parts);

    gl::Program take_out_, put_in_, above_;
    gl::ProgramVariants collect_;
    DynamicVoxelParams params_;  // of the last run
    TriangleSets triangles_;
    FragmentList fragments_;        // of what moves
    gl::Buffer counters_, counts_;  // of its voxelization; of its list of voxels
    gl::Buffer list_, last_list_;   // shared::DynamicVoxel
    shared::DynamicCounts counted_{}, last_counted_{};
    shared::VoxelStatistics still_{};                               // of what stands still
    MadeFrom<Revision, Revision, VoxelizerParams> still_from_;      // what stands still, grid
    MadeFrom<Revision, Revision, DynamicVoxelParams> moving_from_;  // voxels of what stands still, geometry
    Revision still_revision_ = 0;
};

}  // namespace conebook
