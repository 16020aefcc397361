"""Drawings of docs/06_voxel_shading.md."""
import math

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, RED, Drawing


def face():
    """A face of a voxel: centroid, mean normal, light and distance."""
    d = Drawing("A face is lit at the centroid of its surfaces, with their mean normal", -0.4, -0.5, 11.6, 6.4)
    for x in range(2, 8):
        d.line((x, 0), (x, 3), GREY, 0.7)
    for y in range(4):
        d.line((2, y), (7, y), GREY, 0.7)
    a, b = (2, 0.35), (7, 2.1)
    slope = (b[1] - a[1]) / (b[0] - a[0])
    d.path([a, b, (7, 0), (2, 0)], GREY, 0.7, None, LIGHT, closed=True)
    d.line(a, b, INK, 2.5)
    low, high = (4, a[1] + slope * 2), (5, a[1] + slope * 3)
    d.box((4, 1), (5, 2), BLUE, "none", 2)
    d.line(low, high, BLUE, 4)
    center = (4.5, (low[1] + high[1]) / 2)
    length = math.hypot(1, slope)
    n = (-slope / length, 1 / length)
    light = (8.6, 5.5)
    way = (light[0] - center[0], light[1] - center[1])
    far = math.hypot(*way)
    l = (way[0] / far, way[1] / far)
    d.line(center, light, ORANGE, 1.2, "6 4")
    d.arrow(center, (center[0] + 1.9 * n[0], center[1] + 1.9 * n[1]), BLUE, 2)
    d.arrow(center, (center[0] + 1.9 * l[0], center[1] + 1.9 * l[1]), ORANGE, 2)
    d.arc(center, 0.9, math.degrees(math.atan2(l[1], l[0])), math.degrees(math.atan2(n[1], n[0])), GREEN)
    d.dot(center, BLUE, 5)
    d.dot(light, ORANGE, 7)
    d.label((light[0] + 0.25, light[1]), "light, I (W/sr)", ORANGE, "start")
    d.label((center[0] + 1.9 * n[0] - 0.15, center[1] + 1.9 * n[1]), "n, mean normal", BLUE, "end")
    d.label((center[0] + 1.9 * l[0] + 0.05, center[1] + 1.9 * l[1] - 0.25), "l", ORANGE, "start")
    d.label((4.85, 2.45), "\u03b8", GREEN)
    d.label((7.1, 3.75), "d (m)", ORANGE, "start")
    d.label((7.25, 0.95), "centroid of the\nsurfaces in the voxel", BLUE, "start")
    d.line((7.15, 0.95), (center[0] + 0.1, center[1] - 0.05), BLUE, 0.8)
    d.label((8.2, 2.6), "E = I cos \u03b8 / d\u00b2", INK, "start")
    return d


def lookup():
    """The mean point of a round surface lies inside it; half a voxel along the normal it is outside."""
    d = Drawing("The mean point of a round surface lies inside it and in its own shadow; half a voxel along the normal it is "
                "outside", -0.4, -0.2, 11.8, 6.1)
    size, x0, y0 = 3.2, 2.0, 0.6
    center, radius = (1.6, -1.1), 4.1
    d.arc(center, radius, 3, 106, INK, 2.5)
    inside = []
    for i in range(361):
        a = math.radians(i / 2)
        p = (center[0] + radius * math.cos(a), center[1] + radius * math.sin(a))
        if x0 <= p[0] <= x0 + size and y0 <= p[1] <= y0 + size:
            inside.append(p)
    d.path(inside, BLUE, 4)
    d.box((x0, y0), (x0 + size, y0 + size), BLUE, "none", 2)
    mean = (sum(p[0] for p in inside) / len(inside), sum(p[1] for p in inside) / len(inside))
    normals = [((p[0] - center[0]) / radius, (p[1] - center[1]) / radius) for p in inside]
    n = (sum(v[0] for v in normals), sum(v[1] for v in normals))
    length = math.hypot(*n)
    n = (n[0] / length, n[1] / length)
    out = (mean[0] + 0.5 * size * n[0], mean[1] + 0.5 * size * n[1])
    d.arrow(mean, out, GREEN, 2)
    d.dot(mean, RED, 5)
    d.dot(out, GREEN, 5)
    light = (math.cos(math.radians(88)), math.sin(math.radians(88)))
    for p, color in ((mean, RED), (out, GREEN)):
        reach = (5.7 - p[1]) / light[1]
        d.line(p, (p[0] + reach * light[0], p[1] + reach * light[1]), ORANGE, 1.2, "6 4")
    d.label((mean[0] - 0.15, mean[1] - 0.1), "mean point: inside,\nin its own shadow", RED, "end", "below")
    d.label((out[0] + 0.25, out[1] - 0.2), "asked here: half a voxel\nalong the normal", GREEN, "start")
    d.label((x0 - 0.1, y0 + size - 0.2), "voxel", BLUE, "end")
    d.label((out[0] + 0.35, 5.3), "to the light", ORANGE, "start")
    d.label((5.75, 0.5), "surface", INK, "start")
    return d
