// Fragment shader of a voxelization: the fragment is one column of the grid along the triangle's axis.
// The includer defines void visit(GridTriangle t, ivec3 voxel_t); voxel_t in the triangle's turned axes.
flat in GridTriangle triangle;  // from the geometry shader: reading vertices in every fragment costs far more

void main()
{
    GridTriangle t = triangle;
    ivec2 column = ivec2(gl_FragCoord.xy);
    // Turned axes of a grid that is no cube: the square viewport is larger than the column plane.
    ivec3 size = axis_to_z(grid.size.xyz, t.axis);
    bool in_grid = all(lessThan(column, size.xy));
#if CONSERVATIVE
    // snippet: column
    ivec2 range = column_range(t, column);
    int last = in_grid ? range.y : range.x - 1;
    for (int z = range.x; z <= last; ++z)
        if (overlaps(t, ivec3(column, z))) visit(t, ivec3(column, z));
    // end snippet
#else
    // Broken on purpose: one voxel a fragment, where the plane is in the middle of the column.
    int z = int(floor(t.v0.z - dot(slope_of(t), vec2(column) + 0.5 - t.v0.xy)));
    if (in_grid && z >= 0 && z < size.z) visit(t, ivec3(column, z));
#endif
}
