#include "12_second_bounce/second_bounce.hpp"

#include <array>
#include <bit>

namespace conebook {

void add_parameters(ParameterTable& table, BounceParams& params)
{
    table.add("bounces", params.bounces, -1, 64, "", "indirect bounces; -1: until nothing changes");
    table.add("tolerance", params.tolerance, 1e-6, 0.1, "", "bounces=-1: largest change over largest radiance");
}

SecondBounce::SecondBounce(gl::Shaders& shaders, bool emission_apart)
    : gather_(shaders, {"12_second_bounce/bounce.comp"}, {{"PLAIN", "0"}, {"EMITTED", emission_apart ? "1" : "0"}}),
      send_on_(shaders.load({"12_second_bounce/send_on.comp"})),
      change_("bounce change", 2 * sizeof(GLuint))
{
}

void SecondBounce::run(LitVoxels& voxels, const Emitters& emitters, const DiffuseConeUniforms& cones,
                       const ConeParams& cone_params, const BounceParams& params)
{
    const VoxelFaces& faces = voxels.faces();
    const std::size_t bytes = faces.face_count() * sizeof(glm::vec4);
    if (bounced_.bytes() < bytes) {
        gathered_ = gl::Buffer("gathered by faces", bytes);
        bounced_ = gl::Buffer("bounced radiance", bytes);
    }
    bounced_.clear();
    const bool to_convergence = params.bounces < 0;
    constexpr int kMostGatherings = 256;  // 0.99^256 = 0.08: the brightest white allowed is not quite done by then
    const int wanted = to_convergence ? kMostGatherings : params.bounces - 1;

    for (gatherings_ = 0; gatherings_ < wanted; ++gatherings_) {
        // Every face gathers.
        voxels.grid().bind();
        faces.bind();
        voxels.pyramid().bind();
        const gl::Program& gather = gather_.reading(voxels.pyramid());
        cones.bind(gather, cone_params);
        if (emitters.are_apart()) emitters.bind(gather, cones);
        gathered_.bind(GL_SHADER_STORAGE_BUFFER, shared::kGatheredBinding);
        gather.use();
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.face_groups().id());
        glDispatchComputeIndirect(0);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

        // Every face sends on its share of what its wall gathered.
        change_.clear();
        voxels.shading().radiance().bind(GL_SHADER_STORAGE_BUFFER, shared::kRadianceBinding);
        change_.bind(GL_SHADER_STORAGE_BUFFER, shared::kChangeBinding);
        bounced_.bind(GL_SHADER_STORAGE_BUFFER, shared::kBouncedBinding);
        send_on_.use();
        glDispatchComputeIndirect(0);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

        // snippet: next_bounce
        // The pyramids again, from what the faces send now.
        voxels.pyramid().run(voxels.grid(), faces, bounced_, emitters.part_of_voxels());
        if (!to_convergence) continue;
        const auto largest = change_.read_at<std::array<GLuint, 2>>(0);
        if (std::bit_cast<float>(largest[0]) <= params.tolerance * std::bit_cast<float>(largest[1])) {
            ++gatherings_;
            break;
        }
        // end snippet
    }
}

}  // namespace conebook
