// The voxel grid and the faces of its voxels, as C++ writes them and GLSL reads them.
#ifdef __cplusplus
#pragma once
#endif
#include "common/cpp_glsl.glsl"

CONEBOOK_SHARED_BEGIN

// Grid space: one unit is one voxel; voxel (i, j, k) is the half-open box [i, i+1) x [j, j+1) x [k, k+1).
struct GridData {
    vec4 origin;       // xyz: scene space position of grid space (0,0,0), w: voxel size in m
    ivec4 size;        // xyz: voxels along each axis, a multiple of 2^(levels-1); w: levels of the pyramid
    vec4 content_min;  // xyz: the scene's bounds in grid space
    vec4 content_max;
};

// Texture units of the volumes.
CONEBOOK_CONSTANT int kLightAtlasUnit = 20;
CONEBOOK_CONSTANT int kCoverageAtlasUnit = 21;
CONEBOOK_CONSTANT int kOccupancyUnit = 22;
CONEBOOK_CONSTANT int kFaceIndexUnit = 23;
CONEBOOK_CONSTANT int kPackedColorUnit = 24;
CONEBOOK_CONSTANT int kDirectionVolumeUnit = 24;  // six units
CONEBOOK_CONSTANT int kEmissionAtlasUnit = 30;
CONEBOOK_CONSTANT int kWalkVolumeUnit = 31;

// Whole coverage in the walk volume, in its units: five bits, and one half is a whole number.
CONEBOOK_CONSTANT float kWalkUnits = 30.0;

// Face directions: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z. A triangle belongs to the face that its normal is nearest to.
CONEBOOK_CONSTANT int kFaceCount = 6;

// One face of an occupied voxel: means over all fragments of that face, weighted by their area.
struct VoxelFace {
    vec4 albedo_area;  // rgb: share that both lobes reflect, linear; a: area inside the voxel, in voxel sides squared
    vec4 normal;       // xyz: unit mean normal
    vec4 emission;     // rgb: radiance W/(sr m^2)
    vec4 position;     // xyz: centroid in grid space
};

// A part of the emitting surfaces, that rays are aimed at.
struct EmitterPart {
    vec4 position;   // xyz: grid space; w: radius of a disc of the part's area, voxels, squared
    vec4 normal;     // xyz: unit; w: as bits, the directions in which something lies within its blur
    vec4 intensity;  // rgb: radiance times area, W/(sr m^2) x voxel sides squared
};

// Height above an emitter, in voxels, in which its own blur and that of what it hangs on would hide it: there rays
// against the triangles themselves have been asked, in bands of equal solid angle from the horizon up, each in so many
// sectors.
CONEBOOK_CONSTANT float kEmitterBlur = 1.5;
CONEBOOK_CONSTANT int kMaskBands = 4;
CONEBOOK_CONSTANT int kMaskSectors = 8;

// An emitting triangle of even radiance, in grid space; its front winds counter-clockwise.
struct EmitterTriangle {
    vec4 a, b, c;  // xyz: corners; w: radiance, red, green and blue, W/(sr m^2)
};

// Sums of one face as 64-bit fixed point numbers: word i is the low half of sum i, word kSumCount + i its high half,
// which few fragments touch.
CONEBOOK_CONSTANT int kSumArea = 0;
CONEBOOK_CONSTANT int kSumAlbedo = 1;     // 3
CONEBOOK_CONSTANT int kSumEmission = 4;   // 3
CONEBOOK_CONSTANT int kSumNormal = 7;     // 3, of (n + 1)
CONEBOOK_CONSTANT int kSumPosition = 10;  // 3, within the voxel, 0..1
CONEBOOK_CONSTANT int kSumCount = 13;
CONEBOOK_CONSTANT float kFixedPointOne = 1073741824.0;  // 2^30: area * (n + 1) of a fragment is at most 2 sqrt(2) < 4 = 2^32 / 2^30

// Counters of one voxelization.
struct VoxelStatistics {
    uint degenerate;   // triangles without area, left out
    uint large;        // triangles of many columns, which the compute voxelizer takes apart
    uint voxels;       // occupied voxels
    uint faces;        // occupied faces of them, one to six a voxel
};

// A fragment is a pair of a triangle and a voxel that overlap. Where those of a material are in the list of fragments:
// at [begin, begin + min(count, capacity)).
struct FragmentRange {
    uint begin, capacity;
    uint count;  // found, also where there was no room
    uint unused;
};

CONEBOOK_SHARED_END
