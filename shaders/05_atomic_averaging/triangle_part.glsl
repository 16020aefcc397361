// The part of a triangle inside a voxel: its exact area and centre of area, without building the polygon.
// Included after 04_conservative_voxelization/triangle_voxels.glsl.
//
// Seen along z the part is a polygon, and Green's theorem turns its area and first moments into sums over edges:
//     area = |sum of integrals of y dx|,  moments: integrals of x y dx and of y^2/2 dx
// Cutting by the sides x = 0, x = 1, y = 0, y = 1 is then a clamp of x and y along each edge; what runs along a side
// adds a constant times dx, or nothing. Only the cut by z = 0 and z = 1 needs points. No arrays, no loops, no order of
// corners. Lower sides belong to the voxel and upper ones do not, so a triangle that lies in the side between two
// voxels counts in one of them only.

struct TrianglePart {
    float area;   // voxel sides squared
    vec3 center;  // of area, 0..1 in the voxel, turned axes
};

// (area, moment of x, moment of y) between the edge p -> q, clamped to the unit square, and the x axis through `base`;
// moments relative to `base`, which lies near the part, so that little of a small one is lost to rounding.
// snippet: under_edge
vec3 under_edge(vec2 p, vec2 q, vec2 base)
{
    float dx = q.x - p.x;
    vec2 x = clamp(vec2(p.x, q.x), 0.0, 1.0);
    vec2 y = p.y + (q.y - p.y) * (dx != 0.0 ? clamp((x - p.x) / dx, 0.0, 1.0) : vec2(0.0));
    float dy = y.y - y.x;
    vec2 s = abs(dy) > 1e-20 ? clamp((vec2(0.0, 1.0) - y.x) / dy, 0.0, 1.0) : vec2(0.0, 1.0);
    float first = min(s.x, s.y), last = max(s.x, s.y);  // between them the edge is inside 0 <= y <= 1
    vec2 c = clamp(y, 0.0, 1.0) - base.y;
    x -= base.x;
    float width = x.y - x.x, xa = x.x + first * width, xb = x.x + last * width;
    vec3 w = width * vec3(first, last - first, 1.0 - last);
    return vec3(w.x * c.x + 0.5 * w.y * (c.x + c.y) + w.z * c.y,
                0.5 * (w.x * c.x * (x.x + xa) + w.z * c.y * (xb + x.y)) +
                    w.y / 6.0 * (xa * (2.0 * c.x + c.y) + xb * (c.x + 2.0 * c.y)),
                0.5 * (w.x * c.x * c.x + w.z * c.y * c.y) + w.y / 6.0 * (c.x * c.x + c.x * c.y + c.y * c.y));
}
// end snippet

// Where the boundary leaves and enters the slab 0 <= z < 1 through its lower and its upper side.
struct SlabCrossings {
    vec2 leave_low, enter_low, leave_high, enter_high;
};

vec3 under_slab_edge(vec3 p, vec3 q, vec2 base, inout SlabCrossings crossings)
{
    float dz = q.z - p.z;
    vec2 edge = q.xy - p.xy;
    bvec2 below = lessThan(vec2(p.z, q.z), vec2(0.0)), above = greaterThanEqual(vec2(p.z, q.z), vec2(1.0));
    vec2 s = abs(dz) > 1e-20      ? clamp((vec2(0.0, 1.0) - p.z) / dz, 0.0, 1.0)
             : below.x || above.x ? vec2(0.0)
                                  : vec2(0.0, 1.0);
    vec2 at_low = p.xy + s.x * edge, at_high = p.xy + s.y * edge;
    if (below.x && !below.y) crossings.enter_low = at_low;
    if (!below.x && below.y) crossings.leave_low = at_low;
    if (above.x && !above.y) crossings.enter_high = at_high;
    if (!above.x && above.y) crossings.leave_high = at_high;
    float first = min(s.x, s.y), last = max(s.x, s.y);
    return under_edge(p.xy + first * edge, last < 1.0 ? p.xy + last * edge : q.xy, base);
}

TrianglePart part_in_voxel(GridTriangle t, ivec3 voxel)
{
    vec3 a = t.v0 - vec3(voxel), b = t.v1 - vec3(voxel), c = t.v2 - vec3(voxel);
    vec3 low = min(a, min(b, c)), high = max(a, max(b, c));
    vec2 base = clamp(a.xy, 0.0, 1.0);
    SlabCrossings cut = SlabCrossings(vec2(0.0), vec2(0.0), vec2(0.0), vec2(0.0));
    vec3 sum = under_slab_edge(a, b, base, cut) + under_slab_edge(b, c, base, cut) + under_slab_edge(c, a, base, cut);
    sum += under_edge(cut.leave_low, cut.enter_low, base) + under_edge(cut.leave_high, cut.enter_high, base);

    float length_n = length(t.normal);
    bool inside = all(greaterThanEqual(low, vec3(0.0))) && all(lessThan(high, vec3(1.0)));
    TrianglePart part;
    // At most sqrt(3), since z is the normal's largest component; a thin triangle's normal may say anything.
    float stretch = min(length_n / max(abs(t.normal.z), 1e-30), 1.7320509);
    part.area = inside ? 0.5 * length_n : abs(sum.x) * stretch;
    vec2 center = base + (sum.x != 0.0 ? sum.yz / sum.x : vec2(0.0));
    part.center = vec3(center, a.z - dot(slope_of(t), center - a.xy));
    part.center = inside ? (a + b + c) / 3.0 : part.center;
    part.center = clamp(part.center, clamp(low, 0.0, 1.0), clamp(high, 0.0, 1.0));
    return part;
}
