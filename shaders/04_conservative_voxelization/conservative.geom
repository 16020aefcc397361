#version 450 core
// Draw, for each triangle, every pixel of its column plane that the triangle touches, however little.
// Moving the edges out by the reach of half a pixel: Hasselgren et al. 2005, GPU Gems 2, chapter 42, second algorithm.
#include "04_conservative_voxelization/triangle_voxels.glsl"

layout(triangles) in;
layout(triangle_strip, max_vertices = 4) out;
in vec3 vertex_position[];  // scene space, m
flat out GridTriangle triangle;
flat out uint triangle_index;
uniform uint first_triangle;

const float kReach = 0.5 + 0.01;  // half a pixel, and a little for the rasterizer's rounding of coordinates

void emit_at(vec2 p, GridTriangle t)
{
    triangle = t;
    triangle_index = first_triangle + uint(gl_PrimitiveIDIn);
    gl_Position = vec4(2.0 * p / largest(vec3(grid.size.xyz)) - 1.0, 0.0, 1.0);
    EmitVertex();
}

// Edge a->b of a counter-clockwise triangle as (outward normal, distance), moved out by the pixel's reach.
vec3 moved_edge(vec2 a, vec2 b)
{
    vec2 n = vec2(b.y - a.y, a.x - b.x);
    return vec3(n, dot(n, a) + kReach * (abs(n.x) + abs(n.y)));
}

vec2 crossing(vec3 e, vec3 f)
{
    float d = e.x * f.y - e.y * f.x;
    return vec2(e.z * f.y - e.y * f.z, e.x * f.z - e.z * f.x) / d;
}

float area_of(vec2 a, vec2 b, vec2 c) { return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)); }

void main()
{
    GridTriangle t = grid_triangle(vertex_position[0], vertex_position[1], vertex_position[2]);
    if (has_no_area(t)) {  // one pixel's centre, whose fragment counts it
        emit_at(vec2(0.0, 0.0), t);
        emit_at(vec2(1.5, 0.0), t);
        emit_at(vec2(0.0, 1.5), t);
        EndPrimitive();
        return;
    }
    vec2 a = t.v0.xy, b = t.v1.xy, c = t.v2.xy;
#if CONSERVATIVE
    if (area_of(a, b, c) < 0.0) {
        b = t.v2.xy;
        c = t.v1.xy;
    }
    vec2 low = min(a, min(b, c)) - kReach, high = max(a, max(b, c)) + kReach;

    // Cover it by the moved triangle or by its box, whichever is smaller: the moved corners of a sliver run far away,
    // where the rasterizer's coordinates are coarse.
    // snippet: expand
    vec3 ab = moved_edge(a, b), bc = moved_edge(b, c), ca = moved_edge(c, a);
    vec2 p = crossing(ca, ab), q = crossing(ab, bc), r = crossing(bc, ca);
    float triangle_area = area_of(p, q, r), box_area = (high.x - low.x) * (high.y - low.y);
    vec2 span = max(p, max(q, r)) - min(p, min(q, r));
    bool near = all(lessThan(span, 2.0 * (high - low) + 4.0));  // false for NaN, too
    if (t.thin == 0 && near && triangle_area > 0.0 && triangle_area < box_area) {
        emit_at(p, t);
        emit_at(q, t);
        emit_at(r, t);
    } else {
        emit_at(low, t);
        emit_at(vec2(high.x, low.y), t);
        emit_at(vec2(low.x, high.y), t);
        emit_at(high, t);
    }
    // end snippet
#else
    emit_at(a, t);
    emit_at(b, t);
    emit_at(c, t);
#endif
    EndPrimitive();
}
