"""Drawings of docs/10_soft_shadows.md."""
import math

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def _tangent_points(point, center, radius):
    """Where the two lines from the point touch the circle."""
    dx, dy = center[0] - point[0], center[1] - point[1]
    far = math.hypot(dx, dy)
    half, middle = math.asin(radius / far), math.atan2(dy, dx)
    length = math.sqrt(far * far - radius * radius)
    return [(point[0] + length * math.cos(middle + s * half), point[1] + length * math.sin(middle + s * half))
            for s in (1, -1)]


def _on_floor(a, b, floor=0.0, slope=0.0):
    """Where the line through a and b meets y = floor + slope * x."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    t = (floor + slope * a[0] - a[1]) / (dy - slope * dx)
    return a[0] + t * dx, a[1] + t * dy


def cone_to_light():
    """A point sees a sphere under the half angle a; thin cones through the voxels divide it."""
    d = Drawing("From a point a lamp of radius r at distance d is seen within a cone of half angle a, divided into thin cones",
                -0.4, -0.7, 12.6, 5.2)
    point, light, radius = (1.2, 0.5), (10.4, 3.6), 1.15
    touch = _tangent_points(point, light, radius)
    d.polygon([point, *touch], PALE[ORANGE], PALE[ORANGE], 1)
    size = 0.6
    for i in range(3):
        for j in range(4):
            d.box((5.2 + size * i, 0.2 + size * j), (5.8 + size * i, 0.8 + size * j), GREY, LIGHT, 1)
    d.circle(light, radius, ORANGE, PALE[ORANGE], 2)
    for i in range(7):
        x, y = (touch[0][k] + (touch[1][k] - touch[0][k]) * i / 6 for k in (0, 1))
        d.line(point, (x, y), ORANGE, 1.5 if i in (0, 6) else 0.7)
    d.line(point, light, INK, 1, "6 4")
    d.line(light, touch[0], INK, 1.2)
    d.box((0, 0.2), (4.4, 0.5), GREY, LIGHT, 1)
    d.dot(point, INK, 5)
    middle = math.degrees(math.atan2(light[1] - point[1], light[0] - point[0]))
    half = math.degrees(math.asin(radius / math.hypot(light[0] - point[0], light[1] - point[1])))
    d.arc(point, 3.0, middle, middle + half, RED, 2)
    d.label((4.3, 1.95), "a", RED, bold=True)
    d.label((light[0] - 0.55, light[1] + 0.45), "r", INK)
    d.label((7.6, 2.5), "d", INK, place="below")
    d.label((10.4, 2.2), "lamp", ORANGE, place="below")
    d.label((6.1, 0.05), "voxels of an occluder", GREY, place="below")
    d.label((2.4, 2.9), "sin a = r / d", RED, size=17)
    d.label((7.5, 1.1), "V: what the voxels leave\nopen of the thin cones", INK, "start", "below", 14)
    return d


def penumbra():
    """The edge of an occluder, and the two rays past it to the lamp's rim."""
    d = Drawing("Between the full shadow and the full light lies the penumbra, as wide as the lamp seen through the edge",
                -0.6, -1.7, 12.2, 6.6)
    light, radius, edge = (5.6, 5.6), 0.8, (5.0, 2.6)
    left, right = (light[0] - radius, light[1]), (light[0] + radius, light[1])
    p, q = _on_floor(left, edge), _on_floor(right, edge)
    d.box((0, -0.3), (11.6, 0), GREY, LIGHT, 1)
    d.box((0.6, edge[1]), (edge[0], edge[1] + 0.15), INK, LIGHT, 1.5)
    d.polygon([edge, p, q], PALE[ORANGE], PALE[ORANGE], 1)
    d.circle(light, radius, ORANGE, PALE[ORANGE], 2)
    d.line(left, p, ORANGE, 1.5)
    d.line(right, q, ORANGE, 1.5)
    d.line(left, right, INK, 1.2)
    d.dot(edge, RED)
    d.arrow((q[0], -0.55), (p[0], -0.55), RED, both=True)
    d.label(((p[0] + q[0]) / 2, -0.75), "penumbra, w = 2 r x / (d - x)", RED, place="below")
    d.arrow((8.6, 0), (8.6, edge[1]), INK, both=True)
    d.line((edge[0], edge[1]), (8.8, edge[1]), GREY, 0.8, "4 4")
    d.label((8.75, edge[1] / 2), "x", INK, "start")
    d.arrow((10.2, 0), (10.2, light[1]), INK, both=True)
    d.line(light, (10.4, light[1]), GREY, 0.8, "4 4")
    d.label((10.35, light[1] / 2), "d", INK, "start")
    d.label((light[0] - 0.95, light[1] + 0.2), "lamp, 2 r wide", ORANGE, "end")
    d.label((2.4, 0.4), "sees nothing of it", INK, size=14)
    d.label((7.1, 0.4), "sees all", INK, size=14)
    d.label((2.6, 3.0), "occluder", INK, place="above")
    return d


def tilted_receiver():
    """The same penumbra on a floor that is tilted away from the light."""
    d = Drawing("On a receiver tilted by theta against the light the same penumbra is longer by 1 / cos theta", -0.6, -2.5, 11.8, 5.2)
    edge, w, reach = (5.0, 3.2), 0.24, 5.6
    below = 3.2
    slope = -math.tan(math.radians(35))
    pivot = (5.0, edge[1] - below)

    def floor_at(x):
        return pivot[1] + slope * (x - pivot[0])

    d.polygon([(1.4, floor_at(1.4)), (8.2, floor_at(8.2)), (8.2, floor_at(8.2) - 0.3), (1.4, floor_at(1.4) - 0.3)], GREY, LIGHT, 1)
    d.box((1.0, edge[1]), (edge[0], edge[1] + 0.15), INK, LIGHT, 1.5)
    rays = [(edge[0] - s * w * 1.7, edge[1] + 1.7) for s in (1, -1)]
    hits, flat = [], []
    for r in rays:
        hits.append(_on_floor(r, edge, pivot[1] - slope * pivot[0], slope))
        flat.append(_on_floor(r, edge, pivot[1]))
    d.polygon([edge, *hits], PALE[ORANGE], PALE[ORANGE], 1)
    for r, h in zip(rays, hits):
        d.line(r, h, ORANGE, 1.5)
    d.dot(edge, RED)
    d.line((3.2, pivot[1]), (8.6, pivot[1]), GREY, 1, "6 4")
    d.line(*flat, BLUE, 4)
    d.line(*hits, RED, 4)
    n = (math.sin(math.radians(35)), math.cos(math.radians(35)))
    d.arrow(pivot, (pivot[0] + 2.1 * n[0], pivot[1] + 2.1 * n[1]), GREEN, 2)
    d.line(pivot, (pivot[0], pivot[1] + 2.3), GREY, 1, "6 4")
    d.arc(pivot, 1.5, 55, 90, GREEN)
    d.label((5.55, 1.75), "\u03b8", GREEN)
    d.label((pivot[0] + 2.1 * n[0] + 0.1, pivot[1] + 2.1 * n[1] + 0.1), "normal", GREEN, "start")
    d.label((8.7, pivot[1]), "facing the light: w", BLUE, "start")
    d.label((6.6, floor_at(6.6) - 0.9), "on the slope: w / cos \u03b8", RED, "end", "below")
    d.label((2.6, edge[1] + 0.3), "occluder", INK, place="above")
    d.label((5.6, 4.8), "from a wide, far light", ORANGE, "start")
    return d
