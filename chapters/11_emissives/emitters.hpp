// Emitting surfaces as lights: their exact light where nothing is in the way, and rays aimed at them that say what is.
#pragma once

#include "07_anisotropic_mips/lit_voxels.hpp"
#include "09_specular_cones/specular_cones.hpp"
#include "11_emissives/emitter_parts.hpp"

namespace conebook {

struct EmitterParams {
    // Rays that every point that gathers, and every face of a voxel, aims at emitters, 0 .. 64; 0: cones meet them by chance.
    // Neighbours share them as they share cones: 16 times as many parts of the emitters are seen.
    int aimed_rays = 6;
    bool operator==(const EmitterParams&) const = default;
};
void add_parameters(ParameterTable& table, EmitterParams& params);

class Emitters {
public:
    // `scene` must outlive this. `storage`: of the pyramid of emission, as of that of the voxels.
    Emitters(gl::Shaders& shaders, const Scene& scene, LightStorage storage = {})
        : scene_(scene), pyramid_(shaders, std::move(storage))
    {
    }

    // What shines, and a pyramid of it, if the faces or a parameter have changed; says whether there is anything.
    // `gpu_scene` tells whether the vertices of the scene have moved, which are then to be moved too. Emission is kept apart
    // where it is worth it: where something shines, and not so much of the scene that cones meet it as well as aimed rays
    // would. `storage`: PyramidParams::storage. `of_nothing`: a scene in which nothing shines has a pyramid of it too, to
    // measure what that costs.
    bool run(const GpuScene& gpu_scene, const VoxelGrid& grid, const VoxelFaces& faces, const VoxelShading& shading,
             const EmitterParams& params, VoxelStorage storage = VoxelStorage::dense, bool of_nothing = false);
    Revision revision() const { return revision_; }

    // All of the following is of the last run.
    // What the pyramid of the voxels is to hold: all light, or what surfaces reflect where this keeps the rest.
    LightPart part_of_voxels() const { return apart_ ? LightPart::reflected : LightPart::all; }
    bool are_apart() const { return apart_; }
    bool shine() const { return emitters_.emitting_share > 0.0; }

    // Where SpecularCones find their program: this chapter's where emission is apart.
    std::string specular_folder() const { return apart_ ? "11_emissives" : "09_specular_cones"; }
    // For programs that include emitted_light.glsl.
    void bind_emission() const;
    // For programs that include emitters.glsl and are compiled with defines(): kEmitterBinding, kEmitterTriangleBinding.
    void bind(const gl::Program& program) const;
    gl::Defines defines() const { return {{"TRIANGLES", !emitters_.triangles.empty() ? "1" : "0"}}; }
    const LightPyramid* pyramid() const { return apart_ ? &pyramid_ : nullptr; }
    std::vector<gl::Resource> resources() const;
    Need need() const;

    static constexpr int kSets = 16;  // of rays, as of cones

private:
    const Scene& scene_;
    EmitterParams params_;
    EmitterParts emitters_;
    bool apart_ = false;
    LightPyramid pyramid_;
    gl::Buffer parts_, triangles_;
    MadeFrom<Revision, Revision, EmitterParams, bool> parts_made_from_;  // grid, geometry
    MadeFrom<Revision, EmitterParams, VoxelStorage, bool> made_from_;    // faces
    Revision revision_ = 0;
};

// Power that the voxels emit, by colour channel: sum over faces of pi L A, in W. Reads the faces back.
glm::dvec3 emitted_power_w(const VoxelFaces& faces, const VoxelGrid& grid);

}  // namespace conebook
