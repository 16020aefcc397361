// Pyramids of light that hold what is there and nothing else: bits say which voxels of a brick, lists have their texels.
//
// Where the bytes of chapter 12 are, Sponza at 256 voxels: 426 of 693 MB in volumes of which 2 to 9 % hold anything:
// light pyramid 345, occupancy 29, walk volume 26, face index 25; most of the rest follows the surface.
#pragma once

#include "07_anisotropic_mips/light_pyramid.hpp"

namespace conebook {

// Which voxels of all levels hold something, and of which sides: shaders/16_only_what_is_needed/brick_index.glsl.
class BrickIndex {
public:
    explicit BrickIndex(gl::Shaders& shaders);
    // If the faces have changed. Reads two counters back. Throws std::runtime_error when there are more texels than an
    // index (2^26) holds.
    void run(const VoxelGrid& grid, const VoxelFaces& faces, const OccupiedLevels& occupied, Directions directions);

    const gl::Texture& bricks() const { return bricks_; }     // rgba32ui, a list in rows of kListWidth, as the next one
    const gl::Texture& voxels() const { return voxels_; }     // r32ui: first texel << 6 | directions
    std::size_t texel_count() const { return texel_count_; }  // with the empty one at 0
    std::vector<gl::Resource> resources() const { return {bricks_.resource(), voxels_.resource()}; }

private:
    gl::ProgramVariants mark_, directions_;
    gl::Program places_, texels_;
    gl::Buffer totals_;
    gl::Texture bricks_, voxels_;
    std::size_t texel_count_ = 0;
    MadeFrom<Revision, Directions> made_from_;  // faces
};

// The storage of all pyramids over the same faces; they share the index.
class BrickLight {
public:
    // `params`, those of the pyramid of the voxels, must outlive this: where it does not tell directions apart, none of them
    // can be left out.
    BrickLight(gl::Shaders& shaders, const PyramidParams& params) : index_(shaders), params_(params) {}
    // For pyramids; this must outlive them.
    LightStorage storage()
    {
        return
            [this](LightTexels& texels, const VoxelGrid& grid, const VoxelFaces& faces, const OccupiedLevels& occupied,
                   const PyramidParams& params) { fit(texels, grid, faces, occupied, params); };
    }
    const BrickIndex& index() const { return index_; }

private:
    void fit(LightTexels& texels, const VoxelGrid& grid, const VoxelFaces& faces, const OccupiedLevels& occupied,
             const PyramidParams& params);
    BrickIndex index_;
    const PyramidParams& params_;
};

}  // namespace conebook
