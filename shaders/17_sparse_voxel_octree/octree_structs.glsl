// What the passes that build the octree count, as C++ and GLSL read it.
#ifdef __cplusplus
#pragma once
#endif
#include "common/cpp_glsl.glsl"

CONEBOOK_SHARED_BEGIN

CONEBOOK_CONSTANT int kMaxTreeLevels = 10;           // a root of 1024 voxels
CONEBOOK_CONSTANT uint kChildFlag = 0x80000000u;     // of a child that is to be made
CONEBOOK_CONSTANT int kNodesPerBlock = 8;            // what one thread counts and places
CONEBOOK_CONSTANT int kBrickRow = 128;               // bricks along x, and along y, of the pool
CONEBOOK_CONSTANT int kBrickPoolUnit = 21;           // where chapter 07 has a coverage of its own
CONEBOOK_CONSTANT int kMaxSampledNodes = 255;         // that a test cone writes down

// Nodes of a level are numbered one after another: first those that hold geometry, then their empty neighbours.
struct TreeLevel {
    uint begin, geometry_end, end;
    uint bricks;            // first brick of the level; the next level's are behind this one's
    uvec4 geometry_groups;  // indirect dispatch: 64 nodes with geometry a work group
    uvec4 block_groups;     // indirect dispatch: 64 blocks of nodes a work group
};

struct OctreeState {
    uint nodes, bricks;  // of all levels
    uint capacity;       // nodes that there is room for
    uint wanted;         // nodes that would have been made; more than `capacity`: too few were
    TreeLevel levels[kMaxTreeLevels];
};

CONEBOOK_SHARED_END
