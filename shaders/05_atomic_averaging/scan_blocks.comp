#version 450 core
// List of occupied voxels, step 2: turn the counts of the blocks into where each block's part of the list begins.
// One work group: every thread sums a run of blocks, the runs' sums are scanned, then every thread writes its run.
// The list has the same order in every run, whatever the order of the threads.
#include "common/voxel_grid.glsl"
#include "common/voxel_counters.glsl"
#include "05_atomic_averaging/blocks.glsl"

layout(local_size_x = 256) in;
layout(std430, binding = kBlockBinding) buffer BlockBuffer { Block blocks[]; };

shared uvec2 run_sum[256];

void main()
{
    uint thread = gl_LocalInvocationIndex, count = block_count();
    uint run = (count + 255u) / 256u;
    uint first = min(thread * run, count), last = min(first + run, count);
    uvec2 sum = uvec2(0u);
    for (uint block = first; block < last; ++block) sum += uvec2(blocks[block].voxels, blocks[block].faces);
    run_sum[thread] = sum;
    barrier();
    if (thread == 0u) {
        uvec2 total = uvec2(0u);
        for (int i = 0; i < 256; ++i) {
            uvec2 own = run_sum[i];
            run_sum[i] = total;
            total += own;
        }
        voxel_statistics.voxels = total.x;
        voxel_statistics.faces = total.y;
    }
    barrier();
    uvec2 begin = run_sum[thread];
    for (uint block = first; block < last; ++block) {
        uvec2 own = uvec2(blocks[block].voxels, blocks[block].faces);
        blocks[block].voxels = begin.x;
        blocks[block].faces = begin.y;
        begin += own;
    }
}
