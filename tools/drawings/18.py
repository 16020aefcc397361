"""Drawings of docs/18_voxel_ray_marching.md."""
import math

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def cosine_law():
    """The sphere that touches the surface: n plus a point of the unit sphere."""
    d = Drawing("The normal plus a random point of the unit sphere: the sum lies on a sphere that touches the surface",
                -3.6, -0.9, 6.4, 4.6)
    d.box((-3.2, -0.3), (3.2, 0), GREY, LIGHT, 1)
    scale = 2.0
    d.circle((0, scale), scale, BLUE, PALE[BLUE], 1.5)
    d.arrow((0, 0), (0, scale), GREEN, 2.5)
    tilt = math.radians(35)
    hit = (2 * scale * math.cos(tilt) * math.sin(tilt), 2 * scale * math.cos(tilt) * math.cos(tilt))
    d.arrow((0, scale), hit, ORANGE, 2)
    d.arrow((0, 0), hit, RED, 2.5)
    d.arc((0, 0), 1.1, 55, 90, INK)
    d.label((0.42, 1.32), "t", INK)
    d.label((-0.25, 1.1), "n", GREEN, "end")
    d.label((1.1, scale + 0.55), "R", ORANGE)
    d.label((hit[0] + 0.15, hit[1] + 0.05), "n + R, 2 cos t long", RED, "start")
    d.dot((0, 0), INK, 5)
    d.label((2.6, 1.2), "the sphere's area per solid angle\nis (2 cos t)^2 / cos t = 4 cos t",
            BLUE, "start", "below", 14)
    return d


def where_rays_end():
    """A ray that starts low over its own surface, by full voxels and by planes."""
    d = Drawing("A ray that leaves a surface at a low angle: full voxels stop it at once, the planes of pieces do not",
                -0.4, -1.1, 12.4, 4.2)
    for i in range(8):
        d.box((i, 0), (i + 1, 1), GREY, LIGHT, 1)
    for j in range(1, 4):
        d.box((8, j), (9, j + 1), GREY, LIGHT, 1)
    d.box((8, 0), (9, 1), GREY, LIGHT, 1)
    d.line((0, 0.4), (8.6, 0.4), INK, 2.5)
    d.line((8.6, 0.4), (8.6, 4), INK, 2.5)
    start, end = (1.4, 0.4), (8.6, 2.2)
    d.arrow(start, end, GREEN, 2.5)
    d.dot(start, INK, 5)
    slope = (end[1] - start[1]) / (end[0] - start[0])
    d.dot((2.0, start[1] + 0.6 * slope), RED, 5)
    d.dot(end, GREEN, 5)
    d.arrow((1.5, 0.62), (1.5, 1.0), BLUE, 1.5)
    d.label((2.0, -0.15), "full voxels: the next one\nof its own surface", RED, "start", "below", 14)
    d.label((9.2, 2.3), "planes: the wall,\nwhere it is", GREEN, "start", "center", 14)
    d.label((1.2, 1.3), "the piece's plane holds the start:\nit is never crossed", BLUE, "start", "above", 14)
    return d
