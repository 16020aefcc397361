// Numbers of storage buffers and uniform blocks, as C++ binds them and GLSL declares them. Texture units stand with
// what is bound to them (scene_structs.glsl, voxel_structs.glsl, shadow_structs.glsl).
#ifdef __cplusplus
#pragma once
#endif
#include "common/cpp_glsl.glsl"

CONEBOOK_SHARED_BEGIN

// Uniform blocks. Numbers are plenty (84), so each block has its own for good.
CONEBOOK_CONSTANT int kCameraBlock = 0;
CONEBOOK_CONSTANT int kGridBlock = 1;
CONEBOOK_CONSTANT int kConeBlock = 2;
CONEBOOK_CONSTANT int kMaterialBlock = 3;
CONEBOOK_CONSTANT int kPyramidBlock = 4;
CONEBOOK_CONSTANT int kEmissionPyramidBlock = 5;

// Storage buffers. OpenGL 4.5 promises a pass eight of them, numbered 0 to 7, in fragment and compute shaders, and none
// in vertex and geometry shaders (chapter 23, MAX_SHADER_STORAGE_BUFFER_BINDINGS, MAX_*_SHADER_STORAGE_BLOCKS).
// What many passes read keeps its number; VoxelFaces::bind() puts all but lights and radiance in place.
CONEBOOK_CONSTANT int kFaceListBinding = 0;
CONEBOOK_CONSTANT int kLightBinding = 1;
CONEBOOK_CONSTANT int kFaceBinding = 2;
CONEBOOK_CONSTANT int kRadianceBinding = 3;
CONEBOOK_CONSTANT int kVoxelCounterBinding = 5;
CONEBOOK_CONSTANT int kVoxelListBinding = 7;

// A pass puts its own buffers at 4 and 6, and at numbers of the above that it has no use for. Each binds what it reads
// right before it runs.
// 04, 05: voxelization has triangles instead of faces.
CONEBOOK_CONSTANT int kTriangleMaterialBinding = 1;
CONEBOOK_CONSTANT int kVertexBinding = 2;
CONEBOOK_CONSTANT int kIndexBinding = 3;
CONEBOOK_CONSTANT int kFragmentRangeBinding = 4;
CONEBOOK_CONSTANT int kFragmentBinding = 6;
CONEBOOK_CONSTANT int kLargeTriangleBinding = 7;
CONEBOOK_CONSTANT int kSumBinding = 4;
CONEBOOK_CONSTANT int kBlockBinding = 6;
// Poses write the vertices.
CONEBOOK_CONSTANT int kModelledBinding = 0;
CONEBOOK_CONSTANT int kMorphDeltaBinding = 1;
CONEBOOK_CONSTANT int kPoseMatrixBinding = 3;
CONEBOOK_CONSTANT int kMorphWeightBinding = 4;
// 03
CONEBOOK_CONSTANT int kShadowLayerBinding = 4;
CONEBOOK_CONSTANT int kShadowLightBinding = 6;
// 06, 10: passes over faces need no list of voxels.
CONEBOOK_CONSTANT int kVisibilityBinding = 7;
// 07
CONEBOOK_CONSTANT int kClaimedBinding = 3;
CONEBOOK_CONSTANT int kOccupiedBinding = 4;
CONEBOOK_CONSTANT int kLightScaleBinding = 4;
CONEBOOK_CONSTANT int kLevelBinding = 6;
// 08
CONEBOOK_CONSTANT int kWalkCellBinding = 4;
CONEBOOK_CONSTANT int kWalkBitBinding = 6;
// 11
CONEBOOK_CONSTANT int kEmitterTriangleBinding = 3;
CONEBOOK_CONSTANT int kEmitterBinding = 6;
// 12
CONEBOOK_CONSTANT int kRadianceBeforeBinding = 0;
CONEBOOK_CONSTANT int kFromEmittersBinding = 1;
CONEBOOK_CONSTANT int kRadianceAfterBinding = 2;
CONEBOOK_CONSTANT int kLinkBinding = 4;
CONEBOOK_CONSTANT int kChangeBinding = 6;
CONEBOOK_CONSTANT int kAlbedoBinding = 7;
// 15
CONEBOOK_CONSTANT int kDynamicVoxelBinding = 1;
CONEBOOK_CONSTANT int kDynamicCountBinding = 3;
// 16
CONEBOOK_CONSTANT int kBrickVoxelBinding = 0;
CONEBOOK_CONSTANT int kBrickTotalBinding = 1;
CONEBOOK_CONSTANT int kBrickBinding = 3;

// 17: node, node brick and brick list keep their numbers; the rest is for building.
CONEBOOK_CONSTANT int kNodeBinding = 4;
CONEBOOK_CONSTANT int kNodeBrickBinding = 6;
CONEBOOK_CONSTANT int kTreeStateBinding = 0;
CONEBOOK_CONSTANT int kNodePlaceBinding = 1;
CONEBOOK_CONSTANT int kTreeBlockBinding = 3;
CONEBOOK_CONSTANT int kVoxelNodeBinding = 3;
CONEBOOK_CONSTANT int kFluxBinding = 0;
CONEBOOK_CONSTANT int kLeafFaceBinding = 5;
CONEBOOK_CONSTANT int kBrickListBinding = 7;
CONEBOOK_CONSTANT int kTreeWeightBinding = 0;
CONEBOOK_CONSTANT int kReflectedBinding = 1;
CONEBOOK_CONSTANT int kTreeChangeBinding = 7;
// 18: pieces of triangles instead of faces, and what is counted of them.
CONEBOOK_CONSTANT int kPieceBinding = 2;
CONEBOOK_CONSTANT int kPieceCountBinding = 5;
// 19
CONEBOOK_CONSTANT int kPatchBinding = 2;
CONEBOOK_CONSTANT int kPatchLightBinding = 3;
CONEBOOK_CONSTANT int kSightBinding = 4;

CONEBOOK_SHARED_END
