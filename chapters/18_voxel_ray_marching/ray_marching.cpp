#include "18_voxel_ray_marching/ray_marching.hpp"

#include <algorithm>

#include "gl/pixel_pass.hpp"

namespace conebook {

void add_parameters(ParameterTable& table, RayParams& params)
{
    table.add("bounces", params.bounces, 0, 1, "", "indirect bounces; the voxels hold direct light, so there is one");
    table.add("rays", params.rays, 1, 4096, "", "of each point that gathers");
    table.add("spread", params.spread, 0.0, 4.0, "", "w of normalize(n + w R); 1: as the cosine");
    table.add("sequence", params.sequence, {"even", "random"}, "directions: a lattice shared by neighbours, or random");
    table.add("march", params.march, {"dda", "fixed"}, "every voxel on the way, or samples at fixed steps");
    table.add("hit", params.hit, {"piece", "voxel"}, "where a ray ends: the piece's plane, or the voxel's side");
    table.add("steps", params.steps, 1, 1024, "", "of march=fixed; times step: range of falloff=window");
    table.add("step", params.step, 0.1, 8.0, "voxels", "of march=fixed");
    table.add("min_distance", params.min_distance, 0.0, 16.0, "voxels", "hit=voxel: what is nearer does not count");
    table.add("facing", params.facing, {"back_faces", "cosine", "none"},
              "what a piece's normal does: backs send nothing, a factor max(-n.d, 0), nothing");
    table.add("falloff", params.falloff, {"none", "window", "square"}, "with distance; none is right");
    table.add_values("scale", params.scale, {1, 2, 4}, "one of every scale x scale pixels traces rays");
    table.add("blur", params.blur, "points of one surface share what they gathered");
    table.add("sky", params.sky, 0.0, 1e4, "W/(sr m^2)", "what rays bring that leave the voxels");
}

namespace {

bool ends_on_pieces(const RayParams& params, const PieceVoxelParams& voxels)
{
    return params.hit == 0 && params.march == 0 && voxels.payload == int(Payload::index);
}

gl::Defines with_rays(gl::Defines defines, const RayParams& params, const PieceVoxelParams& voxels)
{
    defines["ON_PLANE"] = ends_on_pieces(params, voxels) ? "1" : "0";
    defines["FIXED_STEPS"] = params.march == 1 ? "1" : "0";
    defines["FACING"] = std::to_string(params.facing);
    defines["FALLOFF"] = std::to_string(params.falloff);
    return defines;
}

// llvmpipe cuts an invocation off after 65,535 rounds of all its loops together, without a word; GPUs end draws that
// take seconds. So many rays are traced by several draws, none of which can come near.
int rays_of_draw(const RayParams& params, glm::ivec3 size)
{
    constexpr int kMostRounds = 60000;
    const int of_ray = params.march == 1 ? params.steps : 3 * (size.x + size.y + size.z);
    return std::max(1, kMostRounds / of_ray);
}

void set_rays(const gl::Program& program, const RayParams& params)
{
    program.set("ray_count", params.rays);
    program.set("spread", params.spread);
    program.set("random_rays", params.sequence);
    program.set("min_distance", params.min_distance);
    program.set("step_length", params.step);
    program.set("steps", params.steps);
    program.set("sky_radiance", glm::vec3(params.sky));
}

}  // namespace

std::vector<Need> ray_needs(const RayParams& rays, const PieceVoxelParams& voxels)
{
    const bool traces = rays.bounces > 0;
    const char* why = rays.march == 1                         ? "march=fixed samples voxels"
                      : voxels.payload != int(Payload::index) ? "payload=packed has no place for a plane"
                      : rays.hit == 0                         ? "hit=piece"
                                                              : "hit=voxel";
    return {{"indirect light", traces, traces ? "bounces=1" : "bounces=0"},
            {"planes of pieces", traces && ends_on_pieces(rays, voxels), why}};
}

RayMarching::RayMarching(gl::Shaders& shaders)
    : rays_(shaders, {"common/fullscreen.vert", "18_voxel_ray_marching/rays.frag"}),
      upsample_(shaders, {"common/fullscreen.vert", "18_voxel_ray_marching/upsample.frag"}),
      points_(shaders),
      filter_(shaders)
{
}

const gl::Texture& RayMarching::run(const GBuffer& g_buffer, const VoxelGrid& grid, const PieceVoxels& voxels,
                                    const RayParams& params)
{
    // Which pixels gather.
    points_.run(g_buffer, grid, params.scale, 0);

    // Their rays, so many a draw.
    gl::fit_to_pixels(gathered_, gathered_framebuffer_, "gathered light", GL_RGBA32F, points_.size());
    const gl::Defines defines = with_rays(voxels.defines(), params, voxels.params());
    const int of_draw = rays_of_draw(params, grid.size());
    const gl::Program& rays = rays_.with(defines);
    g_buffer.bind();
    points_.bind(rays);
    voxels.bind(rays);
    set_rays(rays, params);
    for (int first = 0; first < params.rays; first += of_draw) {
        rays.set("first_ray", first);
        rays.set("last_ray", std::min(first + of_draw, params.rays));
        gl::draw_pixels(rays, gathered_framebuffer_, no_vertices_, points_.size(),
                        first == 0 ? gl::Write::replace : gl::Write::add);
    }

    // Points of one surface share what they gathered, and pixels take from the points around them.
    const gl::Texture& shared_light = params.blur ? filter_.run(gathered_, g_buffer, points_) : gathered_;
    gl::fit_to_pixels(light_, light_framebuffer_, "indirect diffuse light", GL_RGBA32F, g_buffer.size());
    const gl::Program& upsample = upsample_.with(defines);
    g_buffer.bind();
    points_.bind(upsample);
    voxels.bind(upsample);
    set_rays(upsample, params);
    upsample.set("ray_count", std::min(params.rays, of_draw));
    shared_light.bind(17);
    gl::draw_pixels(upsample, light_framebuffer_, no_vertices_, g_buffer.size());
    return light_;
}

const gl::Texture& RayMarching::unblurred(glm::ivec2 size)
{
    gl::fit_to_pixels(shown_, shown_framebuffer_, "unblurred light", GL_RGBA32F, size);
    const glm::ivec2 from = gathered_.size_2d(), to = from * points_.scale();  // may reach beyond the picture
    glBlitNamedFramebuffer(gathered_framebuffer_.id(), shown_framebuffer_.id(), 0, 0, from.x, from.y, 0, 0, to.x, to.y,
                           GL_COLOR_BUFFER_BIT, GL_NEAREST);
    return shown_;
}

std::vector<gl::Resource> RayMarching::resources() const
{
    std::vector<gl::Resource> all = {points_.resource(), gathered_.resource(), light_.resource()};
    for (const gl::Resource& resource : filter_.resources()) all.push_back(resource);
    return all;
}

}  // namespace conebook
