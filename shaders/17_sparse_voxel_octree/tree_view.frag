#version 450 core
// The nodes of a level, or the samples of their bricks, as the camera's ray meets them.
// SHOW 0: nodes, those with geometry as cubes, border nodes as wires; 1: samples as cubes round their places; 2:
// voxels of the leaves, of their faces the one that looks most towards the camera.
#include "common/camera_ray.glsl"
#include "17_sparse_voxel_octree/tree_light.glsl"
#if SHOW == 2
#include "17_sparse_voxel_octree/leaf_faces.glsl"
layout(std430, binding = kFaceBinding) readonly buffer FaceBuffer { VoxelFace faces[]; };
layout(std430, binding = kRadianceBinding) readonly buffer ShownBuffer { vec4 shown_of_faces[]; };
uniform bool with_emission;
#endif

uniform int level;
uniform uint geometry_end;      // nodes of the level from here on are empty
uniform int selected[27];       // nodes to highlight; the first is the one that was chosen, the others its neighbours
uniform int selected_count;
uniform bool only_selected;
uniform int direction;          // 0 .. 5, 6: the side that the ray comes in through
uniform int layer;              // 0 .. 2 of the bricks along the direction's axis, -1: all
uniform int quantity;           // 0: radiance, 1: coverage
layout(location = 0) out vec4 color;

const float kWire = 0.04;  // of a node's side

int selection_of(uint node)
{
    for (int i = 0; i < selected_count; ++i)
        if (selected[i] == int(node)) return i;
    return -1;
}

float towards_camera(vec3 normal, vec3 ray) { return 0.35 + 0.65 * abs(dot(normal, ray)); }

// The side of a box that a ray comes in through, seen from a point on it: an axis.
int side_axis(vec3 position, vec3 low, float side)
{
    vec3 q = abs(position - low - 0.5 * side);
    return q.x >= q.y && q.x >= q.z ? 0 : q.y >= q.z ? 1 : 2;
}

vec3 on_axis(int axis) { return vec3(equal(ivec3(axis), ivec3(0, 1, 2))); }

#if SHOW == 0
bool shows(TreeCell cell, vec3 position, vec3 ray, out vec3 shown)
{
    int axis = side_axis(position, cell.corner, cell.side), chosen = selection_of(cell.node);
    vec3 q = (position - cell.corner) / cell.side, to_edge = min(q, 1.0 - q);
    to_edge[axis] = 1.0;
    bool edge = min(to_edge.x, min(to_edge.y, to_edge.z)) < kWire, has_geometry = cell.node < geometry_end;
    shown = has_geometry ? vec3(0.6) : vec3(0.15, 0.5, 0.3);
    if (chosen >= 0) shown = chosen == 0 ? vec3(1.0, 0.25, 0.05) : vec3(0.1, 0.35, 1.0);
    if (edge) shown *= 0.4;
    shown *= towards_camera(on_axis(axis), ray);
    return edge || has_geometry || chosen >= 0;
}
#elif SHOW == 1
bool shows(TreeCell cell, vec3 position, vec3 ray, out vec3 shown)
{
    float spacing = 0.5 * cell.side;
    ivec3 k = clamp(ivec3(floor((position - cell.corner) / spacing + 0.5)), ivec3(0), ivec3(2));
    vec3 low = cell.corner + (vec3(k) - 0.5) * spacing;
    int axis = side_axis(position, low, spacing);
    int shown_direction = direction < 6 ? direction : 2 * axis + (ray[axis] < 0.0 ? 1 : 0);
    uint brick = brick_of(cell.node, shown_direction);
    if (brick == kNoBrick || layer >= 0 && k[shown_direction >> 1] != layer) return false;
    vec4 light = texelFetch(brick_pool, brick_corner(brick) + k, 0);
    if (light.a <= 1.0 / 512.0) return false;
    shown = quantity == 1 ? light.aaa : light_scale * light.rgb / light.a;
    return true;
}
#else
bool shows(TreeCell cell, vec3 position, vec3 ray, out vec3 shown)
{
    ivec3 voxel = ivec3(cell.corner) + ivec3(clamp(floor(position + 1e-3 * sign(ray) - cell.corner), 0.0, 1.0));
    uint entry = leaf_entry(cell.node, voxel);
    float best = -2.0;
    shown = vec3(0.0);
    for (uint i = entry >> 6; i < (entry >> 6) + uint(bitCount(face_mask(entry))); ++i) {
        float towards = -dot(faces[i].normal.xyz, ray);
        if (towards <= best) continue;
        best = towards;
        shown = shown_of_faces[i].rgb + (with_emission ? faces[i].emission.rgb : vec3(0.0));
    }
    return best > -2.0;
}
#endif

void main()
{
    Ray camera_way = camera_ray(gl_FragCoord.xy);
    TreeRay ray = tree_ray(grid_from_scene(camera_way.origin), camera_way.direction);
    vec3 enters = (step(ray.direction, vec3(0.0)) * float(1 << tree_depth) - ray.origin) * ray.inverse;
    float t = max(max(enters.x, max(enters.y, enters.z)), 0.0);
    color = vec4(0.0);
    // Both the cells of the tree and, in them, those of the voxels or round the samples, half a spacing aside.
    while (t < ray.exit) {
        vec3 position = ray.nudge + ray.direction * t;
        TreeCell cell = descend(position, level);
        float end = leaves_cell(ray, cell);
        if (cell.node != kNoNode) {
#if SHOW > 0
            const float kShift = SHOW == 1 ? 0.5 : 0.0;  // samples lie on corners, voxels between them
            TreeCell near = TreeCell(cell.node, level, vec3(0.0), 0.5 * cell.side);
            near.corner = (floor((position - cell.corner) / near.side + kShift) - kShift) * near.side + cell.corner;
            end = min(end, leaves_cell(ray, near));
#endif
            vec3 shown;
            bool wanted = !only_selected || selection_of(cell.node) >= 0;
            if (wanted && shows(cell, ray.origin + ray.direction * t, ray.direction, shown)) {
                color = vec4(shown, 1.0);
                return;
            }
        }
        t = max(end, t + 1e-3);
    }
}
