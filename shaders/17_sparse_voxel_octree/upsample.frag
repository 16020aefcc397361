#version 450 core
// Indirect diffuse light of every pixel; where no point fits, by cones through the octree.
#include "17_sparse_voxel_octree/cone.glsl"
#include "08_diffuse_cones/upsample.glsl"
