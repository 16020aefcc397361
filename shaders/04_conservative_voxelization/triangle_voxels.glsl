// Which voxels of one grid column a triangle overlaps.
#include "common/voxel_grid.glsl"

// A triangle in grid space, its axes turned so that z is the axis along which it is projected.
struct GridTriangle {
    vec3 v0, v1, v2;
    vec3 normal;      // cross product of two edges, not normalized
    float tolerance;  // voxel sides; see overlaps()
    int axis;         // the grid axis that became z
    int thin;         // 1: so thin that the direction of `normal` cannot be trusted
};

// Cyclic, so that the winding stays.
vec3 axis_to_z(vec3 p, int axis) { return axis == 0 ? p.yzx : axis == 1 ? p.zxy : p; }
vec3 axis_from_z(vec3 p, int axis) { return axis == 0 ? p.zxy : axis == 1 ? p.yzx : p; }
ivec3 axis_to_z(ivec3 p, int axis) { return axis == 0 ? p.yzx : axis == 1 ? p.zxy : p; }
ivec3 axis_from_z(ivec3 p, int axis) { return axis == 0 ? p.zxy : axis == 1 ? p.yzx : p; }

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

// Choose the axis along which the triangle looks largest. Of equal components either will do, but one that is smaller
// than another must never win: seen edge-on the triangle has no pixels and vanishes.
// A sliver's cross product is mostly rounding error, so there the shortest side of its box decides.
// p0, p1, p2: scene space, m.
GridTriangle grid_triangle(vec3 p0, vec3 p1, vec3 p2)
{
    // Edges from scene space: there the vertices are exact, in grid space they have been rounded.
    vec3 e0 = (p1 - p0) / grid.origin.w, e1 = (p2 - p1) / grid.origin.w, e2 = (p0 - p2) / grid.origin.w;
    GridTriangle t;
    t.v0 = grid_from_scene(p0);
    t.v1 = grid_from_scene(p1);
    t.v2 = grid_from_scene(p2);
    // snippet: dominant_axis
    vec3 n = cross(e0, -e2);
    float longest2 = max(dot(e0, e0), max(dot(e1, e1), dot(e2, e2)));
    // Rounding of the cross product: about 2^-23 * longest^2; it must stay under 1 % of the result.
    t.thin = dot(n, n) < 1.5e-10 * longest2 * longest2 ? 1 : 0;
    vec3 extent = max(abs(e0), max(abs(e1), abs(e2)));
    vec3 a = t.thin != 0 ? -extent : abs(n);
    t.axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    // end snippet
    // Six roundings, each up to 2^-24 of the largest coordinate: two in grid_from_scene(), one where a voxel's centre
    // is subtracted, three in a dot product (Higham 2002, section 3.1). 6 * 2^-24 = 3.6e-7.
    t.tolerance = 4e-7 * max(1.0, largest(max(abs(t.v0), max(abs(t.v1), abs(t.v2)))));
    t.v0 = axis_to_z(t.v0, t.axis);
    t.v1 = axis_to_z(t.v1, t.axis);
    t.v2 = axis_to_z(t.v2, t.axis);
    t.normal = axis_to_z(n, t.axis);
    return t;
}

bool has_no_area(GridTriangle t) { return t.normal == vec3(0.0); }

// Slope of the plane: z = z0 - dot(slope, xy - xy0). At most 1, since the normal's z is its largest component; a thin
// triangle has whatever its rounding errors say, and column_range() is right with any slope.
vec2 slope_of(GridTriangle t)
{
    return t.normal.z == 0.0 ? vec2(0.0) : clamp(t.normal.xy / t.normal.z, -1.0, 1.0);
}

// The voxels first..last along z that the triangle can cross inside the column [x, x+1] x [y, y+1]: one to three
// (Crassin & Green 2012, 22.4.2 asks for all of them). All three vertices bound the distance from the plane, so that a
// badly rounded normal makes the range longer and never loses a voxel.
// snippet: column_range
ivec2 column_range(GridTriangle t, ivec2 column)
{
    vec2 slope = slope_of(t), center = vec2(column) + 0.5;
    vec3 height = vec3(t.v0.z + dot(slope, t.v0.xy - center), t.v1.z + dot(slope, t.v1.xy - center),
                       t.v2.z + dot(slope, t.v2.xy - center));
    float reach = 0.5 * (abs(slope.x) + abs(slope.y));
    float low = max(min(t.v0.z, min(t.v1.z, t.v2.z)), min(height.x, min(height.y, height.z)) - reach);
    float high = min(max(t.v0.z, max(t.v1.z, t.v2.z)), max(height.x, max(height.y, height.z)) + reach);
    const float kMargin = 1e-3;  // only makes candidates; the exact test decides
    int depth = axis_to_z(grid.size.xyz, t.axis).z;
    return clamp(ivec2(floor(vec2(low - kMargin, high + kMargin))), ivec2(0, 0), ivec2(depth - 1));
}
// end snippet

// Separating axis test of a closed voxel and the triangle (Akenine-Moller 2001; the same predicates as Schwarz &
// Seidel 2010, section 4). Everything is relative to the voxel's centre, so that large coordinates cancel first.
// The voxel is grown by the triangle's tolerance, which makes up for rounding: a voxel may be reported that the
// triangle misses by twice as much, none is lost.
// snippet: separated_by
bool separated_by(vec3 axis, vec3 a, vec3 b, vec3 c, float half_side)
{
    float pa = dot(axis, a), pb = dot(axis, b), pc = dot(axis, c);
    float reach = half_side * (abs(axis.x) + abs(axis.y) + abs(axis.z));
    return min(pa, min(pb, pc)) > reach || max(pa, max(pb, pc)) < -reach;
}
// end snippet

// snippet: overlap
bool overlaps(GridTriangle t, ivec3 voxel)
{
    vec3 center = vec3(voxel) + 0.5;
    vec3 a = t.v0 - center, b = t.v1 - center, c = t.v2 - center, e0 = b - a, e1 = c - b, e2 = a - c;
    float h = 0.5 + t.tolerance;
    bool apart = any(greaterThan(min(a, min(b, c)), vec3(h))) || any(lessThan(max(a, max(b, c)), vec3(-h))) ||
                 separated_by(t.normal, a, b, c, h) ||
                 separated_by(vec3(0.0, -e0.z, e0.y), a, b, c, h) || separated_by(vec3(0.0, -e1.z, e1.y), a, b, c, h) ||
                 separated_by(vec3(0.0, -e2.z, e2.y), a, b, c, h) || separated_by(vec3(e0.z, 0.0, -e0.x), a, b, c, h) ||
                 separated_by(vec3(e1.z, 0.0, -e1.x), a, b, c, h) || separated_by(vec3(e2.z, 0.0, -e2.x), a, b, c, h) ||
                 separated_by(vec3(-e0.y, e0.x, 0.0), a, b, c, h) || separated_by(vec3(-e1.y, e1.x, 0.0), a, b, c, h) ||
                 separated_by(vec3(-e2.y, e2.x, 0.0), a, b, c, h);
    return !apart;
}
// end snippet

// The face that the triangle's front belongs to; its back belongs to face ^ 1.
int front_face(GridTriangle t) { return 2 * t.axis + (t.normal.z > 0.0 ? 1 : 0); }
