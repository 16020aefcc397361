#version 450 core
// Walk volume, step 3: how far an empty cell lets a ray leap, for each of the eight octants that a ray may go towards;
// and the list of the cells that are not empty. One thread a word of 32 cells.
#include "common/voxel_grid.glsl"
#include "common/item_index.glsl"
#include "08_diffuse_cones/walk_bits.glsl"
#define STORES_WALK
#ifdef WALK_STORAGE
#include WALK_STORAGE
#else
#include "08_diffuse_cones/walk_volume.glsl"
#endif

layout(std430, binding = kWalkCellBinding) buffer WalkCells { uint cell_count; uint cells[]; };  // 10 bits an axis

// Number of cubes along the octant that are empty, of sides 2, 4, ... 64: three planes of bits, 32 cells at a time.
uvec3 empty_cubes(int octant, int x, ivec2 row)
{
    uvec3 count = uvec3(0u);
    for (int level = 1; level < kWalkLevels; ++level) {
        // Towards lower coordinates the cube ends at the cell instead of beginning there.
        int back = (1 << level) - 1;
        ivec3 begin = ivec3(x, row) - back * (1 - (ivec3(octant) >> ivec3(0, 1, 2) & 1));
        uint empty = ~walk_bits_from(level, begin.x, begin.yz);
        uint carry = count.x & empty;
        count.x ^= empty;
        count.z ^= count.y & carry;
        count.y ^= carry;
    }
    return count;
}

void main()
{
    ivec3 size = walk_size();
    int words = (size.x + 31) / 32, i = int(item_index());
    if (i >= words * size.y * size.z) return;
    ivec3 first = ivec3(32 * (i % words), (i / words) % size.y, i / (words * size.y));
    uint full = walk_bits_from(0, first.x + kWalkPadding, first.yz + kWalkPadding);
    uvec3 leaps[8];
    for (int octant = 0; octant < 8; ++octant)
        leaps[octant] = empty_cubes(octant, first.x + kWalkPadding, first.yz + kWalkPadding);
    // snippet: leaps
    int last = min(32, size.x - first.x);
    for (int bit = 0; bit < last; ++bit) {
        uint code = 0u;
        for (int octant = 0; octant < 8; ++octant) {
            uvec3 count = leaps[octant] >> bit & 1u;
            code |= (count.x | count.y << 1 | count.z << 2) << (3 * octant);
        }
        if ((full >> bit & 1u) == 0u) store_walk(first + ivec3(bit, 0, 0), code);
    }
    // end snippet
    uint place = full != 0u ? atomicAdd(cell_count, uint(bitCount(full))) : 0u;
    for (uint rest = full; rest != 0u; rest &= rest - 1u)
        cells[place++] = uint(first.x + findLSB(rest)) | uint(first.y) << 10 | uint(first.z) << 20;
}
