#include "09_specular_cones/specular_cones.hpp"

#include <cmath>

#include <glm/gtc/constants.hpp>

#include "09_specular_cones/directional_albedo.hpp"
#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, SpecularConeParams& params)
{
    table.add("specular_cones", params.specular_cones, 1, 64, "", "cones in the lobe of a rough surface");
    table.add("lobe_share", params.lobe_share, 0.1, 0.95, "", "share of the GGX lobe that the specular cone holds");
    table.add("specular_start", params.specular_start, 0.0, 8.0, "voxels",
              "from the surface to the specular cone's start");
    table.add("range_specular", params.range_specular, 0.0, 1e6, "m", "how far specular cones see; 0: to the bounds");
}

SpecularCones::SpecularCones(gl::Shaders& shaders)
    : shaders_(shaders), shares_(shaders, {"common/fullscreen.vert", "09_specular_cones/specular_share.frag"})
{
}

void SpecularCones::make_table()
{
    if (directional_albedo_) return;
    constexpr int kTableSize = 32, kSamples = 2048;  // within 0.5 %, tests/09_specular_cones_test.cpp
    const std::vector<glm::vec2> table = directional_albedo_table(kTableSize, kSamples);
    directional_albedo_ = gl::texture_2d("directional albedo", GL_RG32F, {kTableSize, kTableSize});
    glTextureSubImage2D(directional_albedo_.id(), 0, 0, 0, kTableSize, kTableSize, GL_RG, GL_FLOAT, table.data());
    directional_albedo_.set_filter(GL_LINEAR, GL_LINEAR);
}

void SpecularCones::bind(const gl::Program& program, const ConeParams& cones, const SpecularConeParams& params,
                         int sample) const
{
    set_cones(program, cones);
    program.set("start_offset", params.specular_start);
    program.set("interleave", cones.interleave == Interleave::on);
    program.set("specular_cones", params.specular_cones);
    program.set("lobe_share", params.lobe_share);
    program.set("range_specular", params.range_specular);
    constexpr float kGoldenAngle_rad = 2.39996323f;
    program.set("turn", std::fmod(float(sample) * kGoldenAngle_rad, 2.0f * glm::pi<float>()));
}

const gl::Texture& SpecularCones::run(const GBuffer& g_buffer, const ConeVolumes& volumes, const ConeParams& cones,
                                      const SpecularConeParams& params, int sample, const std::string& folder)
{
    const auto bind_volumes = [&](const gl::Program&) { volumes.bind(); };
    return run(g_buffer, volumes.grid, bind_volumes, volumes.defines(), cones, params, sample, folder);
}

const gl::Texture& SpecularCones::run(const GBuffer& g_buffer, const VoxelGrid& grid,
                                      const std::function<void(const gl::Program&)>& bind_volumes,
                                      const gl::Defines& defines, const ConeParams& cones,
                                      const SpecularConeParams& params, int sample, const std::string& folder)
{
    gl::fit_to_pixels(lobe_light_, lobe_framebuffer_, "light in the lobe", GL_RGBA32F, g_buffer.size());
    gl::fit_to_pixels(specular_, specular_framebuffer_, "specular light", GL_RGBA32F, g_buffer.size());
    make_table();
    // The mean of the light in every pixel's lobe, or in its part of a wide one.
    g_buffer.bind();
    const std::vector<std::string> files = {"common/fullscreen.vert", folder + "/specular.frag"};
    const gl::Program& trace = trace_.try_emplace(folder, shaders_, files).first->second.with(defines);
    bind_volumes(trace);
    bind(trace, cones, params, sample);
    gl::draw_pixels(trace, specular_framebuffer_, no_vertices_, g_buffer.size());

    // Neighbours share wide lobes, there and back again; then what the surface reflects of it.
    const gl::Program& share = shares_.with({});
    directional_albedo_.bind(16);
    share.set("interleave", cones.interleave == Interleave::on);
    share.set("plane_tolerance", grid.voxel_size_m());
    specular_.bind(17);
    share.set("window_begin", -2);
    share.set("reflect_it", false);
    gl::draw_pixels(share, lobe_framebuffer_, no_vertices_, g_buffer.size());
    lobe_light_.bind(17);
    share.set("window_begin", -1);
    share.set("reflect_it", true);
    gl::draw_pixels(share, specular_framebuffer_, no_vertices_, g_buffer.size());
    return specular_;
}

}  // namespace conebook
