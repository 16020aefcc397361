#include "11_emissives/emissive_light.hpp"

#include <numbers>

namespace conebook {

EmissiveLight::EmissiveLight(gl::Shaders& shaders) : program_(shaders.load({"11_emissives/emission.comp"})) {}

const gl::Buffer& EmissiveLight::run(const VoxelFaces& faces)
{
    const std::size_t bytes = faces.face_count() * sizeof(glm::vec4);
    if (emission_.bytes() < bytes) emission_ = gl::Buffer("face emission", bytes);
    faces.bind();
    emission_.bind(GL_SHADER_STORAGE_BUFFER, 11);
    program_.use();
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, faces.face_groups().id());
    glDispatchComputeIndirect(0);
    glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
    return emission_;
}

// snippet: power
glm::dvec3 emitted_power_w(const VoxelFaces& faces, const VoxelGrid& grid)
{
    const double face_area_m2 = double(grid.voxel_size_m()) * double(grid.voxel_size_m());
    const auto all = faces.faces().read<shared::VoxelFace>();
    glm::dvec3 power(0.0);
    for (std::size_t i = 0; i < faces.face_count(); ++i)
        power += std::numbers::pi * glm::dvec3(all[i].emission) * double(all[i].albedo_area.a) * face_area_m2;
    return power;
}
// end snippet

}  // namespace conebook
