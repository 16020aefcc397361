// Glossy reflection: one cone a pixel along the mirror direction.
#pragma once

#include "08_diffuse_cones/diffuse_cones.hpp"

namespace conebook {

struct SpecularConeParams {
    // Share of the GGX lobe that the cone holds, 0.1 .. 0.95: larger is blurrier, smaller misses the lobe's long tail.
    float lobe_share = 0.75f;
    // Voxels from the middle of the surface's own voxel to the cone's start, 0 .. 8: a narrow cone that starts nearer shows
    // the voxels of its own surface as a pattern.
    float specular_start = 1.5f;
};
void add_parameters(ParameterTable& table, SpecularConeParams& params);

class SpecularCones {
public:
    explicit SpecularCones(gl::Shaders& shaders);

    // RGBA16F of the g-buffer's size: radiance towards the camera.
    const gl::Texture& run(const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid,
                           const ConeParams& cone_params, const SpecularConeParams& params);
    std::vector<gl::Resource> resources() const { return {specular_.resource(), directional_albedo_.resource()}; }

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture directional_albedo_, specular_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
