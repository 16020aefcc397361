#version 450 core
// Walk volume, step 2: a cube of twice the side holds something if one of its eight parts does. One thread a word of 32
// cells; run once for each level, from `level` to `level` + 1.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "08_diffuse_cones/walk_bits.glsl"

uniform int level;

void main()
{
    ivec3 counts = walk_row_counts();
    int i = int(item_index()), side = 1 << level;
    if (i >= counts.x * counts.y * counts.z) return;
    ivec3 at = ivec3(i % counts.x, (i / counts.x) % counts.y, i / (counts.x * counts.y));
    // snippet: double
    uint any_part = 0u;
    for (int part = 0; part < 8; ++part) {
        ivec3 offset = side * ivec3(part & 1, (part >> 1) & 1, part >> 2);
        any_part |= walk_bits_from(level, 32 * at.x + offset.x, at.yz + offset.yz);
    }
    // end snippet
    walk_bits[(level + 1) * counts.x * counts.y * counts.z + i] = any_part;
}
