#version 450 core
// A level's bricks from those of the level below. Samples are twice as far apart now. Across the direction a new one is
// the mean (1/4, 1/2, 1/4) of three old ones, of which a node has (1/4, 1/4), (1/4, 1/2, 1/4) and (1/4, 1/4): the
// border transfer adds the rest. Along the direction (1/2, 1, 1/2): surfaces behind each other cover together, the
// front one first and each no more than what is still open, as in chapter 07; here neighbours are read, for what is
// in front decides what is left for those behind. One thread a brick.
#include "17_sparse_voxel_octree/brick_data.glsl"

int direction = 0, axis = 0, across_b = 0, across_c = 0;
// Of the node's own children; of the neighbours' children that touch the node, along the direction.
uint child_brick[8] = uint[](kNoBrick, kNoBrick, kNoBrick, kNoBrick, kNoBrick, kNoBrick, kNoBrick, kNoBrick);
uint low_brick[4] = uint[](kNoBrick, kNoBrick, kNoBrick, kNoBrick);
uint high_brick[4] = uint[](kNoBrick, kNoBrick, kNoBrick, kNoBrick);

uint brick_of_child(uint node, ivec3 child)
{
    if (node == kNoNode) return kNoBrick;
    uint found = nodes[8u * node + uint(child.x + 2 * child.y + 4 * child.z)];
    return found == 0u ? kNoBrick : brick_of(found, direction);
}

ivec3 from_axes(int along, int b, int c)
{
    ivec3 v = ivec3(0);
    v[axis] = along;
    v[across_b] = b;
    v[across_c] = c;
    return v;
}

// Old sample of the node, each index 0 .. 4; along the direction also -1 and 5, in the neighbours.
vec4 old_sample(int along, int b, int c)
{
    int half_b = min(b >> 1, 1), half_c = min(c >> 1, 1), half_a = clamp(along >> 1, 0, 1), side = half_b + 2 * half_c;
    uint brick = along < 0 ? low_brick[side] : along > 4 ? high_brick[side] : child_brick[half_a + 2 * side];
    int within = along < 0 || along > 4 ? 1 : along - 2 * half_a;
    if (brick == kNoBrick) return vec4(0.0);
    return imageLoad(pool, brick_corner(brick) + from_axes(within, b - 2 * half_b, c - 2 * half_c));
}

vec4 cut(vec4 light, float open) { return light.a > open ? light * (max(open, 0.0) / light.a) : light; }

// Weight of old sample i (0 .. 4) in new sample k (0 .. 2), of this node's part; at the root's sides there is no other.
float kernel(int k, int i, bool is_low, bool is_high)
{
    int distance = abs(i - 2 * k);
    if (distance > 1) return 0.0;
    if (distance == 1) return 0.25;
    return k == 1 || k == 0 && is_low || k == 2 && is_high ? 0.5 : 0.25;
}

void main()
{
    if (item_index() >= brick_count) return;
    uint brick = first_brick + item_index(), node = brick_list[brick] >> 3;
    direction = int(brick_list[brick] & 7u);
    axis = direction >> 1;
    across_b = (axis + 1) % 3;
    across_c = (axis + 2) % 3;
    ivec3 place = unpack_place(node_places[node]), texel = brick_corner(brick);
    int spacing = tree_depth - 1 - level, last = (1 << level) - 1;  // samples are 2^spacing voxels apart
    uint low = find_node(place - from_axes(1, 0, 0), level), high = find_node(place + from_axes(1, 0, 0), level);
    for (int i = 0; i < 8; ++i) child_brick[i] = brick_of_child(node, from_axes(i & 1, i >> 1 & 1, i >> 2));
    for (int i = 0; i < 4; ++i) {
        low_brick[i] = brick_of_child(low, from_axes(1, i & 1, i >> 1));
        high_brick[i] = brick_of_child(high, from_axes(0, i & 1, i >> 1));
    }
    int to_front = (direction & 1) == 1 ? 1 : -1;  // the side that the direction looks to
    for (int along = 0; along < 3; ++along) {
        vec4 columns[25];
        // snippet: columns
        for (int i = 0; i < 25; ++i) {
            int b = i % 5, c = i / 5;
            vec4 sum = 0.5 * old_sample(2 * along + to_front, b, c);
            sum += cut(old_sample(2 * along, b, c), 1.0 - sum.a);
            sum += cut(0.5 * old_sample(2 * along - to_front, b, c), 1.0 - sum.a);
            // Across the direction a column counts by what of it lies within the bounds.
            columns[i] = sum * weight_of(spacing - 1, across_b, 4 * place[across_b] + b) *
                         weight_of(spacing - 1, across_c, 4 * place[across_c] + c);
        }
        // end snippet
        for (int i = 0; i < 9; ++i) {
            int kb = i % 3, kc = i / 3;
            vec4 sum = vec4(0.0);
            for (int b = max(2 * kb - 1, 0); b <= min(2 * kb + 1, 4); ++b)
                for (int c = max(2 * kc - 1, 0); c <= min(2 * kc + 1, 4); ++c)
                    sum += kernel(kb, b, place[across_b] == 0, place[across_b] == last) *
                           kernel(kc, c, place[across_c] == 0, place[across_c] == last) * columns[b + 5 * c];
            float within = weight_of(spacing, across_b, 2 * place[across_b] + kb) *
                           weight_of(spacing, across_c, 2 * place[across_c] + kc);
            imageStore(pool, texel + from_axes(along, kb, kc), stored(within > 0.0 ? sum / within : vec4(0.0)));
        }
    }
}
