// Light in the octree: voxels -> tree -> bricks, and what other surfaces send by cones through them, as often as asked.
#pragma once

#include "07_anisotropic_mips/lit_voxels.hpp"
#include "08_diffuse_cones/diffuse_cones.hpp"
#include "17_sparse_voxel_octree/brick_pool.hpp"
#include "17_sparse_voxel_octree/photons.hpp"

namespace conebook {

// faces: chapter 06's direct light, at the middle of each face; photons: flux from the lights' views.
enum class Injection : int { faces = 0, photons = 1 };

struct TreeLightParams {
    VoxelGridParams grid;
    VoxelizerParams voxelizer;
    VoxelShadingParams shading;
    ShadowMapParams shadow_maps;
    OctreeParams tree;
    BrickParams bricks;
    Injection injection = Injection::faces;
    PhotonParams photons;
    // Indirect bounces, 0 .. 64, or -1: until nothing changes any more; as in chapter 12.
    int bounces = -1;
    // -1 stops when no face changes by more than this share of the brightest one, 1e-6 .. 0.1.
    float tolerance = 1e-3f;
    // Cones of every face, for the bounces from voxel to voxel: 1, 5, 9 or 16.
    int links = 5;
    Update update = Update::on_change;
};
void add_parameters(ParameterTable& table, TreeLightParams& params);

// Those of chapter 08's parameters that cones through the octree have.
void add_tree_cone_parameters(ParameterTable& table, ConeParams& params);

class TreeLight {
public:
    // `shaders` and `params` must outlive this.
    TreeLight(gl::Shaders& shaders, const GpuScene& scene, const TreeLightParams& params);

    // Voxels -> tree -> direct light of the faces -> bricks, and from there as many bounces as asked for. Each pass
    // runs when something that it depends on has changed. `shows_photons`: they are wanted, whatever injection= says.
    void run(App& app, const GpuScene& scene, const ShadowMaps& shadow_maps, const ConeParams& cones,
             bool shows_photons);

    // For programs that include shaders/17_sparse_voxel_octree/cone.glsl.
    void bind(const gl::Program& program) const;
    const VoxelGrid& grid() const { return grid_; }
    const ConservativeVoxelizer& voxelizer() const { return voxelizer_; }
    const VoxelFaces& faces() const { return faces_; }
    const VoxelShading& shading() const { return shading_; }
    const Octree& tree() const { return tree_; }
    const BrickPool& bricks() const { return bricks_; }
    const Photons& photons() const { return photons_; }
    // vec4 a face: what it reflects after all bounces from voxel to voxel, W/(sr m^2).
    const gl::Buffer& reflected() const { return few_bounces() ? direct() : reflected_; }
    Revision revision() const { return bricks_.revision(); }
    std::vector<gl::Resource> resources() const;
    std::vector<Count> counts() const;

private:
    bool few_bounces() const { return params_.bounces == 0 || params_.bounces == 1; }
    bool by_photons() const { return params_.injection == Injection::photons; }
    // What the faces reflect of light straight from the lights.
    const gl::Buffer& direct() const { return by_photons() ? photons_.radiance() : shading_.radiance(); }
    Revision direct_revision() const { return by_photons() ? photons_.revision() : shading_.revision(); }
    bool bounce(const ConeParams& cones);
    const TreeLightParams& params_;
    VoxelGrid grid_;
    ConservativeVoxelizer voxelizer_;
    VoxelFaces faces_;
    VoxelShading shading_;
    Photons photons_;
    Octree tree_;
    BrickPool bricks_;
    gl::ProgramVariants bounce_;
    ConeDirections directions_;
    gl::Buffer reflected_, change_;
    // Tree, direct light and whose, bricks, bounces, tolerance, links, cones.
    MadeFrom<Revision, Revision, Injection, BrickParams, int, float, int, ConeParams> bounced_from_;
    Revision bounced_ = 0;
    int bounce_count_ = 0;
};

}  // namespace conebook
