#include "07_anisotropic_mips/lit_voxels.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, LitVoxelParams& params)
{
    add_parameters(table, params.grid);
    add_parameters(table, params.voxelizer);
    add_parameters(table, params.shading);
    add_parameters(table, params.pyramid);
    table.add("voxelize_every_frame", params.voxelize_every_frame, "voxelize again in every frame, for measuring");
}

LitVoxels::LitVoxels(gl::Shaders& shaders, const GpuScene& scene, const LitVoxelParams& params)
    : every_frame_(params.voxelize_every_frame),
      grid_(scene.bounds(), params.grid, shared::kFaceCount),
      voxelizer_(shaders, grid_, params.voxelizer),
      faces_(shaders, grid_, voxelizer_),
      shading_(shaders, params.shading),
      pyramid_(shaders, grid_, params.pyramid)
{
}

void LitVoxels::run(App& app, const GpuScene& scene, const ShadowMaps& shadow_maps, LightPart part)
{
    are_new_ = app.frame() == 0 || every_frame_;
    if (are_new_) {
        // Triangles -> occupied voxels -> mean material of their faces.
        app.pass("voxelize", [&] { voxelizer_.run(scene, grid_); });
        app.pass("average", [&] { faces_.run(scene, grid_, voxelizer_); });
        pyramid_.prepare(grid_, faces_);
    }
    // Material and lights -> radiance of the faces -> radiance of all levels.
    app.pass("voxel shading", [&] { shading_.run(scene, grid_, voxelizer_, faces_, shadow_maps); });
    app.pass("light pyramid", [&] { pyramid_.run(grid_, faces_, shading_.radiance(), part); });
}

std::vector<gl::Resource> LitVoxels::resources() const
{
    std::vector<gl::Resource> all = voxelizer_.resources();
    for (const auto& part : {faces_.resources(), shading_.resources(), pyramid_.resources()})
        all.insert(all.end(), part.begin(), part.end());
    return all;
}

std::vector<Count> LitVoxels::counts() const
{
    const shared::VoxelStatistics& counted = faces_.counted();
    const glm::ivec3 size = grid_.size();
    return {{"grid x", double(size.x), "voxels"},
            {"grid y", double(size.y), "voxels"},
            {"grid z", double(size.z), "voxels"},
            {"voxel size", grid_.voxel_size_m(), "m"},
            {"occupied voxels", double(counted.voxels), ""},
            {"occupied faces", double(counted.faces), ""},
            {"fragments", double(voxelizer_.fragment_count()), ""},
            {"triangles without area", double(counted.degenerate), ""}};
}

}  // namespace conebook
