// Blocks of 4x4x4 voxels, from which the list of occupied voxels is made. Included after common/voxel_grid.glsl.
const int kBlockSide = 4, kBlockVoxels = 64;

struct Block {
    uint voxels, faces;  // how many are occupied; after step 2: where the block's part of the lists begins
    uint occupied[2];    // bit i: voxel i of the block
};

ivec3 grid_in_blocks() { return (grid.size.xyz + kBlockSide - 1) / kBlockSide; }

uint block_count()
{
    uvec3 n = uvec3(grid_in_blocks());
    return n.x * n.y * n.z;
}

ivec3 block_corner(uint block)
{
    uvec3 n = uvec3(grid_in_blocks());
    return kBlockSide * ivec3(block % n.x, (block / n.x) % n.y, block / (n.x * n.y));
}

ivec3 voxel_of(uint block, int i) { return block_corner(block) + ivec3(i & 3, (i >> 2) & 3, i >> 4); }
