#include "08_diffuse_cones/diffuse_cones.hpp"

#include <algorithm>
#include <cmath>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, ConeParams& params)
{
    table.add_values("cones", params.cones, {1, 5, 6, 9, 16, 32}, "diffuse cones over the hemisphere");
    table.add("cone_table", params.cone_table, {"tilted", "thesis", "thesis_added"},
              "tilts that keep the cosine, those published, or those of the published code");
    table.add("interleave", params.interleave, {"off", "on", "every_pixel"},
              "neighbouring pixels have different cones and share them, or every pixel has all");
    table.add("aperture", params.aperture, 0.0, 179.0, "deg", "full aperture of a diffuse cone; 0: as the set asks");
    table.add("walk", params.walk, {"leap", "march"}, "cones leap over empty space, or march through it in steps");
    table.add("step", params.step, 0.05, 4.0, "", "march: step over the cone's diameter");
    table.add("start_offset", params.start_offset, 0.0, 8.0, "voxels", "from the surface to the cone's start");
    table.add("transmittance", params.transmittance, {"linear", "exponential", "per_sample"},
              "march: how coverages add up");
    table.add("side_weights", params.side_weights, {"projected", "squared"}, "march: of a voxel's sides, |d| or d^2");
    table.add("ao_falloff", params.ao_falloff, 0.0, 100.0, "1/m", "ambient occlusion: 1 / (1 + this * distance)");
    table.add("range_diffuse", params.range_diffuse, 0.0, 1e6, "m", "how far diffuse cones see; 0: to the bounds");
    table.add("range_ao", params.range_ao, 0.0, 1e6, "m", "how far ambient occlusion sees; 0: to the bounds");
    table.add("sky", params.sky, 0.0, 1e4, "W/sr/m2", "radiance of what cones see that leave the grid");
}

void add_parameters(ParameterTable& table, DiffuseConeParams& params)
{
    table.add_values("gather_scale", params.gather_scale, {1, 2, 4}, "one of so many pixels along a side gathers");
}

gl::Defines cone_defines(const ConeParams& params, const ConeVolumes& volumes)
{
    gl::Defines defines = volumes.defines();
    defines["MARCH"] = std::to_string(int(params.walk == ConeWalk::march));
    return defines;
}

void set_cones(const gl::Program& program, const ConeParams& params)
{
    program.set("step_factor", params.step);
    program.set("ao_falloff", params.ao_falloff);
    program.set("range_diffuse", params.range_diffuse);
    program.set("range_ao", params.range_ao);
    program.set("transmittance_model", int(params.transmittance));
    program.set("squared_weights", params.side_weights == SideWeights::squared);
    program.set("sky_radiance", glm::vec3(params.sky));
}

namespace {

constexpr double kGoldenRatio = 0.6180339887498949;

double fraction(double x) { return x - std::floor(x); }

}  // namespace

void ConeDirections::update(const ConeParams& params, int sample, int sets)
{
    if (!made_from_.differs(params, sample, sets)) return;
    const bool many_sets = params.interleave != Interleave::off;
    constexpr float kInterleavedAperture_deg = 6.0f;
    const float aperture_deg = params.aperture == 0.0f && many_sets ? kInterleavedAperture_deg : params.aperture;
    ConeSet set = make_interleaved_cones(params.cones, params.cone_table, glm::radians(double(aperture_deg)),
                                         many_sets ? sets : 1);
    sets_ = params.interleave == Interleave::on ? sets : 1;
    cones_per_set_ = int(set.cones.size()) / sets_;
    // Every further picture turns the cones about the normal, and moves the thresholds.
    const double turn = 2.0 * M_PI * fraction(sample * kGoldenRatio);
    first_threshold_ = float(fraction(sample * kGoldenRatio * kGoldenRatio));
    for (glm::vec4& cone : set.cones) {
        const glm::dvec2 xy(cone);
        cone.x = float(std::cos(turn) * xy.x - std::sin(turn) * xy.y);
        cone.y = float(std::sin(turn) * xy.x + std::cos(turn) * xy.y);
        if (params.interleave == Interleave::every_pixel) cone.w /= float(sets);
    }
    tan_half_aperture_ = std::tan(set.half_angle_rad);
    constexpr std::size_t kMostCones = 1024;  // size of the uniform block
    set.cones.resize(kMostCones, glm::vec4(0.0f));
    cones_ = gl::Buffer("cone directions", set.cones);
}

void ConeDirections::bind(const gl::Program& program, const ConeParams& params) const
{
    set_cones(program, params);
    cones_.bind(GL_UNIFORM_BUFFER, shared::kConeBlock);
    program.set("cone_count", cones_per_set_);
    program.set("cone_sets", sets_);
    program.set("tan_half_aperture", tan_half_aperture_);
    program.set("start_offset", params.start_offset);
    program.set("first_threshold", first_threshold_);
}

void ConeVolumes::bind() const
{
    grid.bind();
    pyramid.bind();
    walk.bind();
}

gl::Defines ConeVolumes::defines() const
{
    gl::Defines all = pyramid.defines();
    all.insert(walk.defines().begin(), walk.defines().end());
    return all;
}

DiffuseCones::DiffuseCones(gl::Shaders& shaders, const std::string& folder)
    : points_(shaders),
      gather_(shaders, {"common/fullscreen.vert", folder + "/gather.frag"}),
      upsample_(shaders, {"common/fullscreen.vert", folder + "/upsample.frag"}),
      filter_(shaders)
{
}

const gl::Texture& DiffuseCones::run(const GBuffer& g_buffer, const ConeVolumes& volumes,
                                     const ConeDirections& directions, const ConeParams& cones,
                                     const DiffuseConeParams& params, int sample)
{
    const auto bind = [&](const gl::Program&) { volumes.bind(); };
    return run(g_buffer, volumes.grid, bind, cone_defines(cones, volumes), directions, cones, params, sample);
}

const gl::Texture& DiffuseCones::run(const GBuffer& g_buffer, const VoxelGrid& grid,
                                     const std::function<void(const gl::Program&)>& bind, const gl::Defines& defines,
                                     const ConeDirections& directions, const ConeParams& cones,
                                     const DiffuseConeParams& params, int sample)
{
    const bool share = directions.sets() > 1;
    // Where the points are that gather.
    points_.run(g_buffer, grid, share ? params.gather_scale : 1, sample);

    // Every point gathers by its own set of cones.
    gl::fit_to_pixels(gathered_, gathered_framebuffer_, "gathered light", GL_RGBA32F, points_.size());
    const gl::Program& gather = gather_.with(defines);
    bind(gather);
    points_.bind(gather);
    directions.bind(gather, cones);
    gl::draw_pixels(gather, gathered_framebuffer_, no_vertices_, points_.size());
    if (!share) return gathered_;

    // Points of one surface share what they gathered.
    const gl::Texture& filtered = filter_.run(gathered_, g_buffer, points_);

    // Pixels take from the points around them.
    gl::fit_to_pixels(light_, light_framebuffer_, "indirect diffuse light", GL_RGBA32F, g_buffer.size());
    const gl::Program& upsample = upsample_.with(defines);
    bind(upsample);
    points_.bind(upsample);
    directions.bind(upsample, cones);
    filtered.bind(17);
    gl::draw_pixels(upsample, light_framebuffer_, no_vertices_, g_buffer.size());
    return light_;
}

std::vector<gl::Resource> DiffuseCones::resources() const
{
    std::vector<gl::Resource> all = {points_.resource(), gathered_.resource(), light_.resource()};
    for (const gl::Resource& resource : filter_.resources()) all.push_back(resource);
    return all;
}

}  // namespace conebook
