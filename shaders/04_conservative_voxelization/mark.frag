#version 450 core
#include "04_conservative_voxelization/mark.glsl"
#include "common/voxelize_fragment.glsl"
