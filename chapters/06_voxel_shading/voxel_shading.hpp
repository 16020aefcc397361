// Direct light on the voxels: what each occupied face sends out.
#pragma once

#include "03_shadow_map/shadow_maps.hpp"
#include "05_atomic_averaging/voxel_faces.hpp"

namespace conebook {

enum class VoxelShadows : int { none = 0, map = 1, hard_ray = 2, soft_ray = 3 };
enum class VoxelLambert : int { lambert = 0, directional = 1 };

struct VoxelShadingParams {
    // map: chapter 03's shadow maps; hard_ray, soft_ray: rays through the voxels, for comparison.
    VoxelShadows voxel_shadows = VoxelShadows::map;
    // lambert: max(n.l, 0) of the mean normal; directional: its axes one by one (Villegas 2016).
    VoxelLambert voxel_lambert = VoxelLambert::lambert;
    // soft_ray: distance in voxels at which one hit still blocks everything, 0.1 .. 100.
    float soft_sharpness = 4.0f;
    bool operator==(const VoxelShadingParams&) const = default;
};
void add_parameters(ParameterTable& table, VoxelShadingParams& params);

class VoxelShading {
public:
    explicit VoxelShading(gl::Shaders& shaders);

    // L = rho/pi E of every face, one thread a face by indirect dispatch, if anything that it depends on has changed; says
    // whether it has.
    bool run(const GpuScene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer,
             const VoxelFaces& faces, const ShadowMaps& shadow_maps, const VoxelShadingParams& params);
    Revision revision() const { return revision_; }

    const gl::Buffer& radiance() const { return radiance_; }      // vec4 a face: rgb reflected W/(sr m^2), a visibility 0..1
    const gl::Buffer& visibility() const { return visibility_; }  // uint a face: 4 x 8 bit, lights 0 to 3
    std::vector<gl::Resource> resources() const { return {radiance_.resource(), visibility_.resource()}; }

private:
    gl::ProgramVariants program_;
    MadeFrom<Revision, Revision, Revision, VoxelShadingParams> made_from_;  // faces, lights, shadow maps
    Revision revision_ = 0;
    gl::Buffer radiance_, visibility_;
};

}  // namespace conebook
