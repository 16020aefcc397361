#version 450 core
// The test cone: one cone from the surface under a pixel along its normal, which writes down the nodes that it samples.
#include "common/g_buffer.glsl"
#include "17_sparse_voxel_octree/octree_structs.glsl"
#include "common/bindings.glsl"

layout(local_size_x = 1) in;
layout(std430, binding = kTreeChangeBinding) buffer SampledBuffer { uint sampled_count; uint sampled[]; };

void keep(uint node)
{
    // A cone takes several samples of a node, one after the other.
    if (sampled_count > 0u && sampled[min(sampled_count, uint(kMaxSampledNodes)) - 1u] == node) return;
    if (sampled_count < uint(kMaxSampledNodes)) sampled[sampled_count] = node;
    ++sampled_count;
}
#define COUNT_SAMPLE(node) keep(node);
#include "17_sparse_voxel_octree/cone.glsl"

uniform ivec2 pixel;  // from the lower left
uniform float tan_half_aperture, start_offset;

void main()
{
    sampled_count = 0u;
    GBufferSample surface = read_g_buffer(pixel);
    if (!surface.covered) return;
    vec3 n = surface.geometric_normal;
    trace_cone(start_above(grid_from_scene(surface.position), n, start_offset), n, tan_half_aperture, 0.0);
}
