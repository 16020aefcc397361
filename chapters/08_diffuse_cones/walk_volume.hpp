// The volume that rays leap through: where nothing is, how far they may go; where something is, how much it covers.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "05_atomic_averaging/voxel_faces.hpp"
#include "gl/made_from.hpp"

namespace conebook {

// Where the words of the cells are.
struct WalkCellWords {
    gl::Texture words;    // r32ui
    gl::Defines defines;  // WALK_STORAGE: the file by which shaders find them, instead of walk_volume.glsl
    std::vector<std::pair<GLuint, const gl::Texture*>> index;  // what else it reads, by texture unit; not owned
};

// Makes room for the words, in what there is already where that fits. Runs while the bits of walk_bits.glsl are bound.
using WalkStorage = std::function<void(WalkCellWords& cells, const VoxelGrid& grid)>;

// Made from the faces of the voxels alone, so only when these change. See shaders/08_diffuse_cones/walk.glsl for its texels.
class WalkVolume {
public:
    // `storage`: for runs with `stored` > 0.
    explicit WalkVolume(gl::Shaders& shaders, WalkStorage storage = {});

    // Makes the volume if the faces have changed, and says whether it did. Reads one counter back. `stored` 0: a word for
    // every cell; others are those of the WalkStorage.
    bool run(const VoxelGrid& grid, const VoxelFaces& faces, int stored = 0);

    // kWalkVolumeUnit and more, for shaders that include 08_diffuse_cones/walk.glsl and are compiled with defines().
    void bind() const;
    const gl::Defines& defines() const { return cells_.defines; }
    // stored 0: one more texel than the grid has voxels along each axis.
    const gl::Texture& volume() const { return cells_.words; }
    const std::vector<std::pair<GLuint, const gl::Texture*>>& index() const { return cells_.index; }
    std::size_t occupied_cells() const { return occupied_cells_; }
    Revision revision() const { return revision_; }
    std::vector<gl::Resource> resources() const { return {cells_.words.resource()}; }

private:
    WalkStorage storage_;
    gl::Program mark_, double_;
    gl::ProgramVariants leaps_, coverage_;
    WalkCellWords cells_;
    std::size_t occupied_cells_ = 0;
    MadeFrom<Revision, int> made_from_;  // faces
    Revision revision_ = 0;
};

}  // namespace conebook
