// Compute shader of a voxelization: a work group takes one triangle, its threads take the columns of the triangle's box
// along its axis (Schwarz & Seidel 2010, section 4.2: columns with a depth range instead of the whole box).
// The includer defines void visit(GridTriangle t, ivec3 voxel_t) and void prepare(uint triangle), called before.
layout(local_size_x = 32) in;

void main()
{
    uint triangle = gl_WorkGroupID.x;
    GridTriangle t = grid_triangle(triangle);
    prepare(triangle);
    ivec2 plane = axis_to_z(grid.size.xyz, t.axis).xy;
    const float kMargin = 1e-3;  // candidates only
    ivec2 low = ivec2(floor(min(t.v0.xy, min(t.v1.xy, t.v2.xy)) - kMargin));
    ivec2 high = ivec2(floor(max(t.v0.xy, max(t.v1.xy, t.v2.xy)) + kMargin));
    low = clamp(low, ivec2(0), plane - 1);
    high = clamp(high, ivec2(0), plane - 1);
    int width = high.x - low.x + 1;
    int columns = has_no_area(t) ? 0 : width * (high.y - low.y + 1);
    if (has_no_area(t) && gl_LocalInvocationIndex == 0u) count_degenerate();
    for (int i = int(gl_LocalInvocationIndex); i < columns; i += 32) {
        ivec2 column = low + ivec2(i % width, i / width);
        ivec2 range = column_range(t, column);
        for (int z = range.x; z <= range.y; ++z)
            if (overlaps(t, ivec3(column, z))) visit(t, ivec3(column, z));
    }
}
