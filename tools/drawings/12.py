"""Drawings of docs/12_second_bounce.md."""
import math

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def link():
    """The links of a face: where its rays end, and which of the faces there a ray takes."""
    d = Drawing("The rays of a face end at other faces, its links; a ray that ends among voxels takes one of their faces", -0.4, -1.2,
                14.6, 5.6)
    size = 0.5
    room = [(i, 0) for i in range(14)] + [(13, j) for j in range(1, 9)] + [(i, 9) for i in range(14)]
    block = [(9, j) for j in range(1, 4)] + [(10, 3), (11, 3)]
    for i, j in room + block:
        d.box((i * size, j * size), ((i + 1) * size, (j + 1) * size), GREY, LIGHT, 0.8)
    face = (2.25, 0.5)
    d.line((2.0, 0.5), (2.5, 0.5), BLUE, 5)
    d.label((2.25, 0.25), "i", BLUE, bold=True)
    for end, color in (((1.2, 4.5), ORANGE), ((3.3, 4.5), ORANGE), ((6.5, 3.9), GREEN), ((4.5, 1.35), RED), ((0.0, 2.6), GREY)):
        d.arrow(face, end, color, 1.8)
    for x0, x1, y, color, name in ((1.0, 1.5, 4.5, ORANGE, "j_1"), (3.0, 3.5, 4.5, ORANGE, "j_2")):
        d.line((x0, y), (x1, y), color, 5)
        d.label(((x0 + x1) / 2, y + 0.25), name, color, size=14)
    d.line((6.5, 3.5), (6.5, 4.0), GREEN, 5)
    d.label((6.75, 3.75), "j_3", GREEN, size=14)
    d.line((4.5, 1.0), (4.5, 1.5), RED, 5)
    d.label((4.75, 1.25), "j_4", RED, size=14)
    d.label((0.05, 2.75), "the sky", GREY, "start", "above", 14)
    d.label((3.4, -0.15), "walked once, kept as a list; a bounce is\nthe mean of what the 5 faces there send", INK, place="below", size=14)
    # which of the faces around the end of a ray
    x0, y0, s = 9.0, 1.3, 1.6
    d.label((x0 + s, 5.0), "which face? at the end of a ray", INK, place="above", size=14)
    for i in range(2):
        for j in range(2):
            full = i == 1
            d.box((x0 + i * s, y0 + j * s), (x0 + (i + 1) * s, y0 + (j + 1) * s), GREY, PALE[GREEN] if full else "#ffffff", 1)
    end = (x0 + s + 0.1, y0 + s * 1.2)
    d.arrow((x0 - 0.6, y0 - 0.1), end, BLUE, 2)
    d.label((x0 - 0.6, y0 - 0.25), "d", BLUE, place="below", bold=True)
    d.line((x0 + 1.5 * s, y0), (x0 + 1.5 * s, y0 + s), GREEN, 4)
    d.line((x0 + 1.5 * s, y0 + s), (x0 + 1.8 * s, y0 + 2 * s), RED, 4)
    for y, color in ((y0 + s / 2, GREEN), (y0 + 1.5 * s, RED)):
        d.arrow((x0 + 1.5 * s + (0.15 * s if color == RED else 0), y), (x0 + 0.95 * s, y + (0.2 if color == RED else 0)), color, 1.2)
        d.label((x0 + 1.1 * s, y + (0.35 if color == RED else 0.15)), "n", color, place="above", size=14)
    d.label((x0 + 2 * s + 0.15, y0 + 1.55 * s), "area · (-n·d)\n· nearness", RED, "start", size=13)
    d.label((x0 + 2 * s + 0.15, y0 + 0.5 * s), "area · (-n·d)\n· nearness", GREEN, "start", size=13)
    d.label((x0 + s, y0 - 0.95), "one face by chance, as likely as it is large\nin the ray's sight: the mean is right", INK, place="below", size=14)
    return d
