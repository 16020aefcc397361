// Direct light with soft shadows: chapter 10's cones to the lights, through the octree.
#pragma once

#include "10_soft_shadows/soft_shadows.hpp"
#include "17_sparse_voxel_octree/tree_light.hpp"

namespace conebook {

// Of chapter 10's parameters those that there are here: maps or cones.
void add_tree_shadow_parameters(ParameterTable& table, SoftShadowParams& params);

// Pixels or voxels look into the shadow maps.
bool asks_shadow_maps(const TreeLightParams& voxels, const SoftShadowParams& pixels);

class TreeShadowLighting {
public:
    explicit TreeShadowLighting(gl::Shaders& shaders);
    // RGBA32F of the g-buffer's size: radiance of direct light. Of `cones`, start_offset counts. Valid until the next
    // call.
    const gl::Texture& run(const GBuffer& g_buffer, const GpuScene& scene, const TreeLight& light,
                           const ConeParams& cones, const SoftShadowParams& params);
    std::vector<gl::Resource> resources() const { return {color_.resource()}; }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
