// The first half of every later frame, chapters 04 to 07 in order: triangles -> voxels -> faces -> light -> pyramids.
#pragma once

#include "07_anisotropic_mips/light_pyramid.hpp"
#include "app/app.hpp"

namespace conebook {

struct LitVoxelParams {
    VoxelGridParams grid;
    VoxelizerParams voxelizer;
    VoxelShadingParams shading;
    PyramidParams pyramid;
    // Geometry that stands still is voxelized in the first frame only; on, it is done in every frame, for measuring.
    bool voxelize_every_frame = false;
};
void add_parameters(ParameterTable& table, LitVoxelParams& params);

class LitVoxels {
public:
    LitVoxels(gl::Shaders& shaders, const GpuScene& scene, const LitVoxelParams& params);
    // The pyramid gets that part of the faces' light.
    void run(App& app, const GpuScene& scene, const ShadowMaps& shadow_maps, LightPart part = LightPart::all);
    bool are_new() const { return are_new_; }  // the last run has voxelized

    const VoxelGrid& grid() const { return grid_; }
    const ConservativeVoxelizer& voxelizer() const { return voxelizer_; }
    const VoxelFaces& faces() const { return faces_; }
    const VoxelShading& shading() const { return shading_; }
    const LightPyramid& pyramid() const { return pyramid_; }
    LightPyramid& pyramid() { return pyramid_; }
    std::vector<gl::Resource> resources() const;
    std::vector<Count> counts() const;

private:
    bool every_frame_, are_new_ = false;
    VoxelGrid grid_;
    ConservativeVoxelizer voxelizer_;
    VoxelFaces faces_;
    VoxelShading shading_;
    LightPyramid pyramid_;
};

}  // namespace conebook
