// Light and coverage at any point of the octree: a node, and a trilinear look-up within its brick.
#include "common/voxel_grid.glsl"
#include "17_sparse_voxel_octree/bricks.glsl"

layout(binding = kBrickPoolUnit) uniform sampler3D brick_pool;
layout(std140, binding = kPyramidBlock) uniform PyramidBlock { float light_scale; };  // W/(sr m^2)

#ifndef COUNT_SAMPLE  // those who want to know which nodes are sampled
#define COUNT_SAMPLE(node)
#endif

// What the tree has at a point, no deeper than a level: a node of that level, or the first child that is missing.
struct TreeCell {
    uint node;    // kNoNode: the cell is exactly empty
    int level;
    vec3 corner;  // voxels
    float side;   // voxels
};

// snippet: descend
TreeCell descend(vec3 position, int level)
{
    ivec3 voxel = clamp(ivec3(floor(position)), ivec3(0), ivec3((1 << tree_depth) - 1));
    TreeCell cell = TreeCell(0u, 0, vec3(0.0), 0.0);
    while (cell.level < level && cell.node != kNoNode) {
        uint child = nodes[8u * cell.node + child_slot(voxel, cell.level)];
        cell.node = child == 0u ? kNoNode : child;
        ++cell.level;
    }
    int shift = tree_depth - cell.level;
    cell.corner = vec3(voxel >> shift << shift);
    cell.side = float(1 << shift);
    return cell;
}
// end snippet

// The child of a cell that holds a position.
TreeCell child_cell(TreeCell cell, vec3 position)
{
    float side = 0.5 * cell.side;
    vec3 upper = step(cell.corner + side, position);
    uint child = nodes[8u * cell.node + uint(dot(upper, vec3(1.0, 2.0, 4.0)))];
    return TreeCell(child == 0u ? kNoNode : child, cell.level + 1, cell.corner + side * upper, side);
}

// snippet: sample_brick
vec4 sample_brick(TreeCell cell, int direction, vec3 position)
{
    uint brick = brick_of(cell.node, direction);
    if (brick == kNoBrick) return vec4(0.0);
    // The brick's outermost samples are the node's corners: uvw = (corner + 1/2 + 2 p) / pool.
    vec3 p = clamp((position - cell.corner) / cell.side, 0.0, 1.0);
    return textureLod(brick_pool, (vec3(brick_corner(brick)) + 0.5 + 2.0 * p) / vec3(textureSize(brick_pool, 0)), 0.0);
}
// end snippet

// Samples are half a node apart. A level's light, per voxel of way: what looks against the ray, one direction an axis.
struct AgainstRay {
    vec4 x, y, z;
};
ivec3 faces_against(vec3 direction) { return ivec3(0, 2, 4) + ivec3(lessThan(direction, vec3(0.0))); }

AgainstRay light_against(TreeCell cell, vec3 position, ivec3 faces)
{
    COUNT_SAMPLE(cell.node)
    return AgainstRay(sample_brick(cell, faces.x, position), sample_brick(cell, faces.y, position),
                      sample_brick(cell, faces.z, position));
}

// By the projected areas |d_a|, per voxel of way.
vec4 met_by_ray(AgainstRay light, vec3 direction, float spacing)
{
    vec3 weight = abs(direction) / spacing;
    return weight.x * light.x + weight.y * light.y + weight.z * light.z;
}

// What does not change along a ray.
struct TreeRay {
    vec3 origin, direction, inverse, nudge;
    ivec3 faces;  // that look against it
    float exit;   // where it leaves the root
};

TreeRay tree_ray(vec3 origin, vec3 direction)
{
    TreeRay ray;
    ray.origin = origin;
    ray.direction = mix(direction, vec3(1e-6), lessThan(abs(direction), vec3(1e-6)));
    ray.inverse = 1.0 / ray.direction;
    ray.nudge = origin + 1e-3 * sign(ray.direction);  // into the cell that the ray enters
    ray.faces = faces_against(ray.direction);
    vec3 ends = (step(0.0, ray.direction) * float(1 << tree_depth) - origin) * ray.inverse;
    ray.exit = max(min(ends.x, min(ends.y, ends.z)), 0.0);
    return ray;
}

float leaves_cell(TreeRay ray, TreeCell cell)
{
    vec3 ends = (cell.corner + step(0.0, ray.direction) * cell.side - ray.origin) * ray.inverse;
    return min(ends.x, min(ends.y, ends.z));
}
