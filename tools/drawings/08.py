"""Drawings of docs/08_diffuse_cones.md."""
import math

from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def leap():
    """A ray through the walk volume in the plane: each step passes the largest empty square that begins at its cell."""
    columns, rows, size = 24, 12, 0.5
    d = Drawing("A ray leaps from cell to cell: each step passes the whole empty square that begins at the ray's cell", -0.4,
                -1.4, 15.6, 7.0)
    occupied = {(x, y) for x in (21, 22) for y in range(rows)} | {(x, y) for x in range(11, 14) for y in range(5)}

    def at(x, y):
        return x * size, y * size

    def side_of(x, y):
        """Of the largest empty square of 1, 2, 4 ... cells that begins at a cell, to the right and up."""
        side = 1
        while side < 8 and not any((x + i, y + j) in occupied for i in range(2 * side) for j in range(2 * side)):
            side *= 2
        return side

    for x in range(columns + 1):
        d.line(at(x, 0), at(x, rows), LIGHT, 0.8)
    for y in range(rows + 1):
        d.line(at(0, y), at(columns, y), LIGHT, 0.8)
    for x, y in sorted(occupied):
        d.box(at(x, y), at(x + 1, y + 1), GREY, PALE[ORANGE], 0.8)
    px, py, slope = 1.5, 2.3, 0.36
    steps, x = [], px
    while True:
        cell = (math.floor(x + 1e-6), math.floor(py + slope * (x - px) + 1e-6))
        side = 1 if cell in occupied else side_of(*cell)
        end = min(cell[0] + side, px + (cell[1] + side - py) / slope)
        steps.append((cell, side, x, end, cell in occupied))
        x = end
        if x >= 22.9:
            break
    for cell, side, _, _, full in steps:
        if not full:
            low, high = at(*cell), at(min(cell[0] + side, columns), min(cell[1] + side, rows))
            d.box(low, high, BLUE, "none", 1.8)
    here = lambda x: at(x, py + slope * (x - px))
    d.arrow(here(px), here(22.95), INK, 2)
    for _, _, begin, _, _ in steps:
        d.dot(here(begin), RED, 4)
    d.dot(here(px), INK, 6)
    d.label((0.75, 0.98), "start", INK, place="below")
    d.label((6.25, 1.2), "something\non the\nway", ORANGE, size=13)
    d.label((11.0, 6.15), "a wall:\ntwo layers of 1/2", ORANGE, place="above", size=14)
    d.label((12.2, 2.2), f"{len(steps)} look-ups (red)\nfor {math.ceil(steps[-1][3] - px)} cells:\nan empty cell says\nhow large the\nempty square is,\na full one what\nit covers", RED,
            "start", size=14)
    d.label((6.9, -0.35), "Squares (in space: cubes) of 1, 2, 4, 8 cells begin at the ray's cell and lie on the side to which\n"
            "the ray goes: an empty cell of the volume holds 8 such numbers, one for each octant.", BLUE, place="below", size=14)
    return d


def own_surface():
    """Why a ray must leave out what is its own: the staircase of a slanted surface."""
    d = Drawing("A ray that leaves a slanted surface still crosses cells of its staircase, and faces there look against it", -0.9,
                -0.6, 15.6, 5.6)
    size, slope = 1.0, math.tan(math.radians(27))
    height = lambda x: 0.55 + slope * x
    for x in range(8):
        for y in {math.floor(height(x)), math.floor(height(x + 1) - 1e-6)}:
            d.box((x * size, y * size), ((x + 1) * size, (y + 1) * size), GREY, LIGHT, 0.8)
    d.line((0, height(0)), (8, height(8)), INK, 3)
    n = (-math.sin(math.radians(27)), math.cos(math.radians(27)))
    p = (2.3, height(2.3))
    start = (p[0] + 0.75 * n[0], p[1] + 0.75 * n[1])
    a = math.radians(33)
    d.dot(p, INK)
    d.line(p, start, GREY, 1.2, "4 3")
    d.arrow(start, (start[0] + 4.6 * math.cos(a), start[1] + 4.6 * math.sin(a)), BLUE, 2)
    d.dot(start, BLUE)
    d.label((start[0] - 0.12, start[1] + 0.15), "start, an offset\nabove the point", BLUE, "end", "above", size=14)
    d.label((start[0] + 4.7 * math.cos(a), start[1] + 4.7 * math.sin(a)), "d, n·d > 0:\nit sees nothing of\nthe surface", BLUE, "start", size=14)
    q = (5.5, height(5.5))
    d.arrow(q, (q[0] + 1.3 * n[0], q[1] + 1.3 * n[1]), INK, 2)
    d.label((q[0] + 1.35 * n[0], q[1] + 1.45 * n[1]), "n", INK, "end", bold=True)
    # the cell's coverage across each axis
    x0, y0, s = 9.6, 0.2, 2.0
    d.box((x0, y0), (x0 + s, y0 + s), GREY, LIGHT, 1)
    d.line((x0, y0 + 0.45), (x0 + s, y0 + 0.45 + slope * s), INK, 3)
    d.line((x0 - 0.25, y0 + 0.45), (x0 - 0.25, y0 + 0.45 + slope * s), RED, 4)
    d.line((x0, y0 - 0.25), (x0 + s, y0 - 0.25), GREEN, 4)
    d.label((x0 - 0.4, y0 + 0.95), "s |n_x|", RED, "end")
    d.label((x0 + s / 2, y0 - 0.35), "s |n_y|", GREEN, place="below")
    d.label((x0 + s + 0.2, y0 + 1.5), "looks against d:\nof its own, left out", RED, "start", size=14)
    d.label((x0 + s + 0.2, y0 + 0.45), "looks along d:\ntells s", GREEN, "start", size=14)
    d.label((x0 + s / 2, y0 + s + 0.15), "one cell, area s", INK, place="above", size=14)
    return d


def shared():
    """Points of a window have 16 sets, the tent that shares them, and the pixels between points."""
    d = Drawing("Sixteen sets of cones in a window of 4 x 4 points, the tent that shares them, and pixels between points", -0.4,
                -1.4, 15.0, 5.0)
    for i in range(4):
        for j in range(4):
            x, y = 0.5 + i, 3.5 - j
            d.box((x - 0.5, y - 0.5), (x + 0.5, y + 0.5), GREY, "#ffffff", 1)
            turn = 360 / 16 * (4 * j + i) / 4
            for k in range(4):
                angle = math.radians(turn + 90 * k)
                d.line((x, y), (x + 0.36 * math.cos(angle), y + 0.36 * math.sin(angle)), BLUE, 2)
            d.dot((x, y), INK, 3)
    d.label((2.0, 4.3), "16 points, 16 sets of cones", INK, place="above", size=14)
    d.label((2.0, -0.2), "4 of 16 cones drawn", BLUE, place="below", size=13)
    for i, weight in enumerate((1, 2, 3, 4, 3, 2, 1)):
        x = 5.7 + 0.55 * i
        color = BLUE if i != 5 else GREY
        d.box((x - 0.2, 1.0), (x + 0.2, 1.0 + 0.55 * weight), color, PALE[color], 1.5)
        d.dot((x, 0.7), INK if i != 5 else RED, 4)
        d.label((x, 1.05 + 0.55 * weight), str(weight), color, place="above", size=13)
    d.label((7.35, 4.3), "mean along a row,\nthen along a column", INK, place="above", size=14)
    d.label((8.45, 0.45), "another surface: left out", RED, place="below", size=13)
    x0, y0 = 10.4, 0.2
    for i in range(8):
        for j in range(8):
            d.box((x0 + i * 0.5, y0 + j * 0.5), (x0 + i * 0.5 + 0.5, y0 + j * 0.5 + 0.5), LIGHT, "#ffffff", 0.8)
    points = [(x0 + 0.25 + i, y0 + 0.25 + j) for i in range(4) for j in range(4)]
    for p in points:
        d.dot(p, INK, 4)
    pixel = (x0 + 1.75, y0 + 1.75)
    d.box((pixel[0] - 0.25, pixel[1] - 0.25), (pixel[0] + 0.25, pixel[1] + 0.25), ORANGE, PALE[ORANGE], 2)
    for p in points:
        if abs(p[0] - pixel[0]) < 0.6 and abs(p[1] - pixel[1]) < 0.6:
            d.arrow(p, pixel, ORANGE, 1.5, head=7)
    d.label((x0 + 2, 4.3), "a pixel takes from the\n4 points around it", ORANGE, place="above", size=14)
    d.label((x0 + 2, -0.0), "dots: points, 1 of 2 x 2 pixels", INK, place="below", size=13)
    return d
