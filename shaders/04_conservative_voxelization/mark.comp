#version 450 core
#include "04_conservative_voxelization/mark.glsl"
void prepare(uint triangle) {}
#include "04_conservative_voxelization/voxelize_workgroup.glsl"
