// The columns of a triangle's box along its axis: those that it can overlap and a few more (Schwarz & Seidel 2010,
// section 4.2: columns with a depth range instead of the whole box).
struct Columns {
    ivec2 low;  // turned axes
    int width, count;
};

Columns columns_of(GridTriangle t)
{
    ivec2 plane = axis_to_z(grid.size.xyz, t.axis).xy;
    const float kMargin = 1e-3;  // candidates only
    ivec2 low = ivec2(floor(min(t.v0.xy, min(t.v1.xy, t.v2.xy)) - kMargin));
    ivec2 high = ivec2(floor(max(t.v0.xy, max(t.v1.xy, t.v2.xy)) + kMargin));
    low = clamp(low, ivec2(0), plane - 1);
    high = clamp(high, ivec2(0), plane - 1);
    ivec2 size = high - low + 1;
    return Columns(low, size.x, size.x * size.y);
}
