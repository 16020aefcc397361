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

void add_warm_start(ParameterTable& table, BounceParams& params)
{
    table.add("warm_start", params.warm_start, "bounces=-1 begins with the last solution");
    table.add("bounces_a_frame", params.bounces_a_frame, 0, 64, "", "with warm_start; 0: until nothing changes");
}

Bounces::Bounces(gl::Shaders& shaders)
    : link_(shaders, {"12_second_bounce/links.comp"}),
      bounce_(shaders, {"12_second_bounce/bounce.comp"}),
      change_("bounce change", 2 * sizeof(GLuint))
{
}

bool Bounces::link(const LitVoxels& voxels, const WalkVolume& walk, const Emitters& emitters, const ConeParams& cones,
                   const BounceParams& params, const FaceChange& change)
{
    const bool other_rays = linked_with_.differs(cones.start_offset, cones.cone_table, cones.aperture, params.links);
    if (!linked_from_.differs(walk.revision(), voxels.coverage_revision(), emitters.revision()) && !other_rays)
        return false;
    ++links_revision_;
    constexpr int kSets = 64;  // of 8 x 8 faces of a wall
    const VoxelFaces& faces = voxels.faces();
    // Rays at emitters come from everywhere.
    const bool some = !other_rays && !emitters.are_apart() && change.from != 0 && linked_faces_ == change.from &&
                      faces.revision() == change.to && linked_order_ == faces.order();
    linked_faces_ = faces.revision();
    linked_order_ = faces.order();
    const std::size_t count = faces.face_count();
    const auto fit = [&](gl::Buffer& buffer, const char* label, std::size_t bytes_of_face) {
        gl::grow(buffer, label, count * bytes_of_face, some ? buffer.bytes() : 0);
    };
    fit(links_, "links", std::size_t(params.links) * sizeof(GLuint));
    has_emitters_ = emitters.shine() || emitters.are_apart();
    if (has_emitters_)
        fit(from_emitters_, "from emitters", sizeof(glm::vec4));
    else
        from_emitters_ = {};
    fit(albedo_, "reflectance of faces", sizeof(GLuint));
    gl::grow(reflected_, "reflected by faces", count * sizeof(glm::vec4), reflected_.bytes());

    voxels.grid().bind();
    voxels.faces().bind();
    voxels.pyramid().bind();
    walk.bind();
    gl::Defines defines = {{"MARCH", "0"},
                           {"EMITTERS", emitters.are_apart() ? "1"
                                        : emitters.shine()   ? "2"
                                                             : "0"},
                           {"SOME", some ? "1" : "0"}};
    defines.merge(ConeVolumes{voxels.grid(), voxels.pyramid(), walk}.defines());
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
    link.set("kept_faces", faces.kept());
    link.set("changed_low", glm::vec3(change.low));
    link.set("changed_high", glm::vec3(change.high + 1));
    link.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, voxels.faces().face_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return true;
}

bool Bounces::run(const LitVoxels& voxels, const ConeParams& cones, const BounceParams& params)
{
    const bool changed = made_from_.differs(links_revision_, voxels.shading().revision(), cones.sky, params);
    if (!changed && settled_) return false;
    ++revision_;
    const VoxelFaces& faces = voxels.faces();
    for (gl::Buffer& buffer : packed_)
        gl::grow(buffer, "radiance of faces between bounces", faces.face_count() * sizeof(glm::uvec2), 0);
    const bool to_convergence = params.bounces < 0;
    const bool warm = to_convergence && params.warm_start && solved_order_ == faces.order();
    const bool limited = warm && params.bounces_a_frame > 0;
    constexpr int kMost = 256;  // 0.99^256 = 0.08: the brightest white allowed is not quite done by then
    const int measure_every = warm ? 1 : 4;
    const int wanted = !to_convergence ? params.bounces - 1 : limited ? params.bounces_a_frame : kMost;
    const std::size_t known = solved_faces_ == faces.revision() ? faces.face_count() : faces.kept();
    if (warm) {
        std::swap(reflected_, last_reflected_);
        gl::grow(reflected_, "reflected by faces", faces.face_count() * sizeof(glm::vec4), 0);
    }
    solved_faces_ = faces.revision();
    solved_order_ = faces.order();

    voxels.faces().bind();
    albedo_.bind(GL_SHADER_STORAGE_BUFFER, shared::kAlbedoBinding);
    voxels.shading().radiance().bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
    links_.bind(GL_SHADER_STORAGE_BUFFER, shared::kLinkBinding);
    from_emitters_.bind(GL_SHADER_STORAGE_BUFFER, shared::kFromEmittersBinding);
    change_.bind(GL_SHADER_STORAGE_BUFFER, shared::kChangeBinding);
    bool settled = false;
    for (count_ = 0; count_ < wanted; ++count_) {
        const bool is_last = settled || count_ + 1 == wanted;
        const bool measure =
            limited ? is_last : to_convergence && !is_last && count_ % measure_every == measure_every - 1;
        const auto flag = [](bool on) { return std::string(on ? "1" : "0"); };
        const gl::Program& bounce = bounce_.with({{"EMITTERS", flag(has_emitters_)},
                                                  {"FIRST", flag(count_ == 0)},
                                                  {"WARM", flag(count_ == 0 && warm)},
                                                  {"LAST", flag(is_last)},
                                                  {"MEASURE", flag(measure)}});
        bounce.set("links_per_face", params.links);
        bounce.set("sky_radiance", glm::vec3(cones.sky));
        bounce.set("known_faces", GLuint(known));
        bounce.use();
        (count_ == 0 && warm ? last_reflected_ : packed_[0])
            .bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBeforeBinding);
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
    settled_ = settled || !limited;
    return true;
}

std::vector<gl::Resource> Bounces::resources() const
{
    return {links_.resource(),     from_emitters_.resource(), albedo_.resource(),        packed_[0].resource(),
            packed_[1].resource(), reflected_.resource(),     last_reflected_.resource()};
}

}  // namespace conebook
