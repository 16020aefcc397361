#include "17_sparse_voxel_octree/tree_shadows.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_tree_shadow_parameters(ParameterTable& table, SoftShadowParams& params)
{
    table.add("shadows", params.shadows, {"map", "cone"}, "how direct light is shadowed");
    table.add("light_radius", params.light_radius, 0.001, 10.0, "m", "radius of point and spot lights, for cones");
    table.add("light_angle", params.light_angle, 0.05, 60.0, "deg", "full angle of directional lights, for cones");
    table.add("shadow_cones", params.shadow_cones, 1, 64, "cones", "to each light, each thin");
}

bool asks_shadow_maps(const TreeLightParams& voxels, const SoftShadowParams& pixels)
{
    const bool by_voxels = voxels.injection == Injection::faces && voxels.shading.voxel_shadows == VoxelShadows::map;
    return asks_shadow_maps(pixels) || by_voxels;
}

TreeShadowLighting::TreeShadowLighting(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "17_sparse_voxel_octree/shadow_lighting.frag"}))
{
}

const gl::Texture& TreeShadowLighting::run(const GBuffer& g_buffer, const GpuScene& scene, const TreeLight& light,
                                           const ConeParams& cones, const SoftShadowParams& params)
{
    gl::fit_to_pixels(color_, framebuffer_, "softly shadowed light", GL_RGBA32F, g_buffer.size());
    g_buffer.bind();
    light.bind(program_);
    scene.bind_lights(program_);
    set_cones(program_, cones);
    program_.set("start_offset", cones.start_offset);
    program_.set("light_radius", params.light_radius);
    program_.set("light_half_angle", glm::radians(0.5f * params.light_angle));
    program_.set("shadow_cones", params.shadow_cones);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, g_buffer.size());
    return color_;
}

}  // namespace conebook
