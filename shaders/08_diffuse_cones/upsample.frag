#version 450 core
// From points to pixels; what no point fits gathers for itself.
#include "08_diffuse_cones/gather.glsl"
#define GATHER(start, geometric_normal, normal, position_grid, set) gather_diffuse(start, geometric_normal, normal, set)
#include "08_diffuse_cones/upsample_pixel.glsl"
