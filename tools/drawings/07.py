"""Drawings of docs/07_anisotropic_mips.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def six_directions():
    """What a voxel with a thin wall holds: one value, and one for each side."""
    d = Drawing("A wall, red on its left and green on its right: one mean value, and one value for each direction",
                -0.2, -1.3, 14.4, 4.6)
    for x, title in ((0.6, "what is there"), (5.0, "one value"), (9.6, "six values")):
        d.box((x, 0.4), (x + 2.6, 3.0), INK, "#ffffff", 2)
        d.label((x + 1.3, 3.7), title, INK, bold=True)
    d.box((1.8, 0.4), (1.9, 3.0), RED, RED, 1)
    d.box((1.9, 0.4), (2.0, 3.0), GREEN, GREEN, 1)
    d.label((1.65, 1.7), "red", RED, "end")
    d.label((2.15, 1.7), "green", GREEN, "start")
    d.box((5.0, 0.4), (7.6, 3.0), INK, "#cdb8a0", 2)
    d.label((6.3, 1.7), "brown, C = A L\nA = 1/2\nfrom every side", INK)
    x = 9.6
    d.box((x, 0.4), (x + 0.25, 3.0), RED, PALE[RED], 2)
    d.box((x + 2.35, 0.4), (x + 2.6, 3.0), GREEN, PALE[GREEN], 2)
    d.arrow((x - 1.1, 1.7), (x - 0.1, 1.7), GREY)
    d.arrow((x + 3.7, 1.7), (x + 2.7, 1.7), GREY)
    d.label((x - 0.95, 2.0), "seen from -x", GREY, "middle", "above", 13)
    d.label((x + 3.35, 2.0), "from +x", GREY, "middle", "above", 13)
    d.label((x + 0.35, 2.2), "A = 1, red", RED, "start", size=13)
    d.label((x + 2.25, 1.2), "A = 1, green", GREEN, "end", size=13)
    d.arrow((x + 1.3, -0.8), (x + 1.3, 0.3), GREY)
    d.label((x + 1.45, -0.6), "from -y, A = 0: the wall seen along itself", GREY, "middle", "below", 13)
    return d


def front_and_back():
    """Two voxels behind each other become one; the back one shows as much as there is room for."""
    d = Drawing("Of two voxels behind each other the back one shows as much of itself as the front one leaves room for",
                -0.2, -0.5, 14.2, 5.8)
    for y, front, back, color, text in ((3.2, 0.5, 0.5, BLUE, "two parts of one slanted wall:\ns = min(0.5 / 0.5, 1) = 1\nA = 0.5 + 1 x 0.5 = 1"),
                                        (0.0, 0.7, 0.6, ORANGE, "they must overlap:\ns = min(0.3 / 0.6, 1) = 0.5\nA = 0.7 + 0.5 x 0.6 = 1")):
        for x in (2.4, 4.6):
            d.box((x, y), (x + 2.2, y + 2.2), INK, "#ffffff", 1.5)
        # front is on the left, where the eye is; its part is below, the back's is above where there is room
        d.box((3.4, y), (3.6, y + 2.2 * front), color, color, 1)
        room = 1 - front
        shown = min(room, back)
        d.box((5.6, y + 2.2 * (1 - back)), (5.8, y + 2.2), color, PALE[color], 1)
        d.box((5.6, y + 2.2 * (1 - shown)), (5.8, y + 2.2), color, color, 1)
        d.label((2.5, y + 1.95), f"front {front}", INK, "start", size=13)
        d.label((5.5, y + 0.25), f"back {back}", INK, "end", size=13)
        d.arrow((0.3, y + 1.1), (2.2, y + 1.1), GREY)
        d.label((1.2, y + 1.25), "d", GREY, place="above")
        d.arrow((7.1, y + 1.1), (8.1, y + 1.1), INK)
        d.box((8.5, y + 0.55), (9.6, y + 1.65), INK, PALE[color], 1.5)
        d.label((9.05, y + 1.1), "A", color)
        d.label((9.9, y + 1.1), text, color, "start", size=13)
    return d


def columns():
    """Eight voxels, four columns of two along the direction, make one."""
    d = Drawing("Eight voxels seen along d are four columns of two: front and back first, then the mean of the four",
                -0.2, -0.4, 13.2, 5.6)

    def at(x, y, z):  # oblique: x to the right, y up, z back
        return 1.0 + 1.5 * x + 0.62 * z, 0.3 + 1.5 * y + 0.46 * z

    def cube(x, y, z, color, fill):
        faces = [[(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 0), (1, 1, 0), (1, 1, 1), (0, 1, 1)],
                 [(1, 0, 0), (1, 0, 1), (1, 1, 1), (1, 1, 0)]]
        for corners in faces:
            d.polygon([at(x + a, y + b, z + c) for a, b, c in corners], color, fill, 1.2)

    colors = {(0, 0): BLUE, (1, 0): ORANGE, (0, 1): GREEN, (1, 1): RED}  # by y, z
    for z in (1, 0):
        for y in (0, 1):
            for x in (0, 1):
                cube(x, y, z, colors[y, z], PALE[colors[y, z]])
    d.arrow((-0.1, 1.9), (0.85, 1.9), GREY, 2)
    d.label((0.3, 2.05), "d", GREY, place="above")
    d.label((1.75, 0.6), "front", INK, size=13)
    d.label((3.25, 0.6), "back", INK, size=13)
    d.arrow((5.8, 2.0), (6.8, 2.0), INK, 2)
    for i, (y, z) in enumerate([(1, 1), (0, 1), (1, 0), (0, 0)]):
        color = colors[y, z]
        top = 4.4 - 1.15 * i
        d.box((7.2, top - 0.75), (8.6, top), color, PALE[color], 1.5)
        d.label((7.9, top - 0.375), "C_f\u00a0+ s\u00a0C_b", color, size=13)
        d.line((8.7, top - 0.375), (9.7, 2.3), GREY, 1)
    d.box((9.8, 1.5), (11.4, 3.1), INK, LIGHT, 2)
    d.label((10.6, 2.3), "mean,\nweights w", INK, size=13)
    return d
