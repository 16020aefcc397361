#version 450 core
// A level of the tree, step 3: counts of blocks to where each block's part begins (an exclusive prefix sum), so that
// numbers do not depend on the order of the threads. One work group: every thread sums a run of blocks, the runs' sums
// are scanned, then every thread writes its run. COUNTED 0: children with geometry, 1: empty ones, 2: bricks.
#include "17_sparse_voxel_octree/octree_structs.glsl"
#include "common/bindings.glsl"

layout(local_size_x = 256) in;
layout(std430, binding = kTreeStateBinding) buffer StateBuffer { OctreeState tree; };
layout(std430, binding = kTreeBlockBinding) buffer BlockBuffer { uint blocks[]; };
uniform int level;

shared uint run_sum[256];

uvec4 groups_of(uint items)
{
    uint groups = (items + 63u) / 64u;
    return uvec4(min(groups, 65535u), (groups + 65534u) / 65535u, 1u, 0u);
}

void main()
{
    uint thread = gl_LocalInvocationIndex, per_block = uint(kNodesPerBlock);
    uint count = (tree.levels[level].end - tree.levels[level].begin + per_block - 1u) / per_block;
    uint run = (count + 255u) / 256u, first = min(thread * run, count), last = min(first + run, count), sum = 0u;
    for (uint block = first; block < last; ++block) sum += blocks[block];
    run_sum[thread] = sum;
    barrier();
    if (thread == 0u) {
        uint total = 0u;
        for (int i = 0; i < 256; ++i) {
            uint own = run_sum[i];
            run_sum[i] = total;
            total += own;
        }
#if COUNTED == 2
        tree.levels[level].bricks = tree.bricks;
        tree.bricks += total;
#else
        // snippet: new_nodes
        tree.wanted += total;
        uint begin = tree.nodes, end = min(begin + total, tree.capacity);
        tree.nodes = end;
#if COUNTED == 0
        tree.levels[level + 1].begin = begin;
        tree.levels[level + 1].geometry_end = end;
        tree.levels[level + 1].geometry_groups = groups_of(end - begin);
#endif
        tree.levels[level + 1].end = end;
        uint nodes_of_level = end - tree.levels[level + 1].begin;
        tree.levels[level + 1].block_groups = groups_of((nodes_of_level + per_block - 1u) / per_block);
        // end snippet
#endif
    }
    barrier();
    uint begin = run_sum[thread];
    for (uint block = first; block < last; ++block) {
        uint own = blocks[block];
        blocks[block] = begin;
        begin += own;
    }
}
