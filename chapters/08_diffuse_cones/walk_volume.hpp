// The volume that rays leap through: where nothing is, how far they may go; where something is, how much it covers.
#pragma once

#include "05_atomic_averaging/voxel_faces.hpp"
#include "gl/made_from.hpp"

namespace conebook {

// Made from the faces of the voxels alone, so only when these change. See shaders/08_diffuse_cones/walk.glsl for its texels.
class WalkVolume {
public:
    explicit WalkVolume(gl::Shaders& shaders);

    // Makes the volume if the faces have changed, and says whether it did. Reads one counter back.
    bool run(const VoxelGrid& grid, const VoxelFaces& faces);

    // kWalkVolumeUnit, for shaders that include 08_diffuse_cones/walk.glsl.
    void bind() const { volume_.bind(GLuint(shared::kWalkVolumeUnit)); }
    const gl::Texture& volume() const { return volume_; }  // r32ui, one more than the grid along each axis
    std::size_t occupied_cells() const { return occupied_cells_; }
    Revision revision() const { return revision_; }
    std::vector<gl::Resource> resources() const { return {volume_.resource()}; }

private:
    gl::Program mark_, double_, leaps_, coverage_;
    gl::Texture volume_;
    std::size_t occupied_cells_ = 0;
    MadeFrom<Revision> made_from_;
    Revision revision_ = 0;
};

}  // namespace conebook
