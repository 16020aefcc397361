#version 450 core
// Voxelization without the rasterizer, step 1: one thread a triangle. A triangle of many columns would keep its
// neighbours waiting: it goes into a list, for step 2.
#include "04_conservative_voxelization/mark.glsl"
#include "04_conservative_voxelization/scene_triangles.glsl"
#include "04_conservative_voxelization/triangle_columns.glsl"
#include "common/item_index.glsl"

layout(std430, binding = kLargeTriangleBinding) writeonly buffer LargeTriangleBuffer { uint large_triangles[]; };
uniform uint first_triangle, triangle_count;

const int kFewColumns = 64;  // as many as a work group of step 2 has threads

void main()
{
    if (item_index() >= triangle_count) return;
    uint triangle = first_triangle + item_index();
    GridTriangle t = fetch_triangle(triangle);
    if (has_no_area(t)) {
        count_degenerate();
        return;
    }
    Columns columns = columns_of(t);
    if (columns.count > kFewColumns) {
        large_triangles[atomicAdd(voxel_statistics.large, 1u)] = triangle;
        return;
    }
    // snippet: small
    ivec2 column = columns.low;
    for (int i = 0; i < columns.count; ++i) {
        mark_column(t, triangle, column);
        column.x += 1;
        if (column.x == columns.low.x + columns.width) column = ivec2(columns.low.x, column.y + 1);
    }
    // end snippet
}
