#version 450 core
// Indirect diffuse light of every point that gathers.
#include "08_diffuse_cones/gather.glsl"
#define GATHER(start, geometric_normal, normal, position_grid, set) gather_diffuse(start, geometric_normal, normal, set)
#include "08_diffuse_cones/gather_point.glsl"
