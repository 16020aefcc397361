// Indirect diffuse light and ambient occlusion: a few wide cones from every pixel through the pyramids.
#pragma once

#include "02_g_buffer/g_buffer.hpp"
#include "07_anisotropic_mips/light_pyramid.hpp"
#include "08_diffuse_cones/cone_sets.hpp"

namespace conebook {

enum class Interleave : int { off = 0, on = 1, every_pixel = 2 };

// What all cones have in common, of pixels and of voxels.
struct ConeParams {
    // 5, 6, 9, 16 or 32 cones over the hemisphere (index into that list): error falls and time grows with them.
    int cones = 1;
    int cone_table = int(ConeTable::tilted);
    // off: the same set everywhere; on: neighbours have 16 different sets and share them, the light of 16 times the cones
    // for the time of one set; every_pixel: all 16 sets everywhere, to measure what sharing costs.
    int interleave = int(Interleave::on);
    // Full aperture of a diffuse cone in degrees, 0 .. 179; 0: 6 for interleaved sets, whose cones lie close, and as
    // wide as fills the hemisphere for a single one. Wider ones are faster, and blur light across edges and behind
    // horizons.
    float aperture = 0.0f;
    // Step over the cone's diameter, 0.05 .. 4: time goes with 1 / step.
    float step = 1.0f;
    // Voxels from the middle of the surface's own voxel to the cone's start, 0 .. 8: with more, light of what is near
    // looks nearer than it is (a lamp at height h by h^2 / (h - offset)^2); with less, slanted surfaces light themselves.
    float start_offset = 0.75f;
    // linear: coverages add up until nothing is left, right for surfaces; exponential: as in a fog, for comparison.
    int transmittance = 0;
    // Ambient occlusion falls off as 1 / (1 + lambda r), lambda in 1/m, 0 .. 100.
    float ao_falloff = 1.0f;
    // Constant radiance of the sky, W/(sr m^2), 0 .. 1e4: what cones see that leave the grid.
    float sky = 0.0f;
};
void add_parameters(ParameterTable& table, ConeParams& params);

// The uniforms of shaders/common/diffuse_gather.glsl, and the directions on uniform block 2.
class DiffuseConeUniforms {
public:
    explicit DiffuseConeUniforms(const ConeParams& params);
    void bind(const gl::Program& program, const ConeParams& params) const;
    // Sets that neighbours have to share, 1 if none.
    int sets() const { return sets_; }

private:
    int sets_, cones_per_set_;
    float tan_half_aperture_;
    gl::Buffer cones_;
};
// Those of shaders/common/cone.glsl alone.
void set_cone_march(const gl::Program& program, const ConeParams& params);

// What surfaces emit, where it is kept apart from what they reflect (chapter 11).
struct EmittedLight {
    const LightPyramid* pyramid = nullptr;  // LightPart::emitted, rgba16f
    float near_radius2_voxels = 0.0f;       // of an emitter at distance t cones gather the share r^2 / (r^2 + t^2)
    void bind(const gl::Program& program) const;
};

struct DiffuseConeParams {
    // The six directions as six textures and a loop that asks each, as first written: same light, for measuring.
    bool plain = false;
};
void add_parameters(ParameterTable& table, DiffuseConeParams& params);

class DiffuseCones {
public:
    // `emission_apart`: gather() is given what surfaces emit beside what they reflect.
    DiffuseCones(gl::Shaders& shaders, const VoxelGrid& grid, const DiffuseConeParams& params,
                 bool emission_apart = false);

    // RGBA16F of the g-buffer's size: rgb E / pi in W/(sr m^2), a: ambient visibility 0..1.
    const gl::Texture& run(const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid,
                           const DiffuseConeUniforms& cones, const ConeParams& params);
    // Its two steps, between which others may add to what is gathered: every pixel by its own set of cones, then
    // neighbours share.
    void gather(const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid, const EmittedLight& emitted,
                const DiffuseConeUniforms& cones, const ConeParams& params);
    const gl::Framebuffer& gathered_framebuffer() const { return gathered_framebuffer_; }
    const gl::Texture& share(const GBuffer& g_buffer, const VoxelGrid& grid, const DiffuseConeUniforms& cones);
    std::vector<gl::Resource> resources() const;

private:
    void copy_directions(const VoxelGrid& grid, const LightPyramid& pyramid);
    bool plain_;
    PyramidProgram gather_;
    gl::Program share_;
    gl::VertexArray no_vertices_;
    gl::Texture gathered_, shared_;
    gl::Framebuffer gathered_framebuffer_, shared_framebuffer_;
    std::vector<gl::Texture> direction_volumes_;  // plain only
};

// Which parts of the light a view shows, 1 or 0 each.
struct LightParts {
    float direct = 0.0f, diffuse = 0.0f, specular = 0.0f, emission = 0.0f;
    bool ambient = false;
};
LightParts parts_of_view(const std::string& view);

struct CompositeParams {
    float bounce_strength = 1.0f;  // artistic factor on indirect light, 0 .. 10; 1 is right
    float ao_strength = 0.0f;      // artistic: indirect light times mix(1, ambient, this), 0 .. 1; 0 is right
};
void add_parameters(ParameterTable& table, CompositeParams& params);

class CompositePass {
public:
    explicit CompositePass(gl::Shaders& shaders);
    // RGBA32F, radiance, alpha 1 where there is a surface. A null input counts as black.
    const gl::Texture& run(const GBuffer& g_buffer, const gl::Texture* direct, const gl::Texture* gathered,
                           const gl::Texture* specular, const LightParts& parts, const CompositeParams& params,
                           float sky_radiance);

private:
    gl::Program program_;
    gl::VertexArray no_vertices_;
    gl::Texture black_, color_;
    gl::Framebuffer framebuffer_;
};

}  // namespace conebook
