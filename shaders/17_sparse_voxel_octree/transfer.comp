#version 450 core
// Border transfer along one axis: a brick and its neighbour above each hold a part of the 9 samples that they share.
// The whole is the sum, and both get it. One thread a brick. AVERAGE 1: the mean, as published, which is wrong.
#include "17_sparse_voxel_octree/brick_data.glsl"

uniform int axis;
uniform bool is_leaf;

void main()
{
    if (item_index() >= brick_count) return;
    uint brick = first_brick + item_index(), node = brick_list[brick] >> 3;
    int direction = int(brick_list[brick] & 7u);
    // Along the direction the filter has read the neighbours itself, and both have the same already.
    if (!is_leaf && axis == direction >> 1) return;
    // snippet: transfer
    ivec3 along = ivec3(equal(ivec3(axis), ivec3(0, 1, 2)));
    uint above = find_node(unpack_place(node_places[node]) + along, level);
    if (above == kNoNode) return;
    uint other = brick_of(above, direction);
    if (other == kNoBrick) return;
    ivec3 upper = brick_corner(brick) + 2 * along, lower = brick_corner(other);
    for (int i = 0; i < 9; ++i) {
        ivec3 k = ivec3(0);
        k[(axis + 1) % 3] = i % 3;
        k[(axis + 2) % 3] = i / 3;
        vec4 sum = imageLoad(pool, upper + k) + imageLoad(pool, lower + k);
#if AVERAGE
        sum *= 0.5;
#endif
        imageStore(pool, upper + k, stored(sum));
        imageStore(pool, lower + k, stored(sum));
    }
    // end snippet
}
