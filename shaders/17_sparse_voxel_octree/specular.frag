#version 450 core
// Light in the specular lobe of every pixel, by cones through the octree.
#include "17_sparse_voxel_octree/cone.glsl"
#define OWN_TRACE_LOBE
vec3 trace_lobe(RayStart start, vec3 direction, float tan_half)
{
    return trace_cone(start, direction, tan_half, 0.0).radiance;
}
#include "09_specular_cones/lobe_light.glsl"
