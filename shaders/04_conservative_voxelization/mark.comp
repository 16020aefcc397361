#version 450 core
#include "04_conservative_voxelization/mark.glsl"
void prepare(uint triangle) {}
#include "common/voxelize_workgroup.glsl"
