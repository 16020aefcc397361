"""Drawings of docs/04_conservative_voxelization.md."""
import math

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def _grid(d, x0, y0, x1, y1, color=GREY):
    for x in range(x0, x1 + 1):
        d.line((x, y0), (x, y1), color, 0.7)
    for y in range(y0, y1 + 1):
        d.line((x0, y), (x1, y), color, 0.7)


def column():
    """Side view of voxels; the rasterizer looks down and finds columns, the plane says which voxels of one."""
    d = Drawing("A triangle seen from the side: in a column that the rasterizer found, its plane tells the range of depth",
                -2.4, -0.4, 10.2, 6.6)
    a, b = (0.4, 0.35), (5.6, 5.3)
    slope = (b[1] - a[1]) / (b[0] - a[0])
    low, high = a[1] + slope * (3 - a[0]), a[1] + slope * (4 - a[0])
    for z in range(math.floor(low), math.floor(high) + 1):
        d.box((3, z), (4, z + 1), GREY, PALE[BLUE])
    _grid(d, 0, 0, 6, 6)
    d.box((3, 0), (4, 6), BLUE, width=2)
    d.line(a, b, INK, 2.5)
    d.dot((3, low), ORANGE)
    d.dot((4, high), ORANGE)
    for z, name in ((low, "low"), (high, "high")):
        d.line((3 if name == "low" else 4, z), (6.4, z), ORANGE, 1.2, "5 4")
        d.label((6.5, z), name, ORANGE, "start")
    d.arrow((7.4, low), (7.4, high), ORANGE, both=True)
    d.label((7.55, (low + high) / 2), "range of depth", ORANGE, "start")
    d.label((4.15, math.floor(low) + 0.4), "candidates", BLUE, "start")
    d.label((3.5, 6.1), "one fragment: a column", BLUE, place="above")
    d.label((1.55, 2.3), "triangle", INK, "end")
    d.arrow((-0.9, 5.6), (-0.9, 3.2), GREY)
    d.label((-1.05, 5.0), "looks\nalong z", GREY, "end")
    return d


def separating_axis():
    """A voxel and a triangle whose projections onto one axis do not touch."""
    d = Drawing("On the axis a the triangle lies beyond the reach r(a) of the voxel: the two are apart", -2.6, -4.4, 5.6, 3.0)
    axis = (math.cos(math.radians(35)), math.sin(math.radians(35)))
    half = 1.0
    d.box((-half, -half), (half, half), BLUE, PALE[BLUE], 2)
    d.dot((0, 0), BLUE)
    d.label((0, 0.1), "voxel", BLUE, place="above")
    points = [(2.5, 0.1), (1.35, 2.6), (3.6, 2.1)]
    d.polygon(points, ORANGE, PALE[ORANGE], 2)
    d.label((2.45, 1.6), "triangle", ORANGE)
    foot = (1.2, -2.6)  # the axis is drawn beside the two, for room

    def on_axis(p):
        t = (p[0] - foot[0]) * axis[0] + (p[1] - foot[1]) * axis[1]
        return foot[0] + t * axis[0], foot[1] + t * axis[1]

    tip = (foot[0] + 4.9 * axis[0], foot[1] + 4.9 * axis[1])
    d.arrow((foot[0] - 4.2 * axis[0], foot[1] - 4.2 * axis[1]), tip, INK)
    d.label((tip[0] + 0.1, tip[1] - 0.4), "a", INK, bold=True)
    corner, first = (half, half), min(points, key=lambda p: p[0] * axis[0] + p[1] * axis[1])
    for p, color in ((corner, BLUE), ((-half, -half), BLUE), ((0, 0), BLUE), (first, ORANGE)):
        d.line(p, on_axis(p), color, 1, "5 4")
        d.dot(on_axis(p), color)
    last = max(points, key=lambda p: p[0] * axis[0] + p[1] * axis[1])
    d.line(last, on_axis(last), ORANGE, 1, "5 4")
    d.dot(on_axis(last), ORANGE)
    d.line(on_axis((-half, -half)), on_axis(corner), BLUE, 4)
    d.line(on_axis(first), on_axis(last), ORANGE, 4)
    middle = [(a + b) / 2 for a, b in zip(on_axis((0, 0)), on_axis(corner))]
    d.label((middle[0] + 0.25, middle[1] - 0.3), "r(a)", BLUE)
    gap = [(a + b) / 2 for a, b in zip(on_axis(first), on_axis(corner))]
    d.label((gap[0] + 0.2, gap[1] - 0.35), "gap", RED, bold=True)
    return d


def _inside(p, triangle):
    signs = [(b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
             for a, b in zip(triangle, triangle[1:] + triangle[:1])]
    return all(s >= 0 for s in signs) or all(s <= 0 for s in signs)


def one_sample():
    """Left: pixels whose centre is not covered. Right: a steep surface, one voxel a column."""
    d = Drawing("Two ways to lose voxels: pixels that are touched beside their centre, and one voxel for each column",
                -0.6, -1.4, 14.6, 5.2)
    triangle = [(0.3, 0.55), (5.7, 3.1), (1.2, 1.95)]
    touched = {(x, y) for x in range(6) for y in range(5) for i in range(21) for j in range(21)
               if _inside((x + i / 20, y + j / 20), triangle)}
    for x, y in sorted(touched):
        hit = _inside((x + 0.5, y + 0.5), triangle)
        d.box((x, y), (x + 1, y + 1), GREY, PALE[GREEN] if hit else PALE[RED], 0.7)
    _grid(d, 0, 0, 6, 5)
    for x in range(6):
        for y in range(5):
            d.dot((x + 0.5, y + 0.5), GREEN if _inside((x + 0.5, y + 0.5), triangle) else GREY, 3)
    d.polygon(triangle, INK, "none", 2)
    d.label((3, -0.3), "seen along z: drawn where the centre is covered", INK, place="below", size=13)
    d.label((3, -0.85), "green: drawn, red: touched and lost", INK, place="below", size=13)
    left = 8
    a, b = (left + 0.4, 0.2), (left + 5.8, 5.0)
    slope = (b[1] - a[1]) / (b[0] - a[0])
    for x in range(6):
        at = [a[1] + slope * (min(max(left + x + s, a[0]), b[0]) - a[0]) for s in (0, 0.5, 1)]
        for z in range(math.floor(at[0]), min(math.floor(at[2]), 4) + 1):
            kept = z == math.floor(at[1])
            d.box((left + x, z), (left + x + 1, z + 1), GREY, PALE[GREEN] if kept else PALE[RED], 0.7)
        d.dot((left + x + 0.5, at[1]), GREEN, 3)
    _grid(d, left, 0, left + 6, 5)
    d.line(a, b, INK, 2)
    d.label((left + 3, -0.3), "seen from the side: one voxel for each column", INK, place="below", size=13)
    d.label((left + 3, -0.85), "green: written, red: crossed and lost", INK, place="below", size=13)
    return d


def moved_edge():
    """An edge moved out by the support of half a pixel, and the corners that follow."""
    d = Drawing("The edges are moved out until the larger triangle covers the centre of every pixel that the small one touches",
                -1.4, -0.9, 8.4, 5.6)
    triangle = [(1.3, 0.8), (5.6, 1.7), (2.4, 3.8)]
    lines = []
    for a, b in zip(triangle, triangle[1:] + triangle[:1]):
        n = (b[1] - a[1], a[0] - b[0])  # outwards, for corners counter-clockwise
        reach = 0.5 * (abs(n[0]) + abs(n[1]))
        lines.append((n, n[0] * a[0] + n[1] * a[1] + reach))

    def crossing(p, q):
        (a, c), (b, e) = p, q
        det = a[0] * b[1] - a[1] * b[0]
        return (c * b[1] - e * a[1]) / det, (a[0] * e - b[0] * c) / det

    large = [crossing(lines[i - 1], lines[i]) for i in range(3)]
    _grid(d, -1, 0, 7, 5)
    d.polygon(large, BLUE, PALE[BLUE], 2)
    d.polygon(triangle, INK, LIGHT, 2)
    for x in range(-1, 7):
        for y in range(5):
            d.dot((x + 0.5, y + 0.5), BLUE if _inside((x + 0.5, y + 0.5), large) else GREY, 3)
    a, b = triangle[1], triangle[2]
    middle = ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2)
    n, c = lines[1]
    length = math.hypot(*n)
    move = (c - n[0] * a[0] - n[1] * a[1]) / length
    end = (middle[0] + move * n[0] / length, middle[1] + move * n[1] / length)
    d.arrow(middle, end, RED, 2)
    d.label((end[0] + 0.15, end[1] + 0.1), "d", RED, "start", bold=True)
    square = (middle[0], middle[1])
    d.box((square[0] - 0.5, square[1] - 0.5), (square[0] + 0.5, square[1] + 0.5), RED, "none", 1.2)
    d.label((2.9, 1.9), "triangle", INK)
    d.label((4.6, 4.4), "what is drawn", BLUE, "start")
    return d
