"""Drawings of docs/03_shadow_map.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, RED, Drawing


def depth_compare():
    """Two points of a floor, one of them behind a box as the light sees it."""
    d = Drawing("A light sees the nearest surface in each direction; a point further away than that lies in shadow",
                0, 0, 12, 6.4)
    light, lit, hidden, hit = (2, 5.6), (3.5, 1), (9.2, 1), (6.32, 2.84)
    d.box((0.4, 0.6), (11.6, 1), GREY, LIGHT)
    d.box((5.6, 1), (6.6, 2.84), GREY, LIGHT)
    d.line(light, lit, ORANGE, 2)
    d.line(light, hit, ORANGE, 2)
    d.line(hit, hidden, GREY, 1.5, "6 4")
    d.dot(light, ORANGE, 7)
    d.label((2, 5.85), "light", ORANGE, place="above")
    d.dot(lit, BLUE)
    d.label((3.5, 0.5), "a", BLUE, place="below", bold=True)
    d.dot(hidden, RED)
    d.label((9.2, 0.5), "b", RED, place="below", bold=True)
    d.dot(hit, INK)
    d.label((6.9, 3.0), "the map holds\nthe distance to here", INK, "start", "above")
    d.label((2.4, 3.2), "t_a = z_a: lit", BLUE, "end")
    d.label((8.6, 1.9), "t_b > z_b: in shadow", RED, "start")
    return d


def _texels(d, y, centers, top):
    """Texels of a map as columns of light that come down from `top` to depth `y` of each."""
    for x, depth in zip(centers, y):
        d.line((x - 0.75, depth), (x + 0.75, depth), ORANGE, 2.5)
        d.line((x, top), (x, depth), ORANGE, 1, "3 4")
        d.dot((x, depth), ORANGE, 3)
    for x in [c - 0.75 for c in centers] + [centers[-1] + 0.75]:
        d.line((x, top - 0.12), (x, top + 0.12), GREY, 1.5)


def acne():
    """One depth a texel, against one plane for all of it."""
    d = Drawing("Left: a texel's one depth is a step, and half of a slanted surface lies behind it. Right: compared with the "
                "receiver's plane at the texel's centre, no point lies behind itself", 0, 0, 12.4, 5.2)
    for left, plane in ((0.3, False), (6.5, True)):
        centers = [left + 1.0 + 1.5 * i for i in range(3)]

        def surface(x):
            return 0.7 + 0.45 * (x - left)

        d.line((left + 0.1, surface(left + 0.1)), (left + 5.1, surface(left + 5.1)), GREY, 5)
        _texels(d, [surface(x) for x in centers], centers, 4.3)
        d.label((left + 2.5, 4.45), "texels of the map", GREY, place="above")
        if not plane:
            for x in centers:  # the surface right of the centre rises above the step, left of it it lies below
                d.line((x - 0.75, surface(x - 0.75)), (x, surface(x)), RED, 5)
            d.label((left + 0.9, 0.35), "behind the step: striped", RED, "start", "below")
        else:
            p = (centers[1] + 0.55, surface(centers[1] + 0.55))
            c = (centers[1], surface(centers[1]))
            d.dot(p, BLUE, 5)
            d.label((p[0] + 0.15, p[1] - 0.15), "the point", BLUE, "start", "below")
            d.arrow(p, (c[0] + 0.06, c[1] + 0.03), GREEN, 2)
            d.label((c[0] - 0.15, c[1] + 0.2), "its plane\nat the centre", GREEN, "end", "above")
    return d


def bias():
    """The step along the normal, seen along the light."""
    d = Drawing("A point that is moved off the surface by b along its normal has a clearance of b / cos θ along the light",
                1, 0, 9.0, 5.6)
    p, b, tan = (4.2, 1.35), 1.6, 0.35

    def surface(x):
        return p[1] + tan * (x - p[0])

    d.polygon([(2.2, 0.3), (2.2, surface(2.2)), (8.2, surface(8.2)), (8.2, 0.3)], GREY, LIGHT)
    r = (1 + tan * tan) ** 0.5
    n = (-tan / r, 1 / r)
    q = (p[0] + b * n[0], p[1] + b * n[1])
    foot = (q[0], surface(q[0]))
    d.arrow((q[0], 5.3), (q[0], 4.2), ORANGE, 2)
    d.label((q[0] + 0.2, 4.9), "light", ORANGE, "start")
    d.line((q[0], 4.2), q, ORANGE, 1, "3 4")
    d.arrow(p, q, BLUE, 2)
    d.arrow(q, foot, GREEN, 2, both=True)
    d.dot(p, INK)
    d.dot(q, BLUE, 5)
    d.arc(q, 0.85, 270, 289.3, GREY)
    d.label((q[0] + 0.18, q[1] - 1.08), "θ", GREY)
    d.label((p[0] + 0.05, p[1] + 0.95), "b", BLUE, "start", bold=True)
    d.label((q[0] - 0.2, p[1] + 0.6), "b / cos θ", GREEN, "end", bold=True)
    d.label((p[0] + 0.2, p[1] - 0.15), "point of the surface", INK, "start", "below")
    d.label((q[0] + 0.3, q[1] + 0.05), "where the map is asked", BLUE, "start", "above")
    return d


def fit():
    """A map over everything, and one over what lies behind something else."""
    d = Drawing("A map over the whole floor has one texel for the box; a map over the shadow has all of them", -0.9, 0, 13.5, 4.8)
    dx, dy = 0.45, -1.0  # the way the light travels
    for left, fitted in ((1.0, False), (7.6, True)):
        d.line((left, 0.9), (left + 5.6, 0.9), GREY, 5)
        d.box((left + 2.3, 0.95), (left + 2.7, 1.45), INK, LIGHT)
        top = 4.4
        ends = (left + 2.3, left + 2.93) if fitted else (left, left + 5.6)
        begin = [x + (top - 0.95) * dx / dy for x in ends]
        count = 8
        for i in range(count + 1):
            x0 = begin[0] + (begin[1] - begin[0]) * i / count
            x1 = ends[0] + (ends[1] - ends[0]) * i / count
            edge = i in (0, count)
            d.line((x0, top), (x1, 0.95), ORANGE if edge else LIGHT, 1.5 if edge else 1)
            d.line((x0, top - 0.1), (x0, top + 0.1), ORANGE, 1.5)
        d.line((begin[0], top), (begin[1], top), ORANGE, 1.5)
        d.line((left + 2.7, 0.87), (left + 2.93, 0.87), RED, 6)
        d.label((left + 2.8, 0.7), "all that lies behind something" if fitted else "a plane is behind nothing else",
                GREEN if fitted else RED, place="below")
    return d
