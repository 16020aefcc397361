"""Drawings of docs/19_vertex_radiosity.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def split():
    """Edges are cut by their own length, so two triangles agree on the edge that they share."""
    d = Drawing("Left: one triangle is cut and its neighbour is not, and a vertex lies on an edge. "
                "Right: the shared edge is cut for both", -0.3, -1.1, 13.4, 4.4)
    for x, agree in ((0.0, False), (7.2, True)):
        a, b, c, e = (x + 0.2, 1.6), (x + 2.8, 0.2), (x + 2.8, 3.8), (x + 5.4, 2.4)
        d.polygon([a, b, c], INK, PALE[BLUE])
        d.polygon([b, e, c], INK, PALE[GREEN])
        middle = lambda p, q: ((p[0] + q[0]) / 2, (p[1] + q[1]) / 2)
        ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
        for p, q in ((ab, bc), (bc, ca), (ca, ab)):
            d.line(p, q, BLUE)
        if agree:
            d.line(bc, e, GREEN)
        d.dot(bc, GREEN if agree else RED, 6)
        for p in (a, b, c, e, ab, ca):
            d.dot(p)
        said = "cut by its own length:\nthe same for both" if agree else "cut by the triangle's size:\na T-junction"
        d.label((x + 2.8, -0.3), said, GREEN if agree else RED, place="below", size=14)
    return d


def patch():
    """The patch of a vertex: a third of each triangle round it. On an edge its middle lies off the vertex."""
    d = Drawing("The patch of a vertex is a third of each of its triangles; on a border its middle is inside",
                -0.3, -1.0, 13.0, 4.6)

    def fan(origin, ring, closed, color):
        corners = [(origin[0] + x, origin[1] + y) for x, y in ring]
        pairs = list(zip(corners, corners[1:] + ([corners[0]] if closed else [])))
        if not closed:
            pairs = pairs[:len(corners) - 1]
        weighted, area_sum = [0.0, 0.0], 0.0
        for p, q in pairs:
            d.polygon([origin, p, q], GREY, "#ffffff", 1)
            mid = lambda s: ((origin[0] + s[0]) / 2, (origin[1] + s[1]) / 2)
            center = ((origin[0] + p[0] + q[0]) / 3, (origin[1] + p[1] + q[1]) / 3)
            d.polygon([origin, mid(p), center, mid(q)], color, PALE[color], 1)
            area = abs((p[0] - origin[0]) * (q[1] - origin[1]) - (p[1] - origin[1]) * (q[0] - origin[0])) / 6
            area_sum += area
            for k in range(2):
                weighted[k] += area * (center[k] - origin[k])
        for p, q in pairs:
            d.polygon([origin, p, q], GREY, "none", 1)
        d.dot(origin, INK, 5)
        return tuple(origin[k] + 7 / 12 * weighted[k] / area_sum for k in range(2))

    fan((2.0, 2.0), [(1.8, 0), (1.8, 1.8), (0, 1.8), (-1.8, 0), (-1.8, -1.8), (0, -1.8)], True, BLUE)
    d.label((2.0, -0.2), "inside: the middle is the vertex", BLUE, place="below", size=14)
    d.box((5.6, 0.2), (11.2, 0.0), INK, LIGHT)
    middle = fan((8.4, 0.2), [(1.8, 0), (1.8, 1.8), (0, 1.8), (-1.8, 0)], False, ORANGE)
    d.dot(middle, RED, 5)
    d.label((middle[0] + 0.15, middle[1] + 0.1), "light is computed here", RED, "start", "above", 14)
    d.label((8.4, -0.2), "at a wall: the middle is off the wall", ORANGE, place="below", size=14)
    return d


def cell():
    """Of the patches in a light's cell one becomes a light with the flux of all."""
    d = Drawing("A light's cell covers several texels; the brightest lies to one side, one drawn by flux is on the "
                "average in the middle", -0.4, -0.5, 13.0, 5.2)
    d.line((0, 0), (12.4, 0), INK, 2)
    light = (3.0, 4.6)
    d.dot(light, ORANGE, 7)
    d.label((light[0], light[1] + 0.2), "light", ORANGE, place="above")
    ends = [2.2, 3.0, 4.1, 5.6, 7.8]
    for x in ends:
        d.line(light, (x, 0), GREY, 1, "5 4")
    for i, (p, q) in enumerate(zip(ends, ends[1:])):
        d.line((p, 0), (q, 0), (BLUE, GREEN)[i % 2], 6)
    d.line(light, (ends[0], 0), ORANGE, 2)
    d.line(light, (ends[-1], 0), ORANGE, 2)
    d.label((5.0, -0.15), "a cell of 4 texels", ORANGE, place="below", size=14)
    d.arrow((2.6, 0), (2.6, 1.2), RED, 2.5)
    d.label((2.45, 0.9), "maximum: the\nmost light falls here", RED, "end", size=14)
    for x in (3.55, 4.85, 6.7):
        d.arrow((x, 0), (x, 1.0), BLUE, 1.5, dashes="4 3")
    d.label((7.0, 0.75), "flux: any of them, by\nits share of the flux", BLUE, "start", size=14)
    d.label((10.4, 3.2), "the light gets the flux\nof the whole cell,\nand its area as a disc", INK, size=14)
    return d
