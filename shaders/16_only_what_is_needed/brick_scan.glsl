// Turns counts into where each item's part of a list begins, in one work group: every thread sums a run of items, the
// sums are scanned, then every thread writes its run. The list has the same order whatever the order of the threads.
layout(local_size_x = 1024) in;
layout(std430, binding = kBrickTotalBinding) buffer BrickTotals { uint totals[]; };  // of voxels, of texels
uniform uint item_count;

shared uint run_sum[1024];

// COUNT(i) of item i; PUT(i, first): its part begins at `first`. Lists begin at 1.
#define SCAN(COUNT, PUT, total)                                                        \
    uint thread = gl_LocalInvocationIndex, run = (item_count + 1023u) / 1024u;         \
    uint first = min(thread * run, item_count), last = min(first + run, item_count);   \
    uint sum = 0u;                                                                     \
    for (uint i = first; i < last; ++i) sum += COUNT(i);                               \
    run_sum[thread] = sum;                                                             \
    barrier();                                                                         \
    if (thread == 0u) {                                                                \
        uint before = 1u;                                                              \
        for (int i = 0; i < 1024; ++i) {                                               \
            uint own = run_sum[i];                                                     \
            run_sum[i] = before;                                                       \
            before += own;                                                             \
        }                                                                              \
        totals[total] = before;                                                        \
    }                                                                                  \
    barrier();                                                                         \
    uint at = run_sum[thread];                                                         \
    for (uint i = first; i < last; ++i) {                                              \
        uint own = COUNT(i);                                                           \
        PUT(i, at);                                                                    \
        at += own;                                                                     \
    }
