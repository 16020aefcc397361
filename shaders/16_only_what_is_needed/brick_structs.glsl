// Bricks, as C++ sizes them and GLSL reads them.
#ifdef __cplusplus
#pragma once
#endif
#include "common/cpp_glsl.glsl"

CONEBOOK_SHARED_BEGIN

CONEBOOK_CONSTANT int kBrickSide = 4;      // voxels: 64 of them, a bit each in two words
CONEBOOK_CONSTANT int kListWidth = 4096;   // lists lie in rows of so many texels; OpenGL 4.5 promises 16,384
CONEBOOK_CONSTANT int kLevelRecords = 8;   // in front of the list of bricks, one for each level

// Texture units.
CONEBOOK_CONSTANT int kBrickUnit = 32;
CONEBOOK_CONSTANT int kBrickVoxelUnit = 33;
CONEBOOK_CONSTANT int kWalkBrickUnit = 34;

CONEBOOK_SHARED_END
