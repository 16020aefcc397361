// Where the voxels are: a tight grid of cubic voxels around the scene.
#pragma once

#include "app/parameters.hpp"
#include "common/bindings.glsl"
#include "common/voxel_structs.glsl"
#include "gl/handles.hpp"
#include "gl/made_from.hpp"
#include "scene/scene.hpp"

namespace conebook {

struct VoxelGridParams {
    int voxels = 128;  // along the longest side, 4 .. 512; memory grows with its cube, detail in proportion
};
void add_parameters(ParameterTable& table, VoxelGridParams& params);

// Voxel size v = longest side / (voxels - 1): the outermost surfaces lie in the middle of the outermost voxels, so that
// a wall on the boundary is held by one layer of voxels, whole; along the other axes about so. Each side is then padded
// to a multiple of 2^(levels - 1), so that the levels of the pyramid halve exactly; the padding stays empty.
shared::GridData make_grid(const Bounds& bounds, const VoxelGridParams& params);

// The grid as passes bind it: kGridBlock (shaders/common/voxel_grid.glsl).
class VoxelGrid {
public:
    // `volumes_along_x`: how many volumes of the grid's size passes put side by side along x in one texture. Throws
    // std::runtime_error, which names the parameter and the limit, where the driver has no 3D textures of that size.
    VoxelGrid(const Bounds& bounds, const VoxelGridParams& params, int volumes_along_x = 1);
    // Another grid, if bounds or parameters are others than before.
    void fit(const Bounds& bounds, const VoxelGridParams& params);
    // This one, wherever the scene is.
    void fit(const shared::GridData& data);
    Revision revision() const { return revision_; }
    const shared::GridData& data() const { return data_; }
    glm::ivec3 size() const { return glm::ivec3(data_.size); }
    int levels() const { return data_.size.w; }
    float voxel_size_m() const { return data_.origin.w; }
    void bind() const { buffer_.bind(GL_UNIFORM_BUFFER, shared::kGridBlock); }

private:
    int volumes_along_x_;
    MadeFrom<glm::vec3, glm::vec3, int> made_from_;  // bounds, voxels
    Revision revision_ = 0;
    shared::GridData data_;
    gl::Buffer buffer_;
};

}  // namespace conebook
