"""Drawings of docs/05_atomic_averaging.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def _clipped(points, x0, y0, x1, y1):
    """The part of a convex polygon inside a box."""
    for axis, bound, sign in ((0, x0, 1), (0, x1, -1), (1, y0, 1), (1, y1, -1)):
        kept = []
        for a, b in zip(points, points[1:] + points[:1]):
            da, db = sign * (a[axis] - bound), sign * (b[axis] - bound)
            if da >= 0:
                kept.append(a)
            if da * db < 0:
                t = da / (da - db)
                kept.append((a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])))
        points = kept
    return points


def _area_and_center(points):
    area = x = y = 0.0
    for a, b in zip(points, points[1:] + points[:1]):
        cross = a[0] * b[1] - a[1] * b[0]
        area += cross / 2
        x += (a[0] + b[0]) * cross / 6
        y += (a[1] + b[1]) * cross / 6
    return abs(area), (x / area, y / area)


def area_weight():
    """A voxel with parts of two triangles; each counts with its part's area."""
    d = Drawing("A voxel holds a large part of one triangle and a small part of another: each counts with its area",
                -0.3, -0.9, 15.4, 5.3)
    x0, y0, size = 1.2, 0.6, 3.6
    box = (x0, y0, x0 + size, y0 + size)
    first = [(0.2, 0.1), (6.4, 3.6), (0.6, 5.0)]
    second = [(0.2, 0.1), (6.6, -0.6), (6.4, 3.6)]
    parts = []
    for triangle, color in ((first, BLUE), (second, ORANGE)):
        d.polygon(triangle, GREY, LIGHT, 1)
        parts.append((_clipped(triangle, *box), color))
    d.box(box[:2], box[2:], INK, "#ffffff", 2)
    for i, (points, color) in enumerate(parts, 1):
        area, center = _area_and_center(points)
        d.polygon(points, color, PALE[color], 2)
        d.dot(center, color)
        share = area / size**2
        d.label((center[0], center[1] + 0.15), f"A_{i} = {share:.2f}", color, place="above")
        d.label((7.4, 4.0 - 1.3 * i), f"{share:.2f} times the reflectance of triangle {i} at its dot", color, "start", size=14)
    d.label((x0 + 0.05, y0 + size + 0.1), "voxel", INK, "start", "above")
    areas = [_area_and_center(points)[0] / size**2 for points, _ in parts]
    d.label((7.4, 4.2), "weights in the voxel's mean:", INK, "start", size=14)
    d.label((7.4, 0.4), f"divided once, at the end, by {sum(areas):.2f}", INK, "start", size=14)
    return d


def carry():
    """An addition that makes the low word wrap around carries one into the high word."""
    d = Drawing("Two 32 bit words: the addition that wraps the low word around adds one to the high word", -0.2, 0.2, 14.2, 5.2)

    def word(x, y, text, color, name=None):
        d.box((x, y), (x + 3.2, y + 0.8), color, PALE[color], 1.5)
        d.label((x + 1.6, y + 0.4), text, color)
        if name:
            d.label((x + 1.6, y + 0.9), name, GREY, place="above", size=13)

    word(0.2, 3.6, "0000 0002", INK, "high word")
    word(3.7, 3.6, "FFFF FFF0", INK, "low word")
    d.label((8.1, 4.0), "a fragment adds 0000 0020", BLUE, "start")
    d.arrow((5.3, 3.5), (5.3, 1.5), BLUE, 2)
    d.label((5.5, 2.75), "atomicAdd returns before = FFFF FFF0", BLUE, "start", size=14)
    d.label((5.5, 2.2), "before + 20 < before: it wrapped around", RED, "start", size=14)
    d.arrow((4.4, 2.5), (2.2, 1.5), RED, 2)
    d.label((3.0, 2.3), "carry 1", RED, "end")
    word(0.2, 0.6, "0000 0003", RED)
    word(3.7, 0.6, "0000 0010", BLUE)
    d.label((8.1, 1.0), "the same pair in any order of threads", GREEN, "start")
    return d
