#version 450 core
#include "05_atomic_averaging/accumulate.glsl"
TriangleAttributes attributes;
void prepare(uint triangle) { attributes = triangle_attributes(triangle); }
void visit(GridTriangle t, ivec3 voxel_t) { add_fragment(t, voxel_t, attributes); }
void count_degenerate() {}  // chapter 04's pass has counted them
#include "04_conservative_voxelization/voxelize_workgroup.glsl"
