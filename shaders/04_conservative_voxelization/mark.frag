#version 450 core
#include "04_conservative_voxelization/mark.glsl"
#include "04_conservative_voxelization/voxelize_fragment.glsl"
