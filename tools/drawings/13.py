"""Drawings of docs/13_ground_truth.md."""
import math

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def path():
    """A path through a room, with a sample of the lamp at each vertex, and a direction that meets the lamp by chance."""
    d = Drawing("A path from the camera through a room: at every vertex a point on the lamp is asked as well", -0.4, -0.5, 13.4, 7.2)
    d.path([(0.6, 0.4), (11.4, 0.4), (11.4, 6.2), (0.6, 6.2)], INK, 2.5, None, "#ffffff", closed=True)
    d.box((5.4, 6.0), (7.6, 6.2), ORANGE, PALE[ORANGE], 2)
    d.label((6.5, 6.3), "lamp", ORANGE, place="above")
    d.box((8.2, 0.4), (9.8, 1.9), INK, LIGHT, 2)
    camera, x, y, z = (1.3, 2.6), (4.6, 0.4), (11.4, 4.1), (9.0, 1.9)
    d.polygon([(0.9, 2.35), (0.9, 2.95), (1.35, 2.65)], INK, LIGHT, 1.5)
    d.label((0.85, 3.1), "camera", INK, "start", "above")
    for a, b in ((camera, x), (x, y), (y, z), (z, (7.3, 6.0))):
        d.arrow(a, b, BLUE, 2)
    for a, b in ((x, (5.9, 6.0)), (y, (7.1, 6.0)), (z, (5.6, 6.0))):
        d.line(a, b, ORANGE, 1.5, "6 4")
        d.dot(b, ORANGE)
    for p in (x, y, z):
        d.dot(p, BLUE, 5)
    d.label((4.6, 0.2), "x", BLUE, place="below", bold=True)
    d.label((11.6, 4.1), "y", BLUE, "start", bold=True)
    d.label((9.0, 1.5), "z", BLUE, bold=True)
    d.label((6.2, 1.75), "next direction,\nat random", BLUE, "end", size=14)
    d.label((4.95, 3.6), "shadow ray:\na point on the\nlamp by area", ORANGE, "end", size=14)
    d.label((8.15, 4.0), "meets the lamp\nby chance", BLUE, "start", size=14)
    return d


def _voxels(d, x, y, cells, size, color):
    for i, j in cells:
        d.box((x + i * size, y + j * size), (x + (i + 1) * size, y + (j + 1) * size), GREY, PALE[color], 0.8)


def rungs():
    """What each rung of the ladder asks of the point p, from the path tracer's rays to the frame as shipped."""
    d = Drawing("The rungs of the ladder: rays against surfaces, rays against voxels, narrow cones, fewer cones, cones shared",
                -0.2, -0.9, 17, 4.4)
    arc = [(math.cos(math.radians(a)), math.sin(math.radians(a))) for a in range(0, 91, 5)]
    names = [("R1", "rays meet\nsurfaces", "truncation", BLUE), ("R2", "rays meet\nvoxels", "voxelization", RED),
             ("R3", "512 cones,\npyramid", "filtering", ORANGE), ("R4", "256 cones", "quadrature", GREEN),
             ("R5", "16 cones, and\nneighbours'", "reconstruction", INK)]
    for n, (name, text, step, color) in enumerate(names):
        x0 = 0.3 + 3.3 * n
        p = (x0 + 0.4, 0.5)
        reach = 2.1
        d.line((x0, 0.5), (x0 + 2.7, 0.5), INK, 2)
        wall = [(p[0] + reach * c, p[1] + reach * s) for c, s in arc]
        if name == "R1":
            d.path(wall, INK, 2.5)
        else:
            size = 0.3 if name == "R2" else 0.5  # means over what is far
            cells = sorted({(math.floor((reach * c) / size), math.floor((reach * s) / size))
                            for c, s in ((math.cos(math.radians(a / 2)), math.sin(math.radians(a / 2))) for a in range(0, 180))})
            _voxels(d, p[0], p[1], cells, size, color)
        count = {"R1": 12, "R2": 12, "R3": 12, "R4": 6, "R5": 2}[name]
        for i in range(count):
            a = math.radians(90 * (i + 0.5) / count)
            end = (p[0] + (reach - 0.05) * math.cos(a), p[1] + (reach - 0.05) * math.sin(a))
            half = {"R1": 0, "R2": 0, "R3": 3, "R4": 3, "R5": 3}[name]
            if half == 0:
                d.line(p, end, color, 1)
            else:
                sides = [(p[0] + (reach - 0.1) * math.cos(a + s * math.radians(half)),
                          p[1] + (reach - 0.1) * math.sin(a + s * math.radians(half))) for s in (-1, 1)]
                d.polygon([p, *sides], color, PALE[color], 0.8)
        if name == "R5":
            for shift, turn in ((0.35, 12), (0.7, -14)):
                q = (p[0] + shift, p[1])
                for i in range(2):
                    a = math.radians(90 * (i + 0.5) / 2 + turn)
                    d.line(q, (q[0] + 1.5 * math.cos(a), q[1] + 1.5 * math.sin(a)), GREY, 1, "4 3")
                d.dot(q, GREY, 3)
        d.dot(p, color)
        d.label((x0 + 1.3, 3.4), name, color, bold=True)
        d.label((x0 + 1.3, 0.2), text, color, place="below", size=14)
        if n:
            d.arrow((x0 - 0.9, 3.4), (x0 + 0.6, 3.4), GREY)
            d.label((x0 - 0.15, 3.55), step, GREY, place="above", size=13)
    return d
