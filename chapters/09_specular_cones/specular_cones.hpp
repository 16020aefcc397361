// Glossy reflection: a few cones that share the GGX lobe.
#pragma once

#include <map>
#include <string>

#include "08_diffuse_cones/diffuse_cones.hpp"

namespace conebook {

struct SpecularConeParams {
    // Cones that share the lobe of a rough surface, 1 .. 64; a sharp one (roughness below 0.1) has one cone. With
    // ConeParams::interleave neighbours have other parts of a wide lobe and share them: 16 times as many.
    int specular_cones = 4;
    // Share of the GGX lobe that the cone holds, 0.1 .. 0.95: larger is blurrier, smaller misses the lobe's long tail.
    float lobe_share = 0.75f;
    // Voxels from the middle of the surface's own voxel to the cone's start, 0 .. 8: a narrow cone that starts nearer shows
    // the voxels of its own surface as a pattern.
    float specular_start = 1.5f;
    // How far they see surfaces, m, 0 .. 1e6; 0: to the bounds.
    float range_specular = 0.0f;
    bool operator==(const SpecularConeParams&) const = default;
};
void add_parameters(ParameterTable& table, SpecularConeParams& params);

class SpecularCones {
public:
    explicit SpecularCones(gl::Shaders& shaders);

    // RGBA32F of the g-buffer's size: radiance towards the camera. `sample` as in ConeDirections. `folder` below shaders/
    // holds specular.frag; later chapters have their own.
    const gl::Texture& run(const GBuffer& g_buffer, const ConeVolumes& volumes, const ConeParams& cones,
                           const SpecularConeParams& params, int sample = 0,
                           const std::string& folder = "09_specular_cones");
    // The same through whatever the folder's programs read: `bind` binds it and sets its uniforms.
    const gl::Texture& run(const GBuffer& g_buffer, const VoxelGrid& grid,
                           const std::function<void(const gl::Program&)>& bind_volumes, const gl::Defines& defines,
                           const ConeParams& cones, const SpecularConeParams& params, int sample,
                           const std::string& folder);
    std::vector<gl::Resource> resources() const
    {
        return {lobe_light_.resource(), specular_.resource(), directional_albedo_.resource()};
    }

    // What specular.frag reads beside g-buffer and volumes, for `program`, which may be a variant of it.
    void bind(const gl::Program& program, const ConeParams& cones, const SpecularConeParams& params, int sample) const;

private:
    void make_table();  // at the first run: scenes without a lobe have none
    gl::Shaders& shaders_;
    std::map<std::string, gl::ProgramVariants> trace_;  // by folder
    gl::ProgramVariants shares_;
    gl::VertexArray no_vertices_;
    gl::Texture directional_albedo_, lobe_light_, specular_;
    gl::Framebuffer lobe_framebuffer_, specular_framebuffer_;
};

}  // namespace conebook
