// The voxels of what moves, as C++ writes them and GLSL reads them.
#ifdef __cplusplus
#pragma once
#endif
#include "common/cpp_glsl.glsl"

CONEBOOK_SHARED_BEGIN

// A voxel that something that moves overlaps, and what was there before it came: so it can be taken out again.
struct DynamicVoxel {
    uint voxel;   // pack_voxel() | kLostVoxel
    uint before;  // its word of the face index, of what stands still alone; 0: nothing
};
// Something stands still there, and overlap=drop leaves it the voxel.
CONEBOOK_CONSTANT uint kLostVoxel = 0x80000000u;
// In the word of the occupancy while the list is made: the voxel is in it.
CONEBOOK_CONSTANT uint kListedVoxel = 0x100u;

struct DynamicCounts {
    uint voxels;        // in the list, lost ones too
    uint faces;         // of those that are not lost: what stands still in them included
    uint new_voxels;    // where nothing stands still
    uint lost;
    uint placed_faces;  // while they get their places
    uint placed_voxels;
    // The box of the list's voxels: 511 minus its lowest coordinates, and its highest ones, so that both begin at 0.
    uint below_x, below_y, below_z, high_x, high_y, high_z;
};

CONEBOOK_SHARED_END
