// How a triangle is cut: into k^2 equal ones, cells of a k x k square of which the half beyond the diagonal is folded
// back. The tessellator makes a few points of a triangle; each is a block of cells for the geometry shader, and if
// these would be more than it may send out, further instances of the triangle take further columns of blocks.
const int kMostPoints = 16;    // along a side; stream_out.cpp has the same
const int kMostOutputs = 128;  // of a point: 8 components each of the 1024 that OpenGL 4.5 promises (table 23.60)

struct Cut {
    int k;       // pieces along an edge
    ivec2 block; // cells of a point
};

// snippet: cut
// Longest edge of a piece: at most `piece_edge` voxels. A point of a triangle is less than 2/3 of its longest edge from
// the centroid, so that at 0.75 every cell of a wall along the axes has a centroid within half a voxel of its middle.
Cut cut_of(float longest_edge_voxels, float piece_edge, int outputs_per_cell)
{
    Cut c;
    c.k = max(int(ceil(longest_edge_voxels / piece_edge)), 1);
    c.block.y = (c.k + kMostPoints - 1) / kMostPoints;
    c.block.x = max(min(c.block.y, kMostOutputs / outputs_per_cell / c.block.y), 1);
    return c;
}

// Corners of the cell in steps of 1/k along two edges, its middle: (i, j) with i + j < k stands upright, the others are
// folded back and stand on their tip. There are k^2 of both together.
vec2 cell_middle(ivec2 cell, int k)
{
    bool upright = cell.x + cell.y < k;
    vec2 middle = upright ? vec2(cell) + 1.0 / 3.0 : vec2(k - 1 - cell) + 2.0 / 3.0;
    return middle / float(k);
}
// end snippet
