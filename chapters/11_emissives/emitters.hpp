// Emitting surfaces as lights: rays aimed at them, and pyramids of what they emit for the cones that meet them nearby.
#pragma once

#include <optional>

#include "07_anisotropic_mips/lit_voxels.hpp"
#include "09_specular_cones/specular_cones.hpp"

namespace conebook {

struct EmitterParams {
    // Rays that every pixel, and every face of a voxel, aims at emitters, 0 .. 64; 0: emitters are met by chance alone.
    // Neighbours share them as they share cones: 16 times as many parts of the emitters are seen.
    int aimed_rays = 6;
};
void add_parameters(ParameterTable& table, EmitterParams& params);

class Emitters {
public:
    // Emission is kept apart where it is worth it: where something shines, and not so much of the scene that cones meet it
    // as well as aimed rays would.
    Emitters(gl::Shaders& shaders, const Scene& scene, const VoxelGrid& grid, const ConservativeVoxelizer& voxelizer,
             const EmitterParams& params);

    // What the pyramid of the voxels is to hold: all light, or what surfaces reflect where this keeps the rest.
    LightPart part_of_voxels() const { return apart_ ? LightPart::reflected : LightPart::all; }
    bool are_apart() const { return apart_; }

    // From what the faces emit: the pyramid, and the parts to aim at; once for voxels that stay. Reads the faces back.
    void run(const VoxelGrid& grid, const VoxelFaces& faces, const VoxelShading& shading);

    // For diffuse cones, which gather what is near, and for specular cones, which gather all.
    EmittedLight near_light() const;
    EmittedLight all_light() const;
    const LightPyramid* pyramid() const { return pyramid_ ? &*pyramid_ : nullptr; }

    // For programs that include common/emitters.glsl: storage 14, near_light().
    void bind(const gl::Program& program, const DiffuseConeUniforms& cones) const;

    // E / pi at every pixel of what all cones gather and the aimed rays bring; as DiffuseCones::run.
    const gl::Texture& gather(DiffuseCones& diffuse_cones, const GBuffer& g_buffer, const VoxelGrid& grid,
                              const LightPyramid& pyramid, const DiffuseConeUniforms& cones, const ConeParams& params);
    // Draw for every pixel what the aimed rays bring, with aimed.frag or a variant of it, and add it to the target.
    void add_aimed(PyramidProgram& aimed, const GBuffer& g_buffer, const VoxelGrid& grid, const LightPyramid& pyramid,
                   const DiffuseConeUniforms& cones, const ConeParams& params, const gl::Framebuffer& target) const;
    std::vector<gl::Resource> resources() const;
    Need need() const;

private:
    EmitterParams params_;
    const gl::Texture* occupancy_;  // of the voxelizer
    float emitting_share_;          // of the scene's area
    bool apart_;
    std::optional<PyramidProgram> aimed_;
    std::optional<LightPyramid> pyramid_;
    gl::VertexArray no_vertices_;
    gl::Buffer parts_;
    float near_radius2_voxels_ = 0.0f;
};

// Share of the area of all triangles that belongs to shining materials.
float emitting_share(const Scene& scene);

// Power that the voxels emit, by colour channel: sum over faces of pi L A, in W. Reads the faces back.
glm::dvec3 emitted_power_w(const VoxelFaces& faces, const VoxelGrid& grid);

}  // namespace conebook
