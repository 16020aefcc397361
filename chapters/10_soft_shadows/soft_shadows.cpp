#include "10_soft_shadows/soft_shadows.hpp"

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, SoftShadowParams& params)
{
    table.add("shadows", params.shadows, {"map", "cone", "volume"}, "how direct light is shadowed");
    table.add("light_radius", params.light_radius, 0.001, 10.0, "m", "radius of point and spot lights, for cones");
    table.add("light_angle", params.light_angle, 0.05, 60.0, "deg", "full angle of directional lights, for cones");
    table.add("range_shadow", params.range_shadow, 0.0, 1e6, "m", "how far cones look for shadows; 0: to the light");
    table.add("shadow_cones", params.shadow_cones, 1, 64, "cones", "to each light, each thin");
}

std::vector<Need> soft_shadow_needs(const SoftShadowParams& params, bool has_lights)
{
    constexpr const char* kAsked[] = {"shadows=map", "shadows=cone", "shadows=volume"};
    const std::string reason = has_lights ? kAsked[int(params.shadows)] : "the scene has no lights but surfaces that shine";
    return {{"shadow cones", has_lights && params.shadows == ShadowMethod::cone, reason},
            {"visibility volume", has_lights && params.shadows == ShadowMethod::volume, reason}};
}

SoftShadowLighting::SoftShadowLighting(gl::Shaders& shaders)
    : lighting_(shaders, {"common/fullscreen.vert", "10_soft_shadows/soft_lighting.frag"}),
      fill_volume_(shaders, {"10_soft_shadows/visibility_volume.comp"})
{
}

void SoftShadowLighting::fill_volume(const VoxelGrid& grid, const VoxelFaces& faces, const VoxelShading& shading)
{
    const glm::ivec3 size = grid.size() * glm::ivec3(shared::kFaceCount, 1, 1);
    if (!visibility_volume_ || visibility_volume_.size() != size) {
        visibility_volume_ = gl::texture_3d("visibility volume", GL_RGBA8, size);
        visibility_volume_.set_filter(GL_LINEAR, GL_LINEAR);
    }
    visibility_volume_.clear();
    grid.bind();
    faces.bind();
    shading.visibility().bind(GL_SHADER_STORAGE_BUFFER, shared::kVisibilityBinding);
    visibility_volume_.bind_image(0, 0, GL_WRITE_ONLY);
    fill_volume_.with({}).use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.face_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    visibility_volume_.bind(16);
}

const gl::Texture& SoftShadowLighting::run(const GBuffer& g_buffer, const GpuScene& scene, const ConeVolumes& volumes,
                                           const VoxelFaces& faces, const VoxelShading& shading,
                                           const ShadowMaps& shadow_maps, const ConeParams& cones,
                                           const SoftShadowParams& params, bool show_visibility)
{
    gl::fit_to_pixels(color_, framebuffer_, "softly shadowed light", GL_RGBA32F, g_buffer.size());
    if (params.shadows == ShadowMethod::volume) fill_volume(volumes.grid, faces, shading);
    g_buffer.bind();
    volumes.bind();
    gl::Defines defines = volumes.defines();
    defines["METHOD"] = std::to_string(int(params.shadows));
    const gl::Program& lighting = lighting_.with(defines);
    scene.bind_lights(lighting);
    shadow_maps.bind(lighting);
    set_cones(lighting, cones);
    lighting.set("start_offset", cones.start_offset);
    lighting.set("light_radius", params.light_radius);
    lighting.set("light_half_angle", glm::radians(0.5f * params.light_angle));
    lighting.set("shadow_cones", params.shadow_cones);
    lighting.set("range_shadow", params.range_shadow);
    lighting.set("show_visibility", show_visibility);
    gl::draw_pixels(lighting, framebuffer_, no_vertices_, g_buffer.size());
    return color_;
}

std::vector<gl::Resource> SoftShadowLighting::resources() const
{
    return {color_.resource(), visibility_volume_.resource()};
}

}  // namespace conebook
