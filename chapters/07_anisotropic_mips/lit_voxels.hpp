// Chapters 04 to 07 in order: triangles -> voxels -> faces -> the light that they reflect -> pyramids.
#pragma once

#include "07_anisotropic_mips/light_pyramid.hpp"
#include "app/app.hpp"

namespace conebook {

// on_change: a pass runs when something that its result depends on has changed; always: in every frame, for measuring.
enum class Update : int { on_change = 0, always = 1 };

struct LitVoxelParams {
    VoxelGridParams grid;
    VoxelizerParams voxelizer;
    VoxelShadingParams shading;
    PyramidParams pyramid;
    Update update = Update::on_change;
};
void add_parameters(ParameterTable& table, LitVoxelParams& params);

class LitVoxels {
public:
    // `params` must outlive this. `storage`: of the pyramid, where params.pyramid.storage > 0.
    LitVoxels(gl::Shaders& shaders, const GpuScene& scene, const LitVoxelParams& params, LightStorage storage = {});
    // Triangles -> occupied voxels -> mean material of their faces; all that follows from them runs when they do.
    void voxelize(App& app, const GpuScene& scene);
    // What the faces reflect of the light that comes straight from the lights.
    void shade(App& app, const GpuScene& scene, const ShadowMaps& shadow_maps);
    // What the voxels cover, without light: for rays that start before the light is known.
    void filter_coverage(App& app);
    // The pyramids of that part of their light, or of `reflected` instead of what shade() made.
    void filter(App& app, LightPart part = LightPart::all);
    void filter(App& app, const gl::Buffer& reflected, Revision revision, LightPart part);

    // For who makes voxels and faces otherwise than voxelize() does.
    struct Parts {
        const LitVoxelParams& params;
        VoxelGrid& grid;
        ConservativeVoxelizer& voxelizer;
        VoxelFaces& faces;
    };
    Parts parts() { return {params_, grid_, voxelizer_, faces_}; }
    // Frees what only voxelization needs. What it made stays.
    void free_scratch();

    const VoxelGrid& grid() const { return grid_; }
    const ConservativeVoxelizer& voxelizer() const { return voxelizer_; }
    const VoxelFaces& faces() const { return faces_; }
    const VoxelShading& shading() const { return shading_; }
    const LightPyramid& pyramid() const { return pyramid_; }
    // Changes whenever what filter_coverage() makes does.
    Revision coverage_revision() const { return coverage_revision_; }
    std::vector<gl::Resource> resources() const;
    std::vector<Count> counts() const;

private:
    // Whether rays or pixels look into the occupancy; the pyramids of other storages than the atlas know it themselves.
    bool needs_occupancy() const;
    const LitVoxelParams& params_;
    VoxelGrid grid_;
    ConservativeVoxelizer voxelizer_;
    VoxelFaces faces_;
    VoxelShading shading_;
    LightPyramid pyramid_;
    MadeFrom<Revision, PyramidParams> covered_by_;  // faces
    Revision coverage_revision_ = 0;
};

}  // namespace conebook
