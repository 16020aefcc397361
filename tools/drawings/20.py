"""Drawings of docs/20_form_factor_radiosity.md."""
import math

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def hemicube():
    """Nusselt's analogue and the hemicube: the same rays, two ways to count them."""
    d = Drawing("A patch is seen through the texels of a cube around the point; each texel stands for the share of the disc "
                "below that its rays project to", -4.6, -1.2, 6.6, 5.0)
    d.box((-4.2, -0.3), (4.2, 0), GREY, LIGHT, 1)
    d.arc((0, 0), 3.0, 0, 180, GREY, 1.2, "6 4")
    d.path([(-2, 0), (-2, 2), (2, 2), (2, 0)], BLUE, 2.5)
    for i in range(-4, 5):
        d.line((i / 2, 2), (i / 2, 2.12), BLUE, 1)
    for i in range(1, 4):
        d.line((2, i / 2), (2.12, i / 2), BLUE, 1)
        d.line((-2, i / 2), (-2.12, i / 2), BLUE, 1)
    a, b = (1.9, 4.5), (4.4, 3.0)
    d.line(a, b, ORANGE, 5)
    d.polygon([(0, 0), a, b], PALE[ORANGE], PALE[ORANGE], 0.5)
    for p in (a, b):
        d.line((0, 0), p, ORANGE, 1.2)
    on_sphere = [(3 * p[0] / math.hypot(*p), 3 * p[1] / math.hypot(*p)) for p in (a, b)]
    for q in on_sphere:
        d.line(q, (q[0], 0), GREY, 1, "4 4")
    d.line((on_sphere[0][0], -0.12), (on_sphere[1][0], -0.12), RED, 5)
    d.line((2 * a[0] / a[1], 2), (2, 2), RED, 5)
    d.line((2, 2), (2, 2 * b[1] / b[0]), RED, 5)
    d.dot((0, 0), INK, 5)
    d.label((-0.4, -0.75), "patch i", INK)
    d.label((3.6, 4.2), "patch j", ORANGE, "start")
    d.label((-4.4, 2.2), "hemicube: its top\nand half sides", BLUE, "start", size=14)
    d.label((-2.2, 3.2), "hemisphere", GREY, size=14)
    d.label((0.9, -0.75), "F_{ij}: its share of the disc", RED, "start", size=14)
    return d


def mirrored_camera():
    """The item buffer of a point in a mirror: the eye and its cube reflected, clipped at the mirror."""
    d = Drawing("The view of a point in a mirror is the view of its mirror image through the mirror", -0.8, -4.2, 10.6, 4.4)
    eye, image = (1.6, -2.8), (1.6, 2.8)
    d.polygon([image, (3.2, 0), (5.4, 0)], PALE[GREY], PALE[GREY], 0.5)
    ends = []
    for x in (3.2, 5.4):
        t = 5.6 / 2.8
        ends.append((image[0] + t * (x - image[0]), -2.8))
    d.polygon([(3.2, 0), (5.4, 0), ends[1], ends[0]], PALE[ORANGE], PALE[ORANGE], 0.5)
    d.line((-0.4, 0), (10.2, 0), BLUE, 1, "6 4")
    d.box((3.2, 0), (5.4, 0.18), BLUE, PALE[BLUE], 1.5)
    d.line((6.0, -2.8), (7.4, -2.8), ORANGE, 5)
    for x in (6.0, 7.4):
        m = (image[0] + (x - image[0]) / 2, 0)
        d.line(image, m, GREY, 1.2, "5 4")
        d.line(m, (x, -2.8), ORANGE, 1.5)
        d.line(eye, m, ORANGE, 1.5)
    for p, up in ((eye, 1), (image, -1)):
        color = INK if p is eye else GREY
        d.path([(p[0] - 0.5, p[1]), (p[0] - 0.5, p[1] + up * 0.5), (p[0] + 0.5, p[1] + up * 0.5), (p[0] + 0.5, p[1])], color, 1.8)
        d.dot(p, color, 5)
    d.box((0, -3.1), (10, -2.8), GREY, LIGHT, 1)
    d.label((1.6, -3.5), "patch i and its hemicube", INK, size=14)
    d.label((2.3, 3.2), "the same, reflected", GREY, "start", size=14)
    d.label((6.7, -3.5), "patch j", ORANGE, size=14)
    d.label((5.7, 0.4), "mirror", BLUE, "start")
    d.label((9.9, -1.4), "kept: below the mirror's\nplane, and where the first\nbuffer has the mirror", INK, "end", size=13)
    return d


def bisection():
    """An edge is bisected in both triangles at once, and only when it is the longest of both."""
    d = Drawing("To bisect a triangle, first bisect its neighbour at the longest edge until that edge is the longest of both", 0, -0.6, 12.4, 4.2)

    def shape(x, cuts, marks):
        a, b, c, e = (x, 0.4), (x + 2.0, 0.4), (x + 1.0, 1.8), (x + 3.2, 2.8)
        d.polygon([a, b, c], INK, PALE[BLUE] if marks else "none", 1.5)
        d.polygon([b, e, c], INK, "none", 1.5)
        for p, q in cuts(a, b, c, e):
            d.line(p, q, RED, 2)

    def middle(p, q):
        return (p[0] + q[0]) / 2, (p[1] + q[1]) / 2

    shape(0.3, lambda a, b, c, e: [], True)
    shape(4.3, lambda a, b, c, e: [(c, middle(b, e))], True)
    shape(8.6, lambda a, b, c, e: [(c, middle(b, e)), (a, middle(b, c)), (middle(b, c), middle(b, e))], True)
    for x in (3.3, 7.4):
        d.arrow((x, 1.2), (x + 0.9, 1.2), GREY, 1.5)
    d.label((1.3, 0.0), "wanted smaller", BLUE, size=13)
    d.label((5.6, 0.0), "first its neighbour's longest edge,", RED, size=13)
    d.label((10.2, 0.0), "then the common edge, in both", RED, size=13)
    return d


def foot_of_a_wall():
    """Where a wall rises from an edge the surface's light ends; rings do not cross it."""
    d = Drawing("Values at corners are fitted to the patches of one surface: no further than the foot of a wall", -0.4, -1.0, 10.6, 4.0)
    d.polygon([(0, 0), (10, 0), (10, -0.3), (0, -0.3)], GREY, LIGHT, 1)
    d.box((4.9, 0), (5.1, 3.0), INK, LIGHT, 1.5)
    for i, height in enumerate((2.4, 2.1, 1.7, 1.2)):
        d.line((5.1 + i * 1.2, height), (6.3 + i * 1.2, height), ORANGE, 2)
    for i in range(4):
        d.line((4.9 - i * 1.2, 0.15), (3.7 - i * 1.2, 0.15), ORANGE, 2)
    d.path([(5.1, 2.55), (6.3, 2.27), (7.5, 1.92), (8.7, 1.45), (9.9, 0.9)], BLUE, 2)
    d.path([(0.1, 0.1), (4.9, 0.1)], BLUE, 2)
    d.dot((5.1, 2.55), BLUE)
    d.dot((4.9, 0.1), BLUE)
    d.label((7.6, 2.7), "one value a patch", ORANGE, "start", size=14)
    d.label((5.4, 0.75), "fitted at corners, and interpolated", BLUE, "start", size=14)
    d.label((2.4, 0.6), "dark side", INK, size=14)
    d.label((5.0, 3.3), "wall", INK)
    d.label((5.0, -0.7), "the same edge of the floor: two values", BLUE, size=14)
    return d
