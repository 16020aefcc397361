#include "16_only_what_is_needed/brick_storage.hpp"

namespace conebook {

void add_storage_parameter(ParameterTable& table, SceneLightParams& params)
{
    table.add("storage", params.voxels.pyramid.storage, {"dense", "bricks"},
              "volumes for all voxels, or lists of those that hold something");
}

std::vector<gl::Resource> BrickStorage::resources() const
{
    if (params_.voxels.pyramid.storage == VoxelStorage::dense) return {};
    std::vector<gl::Resource> all = light_.index().resources();
    for (const gl::Resource& resource : walk_.resources()) all.push_back(resource);
    return all;
}

}  // namespace conebook
