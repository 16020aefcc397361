// One bit a cell of the walk volume: is anything in the cube of 2^level cells that begins at the cell and goes up from
// it? Rows of words along x. The rows begin kWalkPadding cells below the volume, where all is empty: a cube that begins
// there may reach into it. Included after common/voxel_grid.glsl.
const int kWalkPadding = 64;  // the side of the largest cube, and a multiple of 32
const int kWalkLevels = 7;    // cubes of 1, 2, 4, ... 64 cells

layout(std430, binding = kWalkBitBinding) buffer WalkBits { uint walk_bits[]; };

// Cells are centred on the corners of voxels: there is one more of them along each axis.
ivec3 walk_size() { return grid.size.xyz + 1; }
ivec3 walk_row_counts() { return ivec3((walk_size().x + kWalkPadding + 31) / 32, walk_size().yz + kWalkPadding); }

// Word `word` of the row (y, z), all counted from the padding's corner; 0 outside.
uint walk_word(int level, int word, ivec2 row)
{
    ivec3 counts = walk_row_counts(), at = ivec3(word, row);
    if (any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, counts))) return 0u;
    return walk_bits[((level * counts.z + at.z) * counts.y + at.y) * counts.x + at.x];
}

// 32 bits that begin at cell x (from the padding's corner), which need not be where a word begins.
uint walk_bits_from(int level, int x, ivec2 row)
{
    int word = x >> 5, shift = x & 31;
    uint low = walk_word(level, word, row) >> shift;
    return shift == 0 ? low : low | walk_word(level, word + 1, row) << (32 - shift);
}
