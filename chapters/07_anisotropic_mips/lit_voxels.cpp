#include "07_anisotropic_mips/lit_voxels.hpp"

#include <utility>

namespace conebook {

void add_parameters(ParameterTable& table, LitVoxelParams& params)
{
    add_parameters(table, params.grid);
    add_parameters(table, params.voxelizer);
    add_parameters(table, params.shading);
    add_parameters(table, params.pyramid);
    table.add("update", params.update, {"on_change", "always"}, "when passes run that do not depend on the camera");
}

LitVoxels::LitVoxels(gl::Shaders& shaders, const GpuScene& scene, const LitVoxelParams& params, LightStorage storage)
    : params_(params),
      grid_(scene.bounds(), params.grid, shared::kFaceCount),
      voxelizer_(shaders),
      faces_(shaders, voxelizer_),
      shading_(shaders),
      pyramid_(shaders, std::move(storage))
{
}

bool LitVoxels::needs_occupancy() const
{
    const VoxelShadows shadows = params_.shading.voxel_shadows;
    return params_.pyramid.storage == VoxelStorage::dense || shadows == VoxelShadows::hard_ray ||
           shadows == VoxelShadows::soft_ray;
}

void LitVoxels::free_scratch()
{
    voxelizer_.free_scratch(!needs_occupancy());
    faces_.free_scratch();
}

void LitVoxels::voxelize(App& app, const GpuScene& scene)
{
    grid_.fit(scene.bounds(), params_.grid);
    const bool missing = needs_occupancy() && !voxelizer_.occupancy();
    if (params_.update == Update::always || missing) voxelizer_.forget();
    app.pass("voxelize", Scope::scene, [&] { return voxelizer_.run(scene, grid_, params_.voxelizer); });
    app.pass("average", Scope::scene, [&] { return faces_.run(scene, grid_, voxelizer_); });
}

void LitVoxels::shade(App& app, const GpuScene& scene, const ShadowMaps& shadow_maps)
{
    app.pass("voxel shading", Scope::light,
             [&] { return shading_.run(scene, grid_, voxelizer_, faces_, shadow_maps, params_.shading); });
}

void LitVoxels::filter_coverage(App& app)
{
    app.pass("coverage of voxels", Scope::scene, [&] {
        if (!covered_by_.differs(faces_.revision(), params_.pyramid)) return false;
        ++coverage_revision_;
        return pyramid_.run(grid_, faces_, shading_.radiance(), shading_.revision(), params_.pyramid, LightPart::none);
    });
}

void LitVoxels::filter(App& app, LightPart part) { filter(app, shading_.radiance(), shading_.revision(), part); }

void LitVoxels::filter(App& app, const gl::Buffer& reflected, Revision revision, LightPart part)
{
    app.pass("light pyramid", Scope::light,
             [&] { return pyramid_.run(grid_, faces_, reflected, revision, params_.pyramid, part); });
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
            {"fragments", double(voxelizer_.fragments().count()), ""},
            {"triangles without area", double(counted.degenerate), ""}};
}

}  // namespace conebook
