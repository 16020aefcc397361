#version 450 core
// A fragment is one column of the grid along the triangle's axis.
#include "04_conservative_voxelization/mark.glsl"

flat in GridTriangle triangle;  // from the geometry shader: reading vertices in every fragment costs far more
flat in uint triangle_index;

void main()
{
    if (has_no_area(triangle)) {  // of such a triangle the geometry shader sends one fragment, to be counted
        count_degenerate();
        return;
    }
    ivec2 column = ivec2(gl_FragCoord.xy);
    // Turned axes of a grid that is no cube: the square viewport is larger than the column plane.
    ivec3 size = axis_to_z(grid.size.xyz, triangle.axis);
    if (any(greaterThanEqual(column, size.xy))) return;
#if CONSERVATIVE
    mark_column(triangle, triangle_index, column);
#else
    // Broken on purpose: one voxel a fragment, where the plane is in the middle of the column.
    int z = int(floor(triangle.v0.z - dot(slope_of(triangle), vec2(column) + 0.5 - triangle.v0.xy)));
    if (z >= 0 && z < size.z) mark(triangle, triangle_index, ivec3(column, z));
#endif
}
