// Shadows with soft edges: cones from the surface to the light, beside shadow maps and the kept visibility.
#pragma once

#include "07_anisotropic_mips/lit_voxels.hpp"
#include "08_diffuse_cones/composite.hpp"
#include "08_diffuse_cones/diffuse_cones.hpp"

namespace conebook {

enum class ShadowMethod : int { map = 0, cone = 1, volume = 2 };

struct SoftShadowParams {
    // map: chapter 03; cone: one cone a light; volume: the visibility of chapter 06 (first three lights), coarse.
    ShadowMethod shadows = ShadowMethod::map;
    // Radius of point and spot lights in m, 0.001 .. 10: glTF's lights are points, so their size is given here.
    float light_radius = 0.05f;
    // Full angle of directional lights in degrees, 0.05 .. 60; the sun's is 0.53.
    float light_angle = 0.53f;
    // Thin cones to each light, 1 .. 64: each has an edge as soft as a voxel, so that a penumbra of n voxels is even
    // with about n. 12: of 12, 16, 21, 24 and 32 the one whose nine tested penumbrae all are within 10 % of the exact
    // width (0.90 to 1.08; with more, those of 3.5 voxels are up to 1.26, since the blur of the voxels adds to them).
    int shadow_cones = 12;
    // How far cones to lights see what throws a shadow, m, 0 .. 1e6; 0: as far as the light is.
    float range_shadow = 0.0f;
    bool operator==(const SoftShadowParams&) const = default;
};
void add_parameters(ParameterTable& table, SoftShadowParams& params);

// Pixels look into the shadow maps.
inline bool asks_shadow_maps(const SoftShadowParams& pixels) { return pixels.shadows == ShadowMethod::map; }

// Shadow cones and visibility volume: which of them these parameters ask for, in a scene with lights or without.
std::vector<Need> soft_shadow_needs(const SoftShadowParams& params, bool has_lights);

class SoftShadowLighting {
public:
    explicit SoftShadowLighting(gl::Shaders& shaders);

    // RGBA32F of the g-buffer's size: radiance of direct light, or the mean visible share of the lights (0..1).
    // Of `cones`, start_offset counts.
    const gl::Texture& run(const GBuffer& g_buffer, const GpuScene& scene, const ConeVolumes& volumes,
                           const VoxelFaces& faces, const VoxelShading& shading, const ShadowMaps& shadow_maps,
                           const ConeParams& cones, const SoftShadowParams& params, bool show_visibility);
    // What run() does first where pixels ask for it.
    void fill_volume(const VoxelGrid& grid, const VoxelFaces& faces, const VoxelShading& shading);
    std::vector<gl::Resource> resources() const;

private:
    gl::ProgramVariants lighting_;
    gl::ProgramVariants fill_volume_;
    gl::VertexArray no_vertices_;
    gl::Texture visibility_volume_, color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
