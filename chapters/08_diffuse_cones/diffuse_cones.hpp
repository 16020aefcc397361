// Indirect diffuse light and ambient occlusion: many narrow cones, shared among neighbouring pixels.
#pragma once

#include <functional>
#include <string>

#include "02_g_buffer/g_buffer.hpp"
#include "07_anisotropic_mips/light_pyramid.hpp"
#include "08_diffuse_cones/cone_sets.hpp"
#include "08_diffuse_cones/gather_points.hpp"
#include "08_diffuse_cones/walk_volume.hpp"

namespace conebook {

enum class Interleave : int { off = 0, on = 1, every_pixel = 2 };
enum class ConeWalk : int { leap = 0, march = 1 };
enum class Transmittance : int { linear = 0, exponential = 1, per_sample = 2 };
enum class SideWeights : int { projected = 0, squared = 1 };

// What all cones have in common, of pixels and of voxels.
struct ConeParams {
    // 1, 5, 6, 9, 16 or 32 cones over the hemisphere: error falls and time grows with them.
    int cones = 16;
    ConeTable cone_table = ConeTable::tilted;
    // off: the same set everywhere; on: neighbours have 16 different sets and share them, the light of 16 times the cones
    // for the time of one set; every_pixel: all 16 sets everywhere, to measure what sharing costs.
    Interleave interleave = Interleave::on;
    // Full aperture of a diffuse cone in degrees, 0 .. 179; 0: 6 for interleaved sets, whose cones lie close, and as
    // wide as fills the hemisphere for a single one. Wider ones blur light across edges and behind horizons.
    float aperture = 0.0f;
    // leap: through the walk volume to where the cone ends; march: in steps, naively, for comparison.
    ConeWalk walk = ConeWalk::leap;
    // march: step over the cone's diameter, 0.05 .. 4; time goes with 1 / step.
    float step = 1.0f;
    // Voxels from the middle of the surface's own voxel to the cone's start, 0 .. 8: with more, light of what is near
    // looks nearer than it is (a lamp at height h by h^2 / (h - offset)^2); with less, slanted surfaces light themselves.
    float start_offset = 0.75f;
    // march. linear: coverages add up until nothing is left, right for surfaces; for comparison, exponential: each step
    // leaves (1 - A)^2 of what is open, as a fog of twice the depth that covers A; per_sample: every sample stops its
    // opacity, however short the step (Villegas 2016, section 3.6).
    Transmittance transmittance = Transmittance::linear;
    // march: how much of a voxel's three sides a cone meets. projected: each by |d_a|, its projected area; squared: by
    // d_a^2 (Villegas 2016, section 3.6), for comparison.
    SideWeights side_weights = SideWeights::projected;
    // Ambient occlusion falls off as 1 / (1 + lambda r), lambda in 1/m, 0 .. 100.
    float ao_falloff = 1.0f;
    // How far cones that leap see surfaces, for light and for ambient occlusion, in m, 0 .. 1e6; 0: to the bounds. Links of
    // faces go to the bounds.
    float range_diffuse = 0.0f, range_ao = 0.0f;
    // Constant radiance of the sky, W/(sr m^2), 0 .. 1e4: what cones see that leave the grid.
    float sky = 0.0f;
    bool operator==(const ConeParams&) const = default;
};
void add_parameters(ParameterTable& table, ConeParams& params);

// What cones go through: where they end, and the light there.
struct ConeVolumes {
    const VoxelGrid& grid;
    const LightPyramid& pyramid;
    const WalkVolume& walk;
    void bind() const;
    gl::Defines defines() const;  // for programs that read them
};

// Defines that programs with cones are compiled with.
gl::Defines cone_defines(const ConeParams& params, const ConeVolumes& volumes);

// The uniforms of shaders/08_diffuse_cones/cone_common.glsl and march.glsl.
void set_cones(const gl::Program& program, const ConeParams& params);

// The cones' directions, uniform block 2 of shaders/08_diffuse_cones/gather.glsl.
class ConeDirections {
public:
    // Those of the `sample`th of many pictures of the same scene, 0, 1, ...: other directions each, whose mean has less error.
    // `sets`: of the receivers that share, with ConeParams::interleave.
    void update(const ConeParams& params, int sample, int sets = kPixelSets);
    static constexpr int kPixelSets = 16;  // of 4 x 4 points, see gather_point.glsl
    // The directions, and the uniforms of gather.glsl.
    void bind(const gl::Program& program, const ConeParams& params) const;
    // Sets that neighbours have to share, 1 if none.
    int sets() const { return sets_; }

private:
    MadeFrom<ConeParams, int, int> made_from_;
    int sets_ = 1, cones_per_set_ = 1;
    float tan_half_aperture_ = 0.0f, first_threshold_ = 0.0f;
    gl::Buffer cones_;
};

struct DiffuseConeParams {
    // One of every N x N pixels gathers, 1, 2 or 4; the others take from those on the same surface, or gather for
    // themselves where there is none. Also the width of the filter grows with it.
    int gather_scale = 2;
    bool operator==(const DiffuseConeParams&) const = default;
};
void add_parameters(ParameterTable& table, DiffuseConeParams& params);

class DiffuseCones {
public:
    // `folder` below shaders/ holds gather.frag and upsample.frag; later chapters have their own.
    explicit DiffuseCones(gl::Shaders& shaders, const std::string& folder = "08_diffuse_cones");

    // RGBA32F of the g-buffer's size: rgb E / pi in W/(sr m^2), a: ambient visibility 0..1. `sample`: as in ConeDirections.
    const gl::Texture& run(const GBuffer& g_buffer, const ConeVolumes& volumes, const ConeDirections& directions,
                           const ConeParams& cones, const DiffuseConeParams& params, int sample = 0);
    // The same through whatever the folder's programs read: `bind` binds it and sets its uniforms.
    const gl::Texture& run(const GBuffer& g_buffer, const VoxelGrid& grid,
                           const std::function<void(const gl::Program&)>& bind, const gl::Defines& defines,
                           const ConeDirections& directions, const ConeParams& cones, const DiffuseConeParams& params,
                           int sample = 0);
    const GatherPoints& points() const { return points_; }  // of the last run
    std::vector<gl::Resource> resources() const;

private:
    GatherPoints points_;
    gl::ProgramVariants gather_, upsample_;
    PointFilter filter_;
    gl::VertexArray no_vertices_;
    gl::Texture gathered_, light_;
    gl::Framebuffer gathered_framebuffer_, light_framebuffer_;
};

}  // namespace conebook
