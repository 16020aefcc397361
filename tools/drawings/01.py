"""Drawings of docs/01_first_light.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, Drawing


def vectors():
    """The directions at a point of a surface that the sum over the lights is made of."""
    d = Drawing("At a point of a surface: the normal n, the direction l to a light at distance d, the direction v to the "
                "eye, and h, half-way between l and v", 0, 0, 12, 6.2)
    p, light, eye = (5.5, 1), (1.6, 5.2), (10.6, 4.1)
    d.box((0.4, 0.6), (11.6, 1), GREY, LIGHT)

    def towards(q, length):
        x, y = q[0] - p[0], q[1] - p[1]
        r = (x * x + y * y) ** 0.5
        return x / r, y / r, (p[0] + length * x / r, p[1] + length * y / r)

    lx, ly, l_end = towards(light, 2.4)
    vx, vy, v_end = towards(eye, 2.4)
    _, _, h_end = towards((p[0] + lx + vx, p[1] + ly + vy), 2.4)
    d.line(p, light, ORANGE, 1.5, "6 4")
    d.line(p, eye, BLUE, 1.5, "6 4")
    d.arc(p, 1.1, 90, 132.9, GREY)
    d.label((4.75, 2.35), "θ", GREY)
    d.arrow(p, (5.5, 3.4), INK, 2)
    d.arrow(p, l_end, ORANGE, 2)
    d.arrow(p, v_end, BLUE, 2)
    d.arrow(p, h_end, GREEN, 2)
    d.dot(light, ORANGE, 7)
    d.dot(eye, BLUE, 7)
    d.dot(p, INK)
    d.label((5.5, 3.55), "n", INK, place="above", bold=True)
    d.label((3.6, 2.75), "l", ORANGE, "end", bold=True)
    d.label((7.75, 2.1), "v", BLUE, "start", "below", bold=True)
    d.label((6.25, 3.45), "h", GREEN, "start", "above", bold=True)
    d.label((1.9, 5.35), "light: I (W/sr) at distance d (m)", ORANGE, "start")
    d.label((2.9, 4.2), "d", ORANGE, "start", "above")
    d.label((10.3, 4.3), "eye", BLUE, "end", "above")
    d.label((6.0, 0.5), "E = I / d² on a plane that faces the light; this one gets E cos θ", INK, place="below")
    return d
