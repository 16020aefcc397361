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
    Emitters(gl::Shaders& shaders, const Scene& scene, const VoxelGrid& grid, const EmitterParams& params);

    // What the pyramid of the voxels is to hold: all light, or what surfaces reflect where this keeps the rest.
    LightPart part_of_voxels() const { return apart_ ? LightPart::reflected : LightPart::all; }
    bool are_apart() const { return apart_; }

    // From what the faces emit, if they have changed: the pyramid, and the parts to aim at. Reads the faces back.
    bool run(const VoxelGrid& grid, const VoxelFaces& faces, const VoxelShading& shading);

    // Where DiffuseCones and SpecularCones find the programs that they need: this chapter's where emission is apart,
    // otherwise `without`.
    std::string shader_folder(const std::string& without) const;
    // For programs that include emitted_light.glsl and see emitters at any distance, as specular cones do.
    void bind_all(const gl::Program& program) const;
    // For programs that include gather_all.glsl: storage 6.
    void bind(const gl::Program& program, const ConeDirections& directions) const;
    Revision revision() const { return revision_; }
    const LightPyramid* pyramid() const { return pyramid_ ? &*pyramid_ : nullptr; }
    std::vector<gl::Resource> resources() const;
    Need need() const;

private:
    EmitterParams params_;
    float emitting_share_;  // of the scene's area
    bool apart_;
    std::optional<LightPyramid> pyramid_;
    MadeFrom<Revision> made_from_;  // faces
    Revision revision_ = 0;
    gl::Buffer parts_;
    float near_radius2_voxels_ = 0.0f;
};

// Share of the area of all triangles that belongs to shining materials.
float emitting_share(const Scene& scene);

// Power that the voxels emit, by colour channel: sum over faces of pi L A, in W. Reads the faces back.
glm::dvec3 emitted_power_w(const VoxelFaces& faces, const VoxelGrid& grid);

}  // namespace conebook
