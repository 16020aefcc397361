#include "08_diffuse_cones/diffuse_cones.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gl/pixel_pass.hpp"

namespace conebook {

namespace {

constexpr int kConeCounts[] = {5, 6, 9, 16, 32};

}  // namespace

void add_parameters(ParameterTable& table, ConeParams& params)
{
    table.add("cones", params.cones, {"5", "6", "9", "16", "32"}, "diffuse cones over the hemisphere");
    table.add("cone_table", params.cone_table, {"tilted", "thesis"}, "tilts that keep the cosine, or those published");
    table.add("interleave", params.interleave, {"off", "on", "every_pixel"},
              "neighbouring pixels have different cones and share them, or every pixel has all");
    table.add("aperture", params.aperture, 0.0, 179.0, "deg", "full aperture of a diffuse cone; 0: as the set asks");
    table.add("step", params.step, 0.05, 4.0, "", "step over the cone's diameter");
    table.add("start_offset", params.start_offset, 0.0, 8.0, "voxels", "from the surface to the cone's start");
    table.add("transmittance", params.transmittance, {"linear", "exponential"}, "how coverages along a cone add up");
    table.add("ao_falloff", params.ao_falloff, 0.0, 100.0, "1/m", "ambient occlusion: 1 / (1 + this * distance)");
    table.add("sky", params.sky, 0.0, 1e4, "W/sr/m2", "radiance of what cones see that leave the grid");
}

void add_parameters(ParameterTable& table, DiffuseConeParams& params)
{
    table.add("plain", params.plain, "six textures instead of one atlas, as a baseline for time");
}

void add_parameters(ParameterTable& table, CompositeParams& params)
{
    table.add("bounce_strength", params.bounce_strength, 0.0, 10.0, "", "artistic factor on indirect light; 1 is right");
    table.add("ao_strength", params.ao_strength, 0.0, 1.0, "", "artistic occlusion of indirect light; 0 is right");
}

void set_cone_march(const gl::Program& program, const ConeParams& params)
{
    program.set("step_factor", params.step);
    program.set("ao_falloff", params.ao_falloff);
    program.set("transmittance_model", params.transmittance);
    program.set("sky_radiance", glm::vec3(params.sky));
}

DiffuseConeUniforms::DiffuseConeUniforms(const ConeParams& params)
    : sets_(params.interleave == int(Interleave::on) ? 16 : 1), cones_per_set_(kConeCounts[params.cones])
{
    const bool many_sets = params.interleave != int(Interleave::off);
    constexpr float kInterleavedAperture_deg = 6.0f;
    const float aperture_deg = params.aperture == 0.0f && many_sets ? kInterleavedAperture_deg : params.aperture;
    ConeSet set = make_interleaved_cones(cones_per_set_, ConeTable(params.cone_table),
                                         glm::radians(double(aperture_deg)), many_sets ? 16 : 1);
    if (params.interleave == int(Interleave::every_pixel)) {
        for (glm::vec4& cone : set.cones) cone.w /= 16.0f;
        cones_per_set_ = int(set.cones.size());
    }
    tan_half_aperture_ = std::tan(set.half_angle_rad);
    constexpr std::size_t kMostCones = 32 * 16;  // size of the uniform block
    std::vector<glm::vec4> block(kMostCones, glm::vec4(0.0f));
    std::copy(set.cones.begin(), set.cones.end(), block.begin());
    cones_ = gl::Buffer("cone directions", block);
}

void DiffuseConeUniforms::bind(const gl::Program& program, const ConeParams& params) const
{
    set_cone_march(program, params);
    cones_.bind(GL_UNIFORM_BUFFER, shared::kConeBlock);
    program.set("cone_count", cones_per_set_);
    program.set("cone_sets", sets_);
    program.set("tan_half_aperture", tan_half_aperture_);
    program.set("start_offset", params.start_offset);
}

void EmittedLight::bind(const gl::Program& program) const
{
    if (pyramid == nullptr) return;
    pyramid->bind_as_emission();
    program.set("near_radius2", near_radius2_voxels);
}

DiffuseCones::DiffuseCones(gl::Shaders& shaders, const VoxelGrid& grid, const DiffuseConeParams& params,
                           bool emission_apart)
    : plain_(params.plain),
      gather_(shaders, {"common/fullscreen.vert", "08_diffuse_cones/diffuse.frag"},
              {{"PLAIN", params.plain ? "1" : "0"}, {"EMITTED", emission_apart ? "1" : "0"}}),
      share_(shaders.load({"common/fullscreen.vert", "08_diffuse_cones/share.frag"}))
{
    for (int face = 0; plain_ && face < shared::kFaceCount; ++face) {
        direction_volumes_.push_back(
            gl::texture_3d("direction " + std::to_string(face), GL_RGBA16F, grid.size(), grid.levels()));
        direction_volumes_.back().set_filter(GL_LINEAR_MIPMAP_NEAREST, GL_LINEAR);
    }
}

void DiffuseCones::copy_directions(const VoxelGrid& grid, const LightPyramid& pyramid)
{
    if (pyramid.format() != LightFormat::rgba16f)
        throw std::runtime_error("--set plain=on: copies pyramids of format=rgba16f only");
    for (int face = 0; face < shared::kFaceCount; ++face)
        for (int level = 0; level < grid.levels(); ++level) {
            const glm::ivec3 size = grid.size() >> level;
            glCopyImageSubData(pyramid.light().id(), GL_TEXTURE_3D, level, face * size.x, 0, 0,
                               direction_volumes_[std::size_t(face)].id(), GL_TEXTURE_3D, level, 0, 0, 0, size.x,
                               size.y, size.z);
        }
}

const gl::Texture& DiffuseCones::run(const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid,
                                     const DiffuseConeUniforms& cones, const ConeParams& params)
{
    gather(g_buffer, grid, pyramid, {}, cones, params);
    return share(g_buffer, grid, cones);
}

void DiffuseCones::gather(const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid,
                          const EmittedLight& emitted, const DiffuseConeUniforms& cones, const ConeParams& params)
{
    gl::fit_to_pixels(gathered_, gathered_framebuffer_, "gathered light", GL_RGBA16F, g_buffer.size());
    if (plain_) copy_directions(grid, pyramid);
    g_buffer.bind();
    grid.bind();
    pyramid.bind();
    for (std::size_t face = 0; face < direction_volumes_.size(); ++face)
        direction_volumes_[face].bind(GLuint(shared::kDirectionVolumeUnit + int(face)));
    const gl::Program& gather = gather_.reading(pyramid);
    cones.bind(gather, params);
    emitted.bind(gather);
    gl::draw_pixels(gather, gathered_framebuffer_, no_vertices_, g_buffer.size());
}

const gl::Texture& DiffuseCones::share(const GBuffer& g_buffer, const VoxelGrid& grid, const DiffuseConeUniforms& cones)
{
    if (cones.sets() == 1) return gathered_;

    // Pixels of one surface share what they gathered: there, and back again.
    g_buffer.bind();
    gl::fit_to_pixels(shared_, shared_framebuffer_, "shared light", GL_RGBA16F, g_buffer.size());
    share_.set("plane_tolerance", grid.voxel_size_m());
    gathered_.bind(16);
    share_.set("window_begin", -2);
    gl::draw_pixels(share_, shared_framebuffer_, no_vertices_, g_buffer.size());
    shared_.bind(16);
    share_.set("window_begin", -1);
    gl::draw_pixels(share_, gathered_framebuffer_, no_vertices_, g_buffer.size());
    return gathered_;
}

std::vector<gl::Resource> DiffuseCones::resources() const
{
    std::vector<gl::Resource> all = {gathered_.resource(), shared_.resource()};
    for (const gl::Texture& volume : direction_volumes_) all.push_back(volume.resource());
    return all;
}

LightParts parts_of_view(const std::string& view)
{
    if (view == "direct") return {1, 0, 0, 0, false};
    if (view == "indirect_diffuse") return {0, 1, 0, 0, false};
    if (view == "indirect_specular") return {0, 0, 1, 0, false};
    if (view == "emission") return {0, 0, 0, 1, false};
    if (view == "ambient_occlusion") return {0, 0, 0, 0, true};
    return {1, 1, 1, 1, false};
}

CompositePass::CompositePass(gl::Shaders& shaders)
    : program_(shaders.load({"common/fullscreen.vert", "08_diffuse_cones/composite.frag"})),
      black_(gl::texture_2d("black", GL_RGBA16F, {1, 1}))
{
    black_.clear();
}

const gl::Texture& CompositePass::run(const GBuffer& g_buffer, const gl::Texture* direct, const gl::Texture* gathered,
                                      const gl::Texture* specular, const LightParts& parts,
                                      const CompositeParams& params, float sky_radiance)
{
    gl::fit_to_pixels(color_, framebuffer_, "composite", GL_RGBA32F, g_buffer.size());
    g_buffer.bind();
    (direct != nullptr ? *direct : black_).bind(16);
    (gathered != nullptr ? *gathered : black_).bind(17);
    (specular != nullptr ? *specular : black_).bind(18);
    program_.set("parts", glm::vec4(direct != nullptr ? parts.direct : 0.0f, gathered != nullptr ? parts.diffuse : 0.0f,
                                    specular != nullptr ? parts.specular : 0.0f, parts.emission));
    program_.set("show_ambient", parts.ambient);
    program_.set("bounce_strength", params.bounce_strength);
    program_.set("ao_strength", params.ao_strength);
    program_.set("sky_radiance", glm::vec3(sky_radiance));
    gl::draw_pixels(program_, framebuffer_, no_vertices_, g_buffer.size());
    return color_;
}

}  // namespace conebook
