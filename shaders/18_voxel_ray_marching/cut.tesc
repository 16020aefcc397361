#version 450 core
// Into how many pieces each triangle is cut.
#include "common/scene.glsl"
#include "common/voxel_grid.glsl"
#include "18_voxel_ray_marching/cut.glsl"

layout(vertices = 3) out;
in vec3 vertex_position[];
in vec4 vertex_uv[];
in vec4 vertex_color[];
flat in int vertex_instance[];
out vec3 corner_position[];
out vec4 corner_uv[];
out vec4 corner_color[];
patch out ivec4 patch_cut;    // x: k; yz: cells of a block; w: first column of blocks
uniform float piece_edge;     // voxels

void main()
{
    corner_position[gl_InvocationID] = vertex_position[gl_InvocationID];
    corner_uv[gl_InvocationID] = vertex_uv[gl_InvocationID];
    corner_color[gl_InvocationID] = vertex_color[gl_InvocationID];
    if (gl_InvocationID != 0) return;
    vec3 a = vertex_position[1] - vertex_position[0], b = vertex_position[2] - vertex_position[1],
         c = vertex_position[0] - vertex_position[2];
    float longest = sqrt(max(dot(a, a), max(dot(b, b), dot(c, c)))) / grid.origin.w;
    Cut cut = cut_of(longest, piece_edge, (drawn_material.flags & kMaterialDoubleSided) != 0 ? 2 : 1);
    int first = kMostPoints * vertex_instance[0];
    ivec2 points = ivec2((cut.k + cut.block.x - 1) / cut.block.x - first, (cut.k + cut.block.y - 1) / cut.block.y);
    patch_cut = ivec4(cut.k, cut.block, first);
    // n points along a side are a level of n - 1; a level has two at least, of which the second is then left out.
    // Levels of 0 drop the triangle.
    vec2 level = points.x > 0 ? vec2(clamp(points - 1, 1, kMostPoints - 1)) : vec2(0.0);
    gl_TessLevelOuter[0] = level.y;
    gl_TessLevelOuter[1] = level.x;
    gl_TessLevelOuter[2] = level.y;
    gl_TessLevelOuter[3] = level.x;
    gl_TessLevelInner[0] = level.x;
    gl_TessLevelInner[1] = level.y;
}
