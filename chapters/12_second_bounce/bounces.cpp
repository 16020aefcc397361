#include "12_second_bounce/bounces.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace conebook {

void add_parameters(ParameterTable& table, BounceParams& params)
{
    table.add("bounces", params.bounces, -1, 64, "", "indirect bounces; -1: until nothing changes");
    table.add("tolerance", params.tolerance, 1e-6, 0.1, "", "bounces=-1: largest change over largest radiance");
    table.add_values("links", params.links, {1, 5, 9, 16}, "rays of every face, along which light goes round");
}

Bounces::Bounces(gl::Shaders& shaders)
    : link_(shaders, {"12_second_bounce/links.comp"}),
      bounce_(shaders, {"12_second_bounce/bounce.comp"}),
      change_("bounce change", 2 * sizeof(GLuint))
{
}

bool Bounces::link(const LitVoxels& voxels, const WalkVolume& walk, const Emitters& emitters, const ConeParams& cones,
                   const BounceParams& params)
{
    if (!linked_from_.differs(walk.revision(), voxels.coverage_revision(), emitters.revision(), cones.start_offset,
                              cones.cone_table, cones.aperture, params.links))
        return false;
    ++links_revision_;
    constexpr int kSets = 64;  // of 8 x 8 faces of a wall
    const std::size_t count = voxels.faces().face_count();
    links_ = gl::Buffer("links", count * std::size_t(params.links) * sizeof(GLuint));
    from_emitters_ = gl::Buffer("from emitters", count * sizeof(glm::vec4));
    albedo_ = gl::Buffer("reflectance of faces", count * sizeof(GLuint));
    for (gl::Buffer& buffer : packed_) buffer = gl::Buffer("radiance of faces between bounces", count * sizeof(glm::uvec2));
    reflected_ = gl::Buffer("reflected by faces", count * sizeof(glm::vec4));
    has_emitters_ = emitters.shine();

    voxels.grid().bind();
    voxels.faces().bind();
    voxels.pyramid().bind();
    walk.bind();
    gl::Defines defines = {{"MARCH", "0"}, {"EMITTERS", emitters.are_apart() ? "1" : emitters.shine() ? "2" : "0"}};
    defines.merge(voxels.pyramid().defines());
    defines.merge(emitters.defines());
    const gl::Program& link = link_.with(defines);
    ConeParams rays = cones;
    rays.cones = params.links;
    rays.interleave = Interleave::on;
    ConeDirections directions;
    directions.update(rays, 0, kSets);
    directions.bind(link, rays);
    if (emitters.are_apart()) emitters.bind(link);
    links_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLinkBinding);
    from_emitters_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFromEmittersBinding);
    albedo_.bind(GL_SHADER_STORAGE_BUFFER, shared::kAlbedoBinding);
    link.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, voxels.faces().face_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return true;
}

bool Bounces::run(const LitVoxels& voxels, const ConeParams& cones, const BounceParams& params)
{
    if (!made_from_.differs(links_revision_, voxels.shading().revision(), cones.sky, params)) return false;
    ++revision_;
    const VoxelFaces& faces = voxels.faces();
    const bool to_convergence = params.bounces < 0;
    constexpr int kMost = 256;  // 0.99^256 = 0.08: the brightest white allowed is not quite done by then
    constexpr int kMeasureEvery = 4;
    const int wanted = to_convergence ? kMost : params.bounces - 1;

    voxels.faces().bind();
    albedo_.bind(GL_SHADER_STORAGE_BUFFER, shared::kAlbedoBinding);
    voxels.shading().radiance().bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
    links_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLinkBinding);
    from_emitters_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFromEmittersBinding);
    change_.bind(GL_SHADER_STORAGE_BUFFER, shared::kChangeBinding);
    bool settled = false;
    for (count_ = 0; count_ < wanted; ++count_) {
        const bool is_last = settled || count_ + 1 == wanted;
        const bool measure = to_convergence && !is_last && count_ % kMeasureEvery == kMeasureEvery - 1;
        const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
        const gl::Program& bounce = bounce_.with({{"EMITTERS", flag(has_emitters_)},
                                                  {"FIRST", flag(count_ == 0)},
                                                  {"LAST", flag(is_last)},
                                                  {"MEASURE", flag(measure)}});
        bounce.set("links_per_face", params.links);
        bounce.set("sky_radiance", glm::vec3(cones.sky));
        bounce.use();
        packed_[0].bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBeforeBinding);
        (is_last ? reflected_ : packed_[1]).bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceAfterBinding);
        if (measure) change_.clear();
        gl::dispatch_items(faces.face_count(), 64);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        std::swap(packed_[0], packed_[1]);
        if (settled) break;
        if (!measure) continue;
        const auto largest = change_.read_at<std::array<GLuint, 2>>(0);
        settled = std::bit_cast<float>(largest[0]) <= params.tolerance * std::bit_cast<float>(largest[1]);
    }
    return true;
}

std::vector<gl::Resource> Bounces::resources() const
{
    return {links_.resource(),     from_emitters_.resource(), albedo_.resource(),
            packed_[0].resource(), packed_[1].resource(),     reflected_.resource()};
}

}  // namespace conebook
