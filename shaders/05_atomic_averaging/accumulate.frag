#version 450 core
#include "05_atomic_averaging/accumulate.glsl"
flat in TriangleAttributes attributes;
void visit(GridTriangle t, ivec3 voxel_t) { add_fragment(t, voxel_t, attributes); }
#include "04_conservative_voxelization/voxelize_fragment.glsl"
