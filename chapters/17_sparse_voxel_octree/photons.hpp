// Direct light of the voxels' faces as flux: what a light sends out is handed out texel by texel of its view.
#pragma once

#include "03_shadow_map/shadow_maps.hpp"
#include "17_sparse_voxel_octree/octree.hpp"

namespace conebook {

struct PhotonParams {
    // Texels along a side of a light's view (a point light has six), 64 .. 8192: each is a photon. A face should be
    // seen by several, or what it gets depends on where texels lie.
    int photon_map_size = 1024;
    bool operator==(const PhotonParams&) const = default;
};
void add_parameters(ParameterTable& table, PhotonParams& params);

class Photons {
public:
    explicit Photons(gl::Shaders& shaders);

    // Draws the views of all lights and hands their flux out, if the tree, the lights or a parameter have changed; says
    // whether it did.
    bool run(const GpuScene& scene, const VoxelGrid& grid, const VoxelFaces& faces, const Octree& tree,
             const PhotonParams& params);
    void forget() { made_from_.forget(); }
    Revision revision() const { return revision_; }

    const gl::Buffer& radiance() const { return radiance_; }  // vec4 a face: rgb (rho / pi) E, W/(sr m^2)
    const gl::Buffer& irradiance() const
    {
        return irradiance_;
    }                               // vec4 a face: flux over the voxel's side squared, W/m^2
    glm::dvec3 total_flux() const;  // W, of all faces; waits for the GPU
    std::vector<gl::Resource> resources() const
    {
        return {view_.resource(), flux_.resource(), radiance_.resource(), irradiance_.resource()};
    }

private:
    void draw(const GpuScene& scene, const glm::mat4& clip_from_scene, int size);
    gl::Program depth_, inject_, light_;
    gl::Texture view_;
    gl::Framebuffer framebuffer_;
    gl::Buffer flux_, radiance_, irradiance_;
    float flux_unit_ = 1.0f;                                // W
    MadeFrom<Revision, Revision, PhotonParams> made_from_;  // tree, lights
    Revision revision_ = 0;
};

}  // namespace conebook
