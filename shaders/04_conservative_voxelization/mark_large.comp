#version 450 core
// Voxelization without the rasterizer, step 2: the columns of a large triangle are shared by the threads of one or more
// work groups.
#include "04_conservative_voxelization/mark.glsl"
#include "04_conservative_voxelization/scene_triangles.glsl"
#include "04_conservative_voxelization/triangle_columns.glsl"
#include "common/item_index.glsl"

layout(std430, binding = kLargeTriangleBinding) readonly buffer LargeTriangleBuffer { uint large_triangles[]; };
uniform int groups_of_triangle;

void main()
{
    uint place = group_index() / uint(groups_of_triangle);
    if (place >= voxel_statistics.large) return;
    uint triangle = large_triangles[place];
    GridTriangle t = fetch_triangle(triangle);
    Columns columns = columns_of(t);
    int first = int(group_index()) % groups_of_triangle * 64 + int(gl_LocalInvocationIndex);
    for (int i = first; i < columns.count; i += 64 * groups_of_triangle)
        mark_column(t, triangle, columns.low + ivec2(i % columns.width, i / columns.width));
}
