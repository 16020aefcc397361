#include "09_specular_cones/specular_cones.hpp"

#include "09_specular_cones/directional_albedo.hpp"
#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, SpecularConeParams& params)
{
    table.add("lobe_share", params.lobe_share, 0.1, 0.95, "", "share of the GGX lobe that the specular cone holds");
    table.add("specular_start", params.specular_start, 0.0, 8.0, "voxels", "from the surface to the specular cone's start");
}

SpecularCones::SpecularCones(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "09_specular_cones/specular.frag"}, {{"PLAIN", "0"}}))
{
    constexpr int kTableSize = 32, kSamples = 1024;  // within 0.5 %, tests/09_specular_cones_test.cpp
    const std::vector<glm::vec2> table = directional_albedo_table(kTableSize, kSamples);
    directional_albedo_ = gl::texture_2d("directional albedo", GL_RG32F, {kTableSize, kTableSize});
    glTextureSubImage2D(directional_albedo_.id(), 0, 0, 0, kTableSize, kTableSize, GL_RG, GL_FLOAT, table.data());
    directional_albedo_.set_filter(GL_LINEAR, GL_LINEAR);
}

const gl::Texture& SpecularCones::run(const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid,
                                      const ConeParams& cone_params, const SpecularConeParams& params)
{
    gl::fit_to_pixels(specular_, framebuffer_, "specular light", GL_RGBA16F, g_buffer.size());
    g_buffer.bind();
    grid.bind();
    pyramid.bind();
    directional_albedo_.bind(16);
    set_cone_march(program_, cone_params);
    program_.set("start_offset", params.specular_start);
    program_.set("lobe_share", params.lobe_share);
    gl::draw_pixels(program_, framebuffer_, no_vertices_, g_buffer.size());
    return specular_;
}

}  // namespace conebook
