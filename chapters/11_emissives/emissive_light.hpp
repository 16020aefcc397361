// Light from surfaces that shine: told apart from the light of lamps, and counted.
#pragma once

#include "07_anisotropic_mips/lit_voxels.hpp"

namespace conebook {

class EmissiveLight {
public:
    explicit EmissiveLight(gl::Shaders& shaders);

    // vec4 a face: emitted radiance in W/(sr m^2); a light pyramid made from it holds emitters alone.
    const gl::Buffer& run(const VoxelFaces& faces);
    std::vector<gl::Resource> resources() const { return {emission_.resource()}; }

private:
    gl::Program program_;
    gl::Buffer emission_;
};

// Power that the voxels emit, by colour channel: sum over faces of pi L A, in W. Reads the faces back.
glm::dvec3 emitted_power_w(const VoxelFaces& faces, const VoxelGrid& grid);

}  // namespace conebook
