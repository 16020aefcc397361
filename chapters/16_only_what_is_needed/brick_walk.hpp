// The volume that rays leap through, coarse where nothing is.
#pragma once

#include "08_diffuse_cones/walk_volume.hpp"

namespace conebook {

// Bricks of 4 x 4 x 4 cells: a word for each that is empty, 64 for the others. shaders/16_only_what_is_needed/brick_walk.glsl.
class BrickWalk {
public:
    explicit BrickWalk(gl::Shaders& shaders);
    // For WalkVolume; this must outlive it. Reads one counter back.
    WalkStorage storage()
    {
        return [this](WalkCellWords& cells, const VoxelGrid& grid) { fit(cells, grid); };
    }
    std::size_t listed_bricks() const { return listed_bricks_; }
    std::vector<gl::Resource> resources() const { return {bricks_.resource()}; }

private:
    void fit(WalkCellWords& cells, const VoxelGrid& grid);
    gl::Program find_bricks_;
    gl::Buffer total_;
    gl::Texture bricks_;
    std::size_t listed_bricks_ = 0;
};

}  // namespace conebook
