#include "04_conservative_voxelization/voxel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace conebook {

void add_parameters(ParameterTable& table, VoxelGridParams& params)
{
    table.add("voxels", params.voxels, 4, 512, "voxels", "along the longest side of the scene");
}

shared::GridData make_grid(const Bounds& bounds, const VoxelGridParams& params)
{
    const float longest = std::max(bounds.longest_side(), 1e-6f);  // a scene that is one point still has a size
    const float voxel_size = longest / float(params.voxels - 1);
    constexpr int kMaxLevels = 7;  // the coarsest voxel is 64 fine ones
    const int levels = std::clamp(int(std::log2(float(params.voxels))), 1, kMaxLevels);
    const int multiple = 1 << (levels - 1);
    const glm::vec3 extent = bounds.extent() / voxel_size;  // in voxels
    glm::ivec3 size;
    glm::vec3 margin;  // from the outer side of the first voxel to the bounds, and at the other end as well
    for (int axis = 0; axis < 3; ++axis) {
        // 0.35 to 0.85 voxels, 0.5 along the longest side: never on the side between two voxels.
        constexpr float kLeastMargins = 0.7f;
        const float needed = std::ceil(extent[axis] + kLeastMargins);
        margin[axis] = 0.5f * (needed - extent[axis]);
        size[axis] = (int(needed) + multiple - 1) / multiple * multiple;
    }
    shared::GridData grid{};
    grid.origin = glm::vec4(bounds.min - margin * voxel_size, voxel_size);
    grid.size = glm::ivec4(size, levels);
    grid.content_min = glm::vec4(margin, 0.0f);
    grid.content_max = glm::vec4(margin + extent, 0.0f);
    return grid;
}

namespace {

shared::GridData grid_within_limits(const Bounds& bounds, VoxelGridParams params, int volumes_along_x)
{
    GLint most = 0;
    glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &most);
    const auto longest_side = [&](const shared::GridData& grid) {
        return std::max({grid.size.x * volumes_along_x, grid.size.y, grid.size.z});
    };
    const shared::GridData grid = make_grid(bounds, params);
    if (longest_side(grid) <= most) return grid;
    const int asked = params.voxels;
    while (params.voxels > 4 && longest_side(make_grid(bounds, params)) > most) --params.voxels;
    throw std::runtime_error("voxels=" + std::to_string(asked) + ": this driver's 3D textures have at most " +
                             std::to_string(most) + " texels a side (GL_MAX_3D_TEXTURE_SIZE), " +
                             std::to_string(longest_side(grid)) + " are needed; use at most voxels=" +
                             std::to_string(params.voxels));
}

}  // namespace

VoxelGrid::VoxelGrid(const Bounds& bounds, const VoxelGridParams& params, int volumes_along_x)
    : volumes_along_x_(volumes_along_x)
{
    fit(bounds, params);
}

void VoxelGrid::fit(const Bounds& bounds, const VoxelGridParams& params)
{
    if (!made_from_.differs(bounds.min, bounds.max, params.voxels)) return;
    ++revision_;
    data_ = grid_within_limits(bounds, params, volumes_along_x_);
    buffer_ = gl::Buffer("voxel grid", sizeof data_, &data_);
}

void VoxelGrid::fit(const shared::GridData& data)
{
    if (buffer_ && data.origin == data_.origin && data.size == data_.size && data.content_min == data_.content_min &&
        data.content_max == data_.content_max)
        return;
    made_from_.forget();
    ++revision_;
    data_ = data;
    buffer_ = gl::Buffer("voxel grid", sizeof data_, &data_);
}

}  // namespace conebook
