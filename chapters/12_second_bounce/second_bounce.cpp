#include "12_second_bounce/second_bounce.hpp"

#include <array>
#include <bit>

namespace conebook {

void add_parameters(ParameterTable& table, BounceParams& params)
{
    table.add("bounces", params.bounces, -1, 64, "", "indirect bounces; -1: until nothing changes");
    table.add("tolerance", params.tolerance, 1e-6, 0.1, "", "bounces=-1: largest change over largest radiance");
}

SecondBounce::SecondBounce(gl::Shaders& shaders)
    : program_(shaders.load({"12_second_bounce/bounce.comp"}, {{"PLAIN", "0"}})),
      change_("bounce change", 2 * sizeof(GLuint))
{
}

void SecondBounce::run(LitVoxels& voxels, const DiffuseConeUniforms& cones, const ConeParams& cone_params,
                       const BounceParams& params)
{
    const VoxelFaces& faces = voxels.faces();
    const std::size_t bytes = faces.face_count() * sizeof(glm::vec4);
    if (bounced_.bytes() < bytes) bounced_ = gl::Buffer("bounced radiance", bytes);
    bounced_.clear();
    const bool to_convergence = params.bounces < 0;
    constexpr int kMostGatherings = 256;  // 0.99^256 = 0.08: the brightest white allowed is not quite done by then
    const int wanted = to_convergence ? kMostGatherings : params.bounces - 1;

    for (gatherings_ = 0; gatherings_ < wanted; ++gatherings_) {
        // Every face gathers.
        change_.clear();
        voxels.grid().bind();
        faces.bind();
        voxels.pyramid().bind();
        voxels.shading().radiance().bind(GL_SHADER_STORAGE_BUFFER, 11);
        bounced_.bind(GL_SHADER_STORAGE_BUFFER, 12);
        change_.bind(GL_SHADER_STORAGE_BUFFER, 13);
        cones.bind(program_, cone_params);
        program_.use();
        glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.face_groups().id());
        glDispatchComputeIndirect(0);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);

        // The pyramids again, from what the faces send now.
        voxels.pyramid().run(voxels.grid(), faces, bounced_);
        if (!to_convergence) continue;
        const auto largest = change_.read_at<std::array<GLuint, 2>>(0);
        if (std::bit_cast<float>(largest[0]) <= params.tolerance * std::bit_cast<float>(largest[1])) {
            ++gatherings_;
            break;
        }
    }
}

}  // namespace conebook
