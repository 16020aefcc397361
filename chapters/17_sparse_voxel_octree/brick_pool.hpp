// What the nodes of the octree hold: bricks of 3^3 samples of light and coverage, for up to six directions.
#pragma once

#include "17_sparse_voxel_octree/octree.hpp"

namespace conebook {

enum class Transfer : int { sum = 0, average = 1 };
enum class BrickFormat : int { rgba16f = 0, rgba32f = 1 };

struct BrickParams {
    // What two bricks do with a sample that they share: sum is right; average, as published, leaves a wall 0.5, 0.25
    // and 0.125 of its coverage in the middles, on edges and at corners.
    Transfer transfer = Transfer::sum;
    // rgba16f: 216 bytes a brick; rgba32f: twice that, for tests.
    BrickFormat brick_format = BrickFormat::rgba16f;
    bool operator==(const BrickParams&) const = default;
};
void add_parameters(ParameterTable& table, BrickParams& params);

class BrickPool {
public:
    explicit BrickPool(gl::Shaders& shaders);

    // Fills the bricks of all levels from what the faces reflect (vec4 a face: rgb in W/(sr m^2), of that revision) and
    // emit, if any of that has changed, and says whether it did. Throws std::runtime_error when there are more bricks
    // than the driver's textures hold.
    bool fill(const VoxelGrid& grid, const VoxelFaces& faces, const Octree& tree, const gl::Buffer& reflected,
              Revision reflected_revision, const BrickParams& params);
    void forget() { made_from_.forget(); }
    Revision revision() const { return revision_; }

    // For shaders that include cone.glsl: the tree, kBrickPoolUnit, kPyramidBlock (unit of light).
    void bind(const Octree& tree, const gl::Program& program) const;
    const gl::Texture& pool() const { return pool_; }  // texels: see bricks.glsl
    double light_unit() const;                         // W/(sr m^2) that 1 in the pool stands for; waits for the GPU
    std::vector<gl::Resource> resources() const { return {pool_.resource(), weights_.resource()}; }

private:
    void allocate(const VoxelGrid& grid, const Octree& tree, BrickFormat format);
    void dispatch(const gl::Program& program, const Octree& tree, int level);
    gl::ProgramVariants spread_, transfer_, filter_;
    gl::Program unit_;
    gl::Texture pool_;
    gl::Buffer weights_, scale_;
    MadeFrom<Revision, BrickFormat> allocated_for_;                // tree
    MadeFrom<Revision, GLuint, Revision, BrickParams> made_from_;  // tree, what the faces reflect
    Revision revision_ = 0;
};

// How much of each voxel (row 0) and of what each sample stands for (row 1 + level of spacing) lies within the scene's
// bounds, by axis: 3 values a place, rows of `depth` + 1 and 2^depth + 1 places. For shaders/.../brick_data.glsl.
std::vector<float> bound_weights(const shared::GridData& grid, int depth);

}  // namespace conebook
