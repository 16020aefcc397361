"""Drawings of docs/17_sparse_voxel_octree.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def _samples(d, corner, side, color, radius=4):
    for i in range(3):
        for j in range(3):
            d.dot((corner[0] + side * i / 2, corner[1] + side * j / 2), color, radius)


def tree():
    """A curve through a grid; nodes with geometry, border nodes, and what is missing."""
    d = Drawing("Nodes with geometry are divided; their empty neighbours become border nodes; the rest is missing",
                -0.4, -1.3, 14.6, 8.5, 48)
    side = 1.0
    height = [2.3, 2.6, 3.1, 3.4, 3.3, 2.8, 2.2, 1.8, 1.6]
    full = set()
    for x in range(8):
        low, high = sorted((height[x], height[x + 1]))
        full |= {(x, y) for y in range(int(low), int(high) + 1)}
    border = {(x + i, y + j) for x, y in full for i in (-1, 0, 1) for j in (-1, 0, 1)} - full
    border = {(x, y) for x, y in border if 0 <= x < 8 and 0 <= y < 8}
    parents = {(x // 2 + i, y // 2 + j) for x, y in full for i in (-1, 0, 1) for j in (-1, 0, 1)}
    parents = {(x, y) for x, y in parents if 0 <= x < 4 and 0 <= y < 4}
    d.box((0, 0), (8, 8), INK, "none", 2)
    for x, y in sorted(parents):
        d.box((2 * x, 2 * y), (2 * x + 2, 2 * y + 2), INK, "none", 1.6)
    for x, y in sorted(border):
        d.box((x, y), (x + side, y + side), GREEN, PALE[GREEN], 1)
    for x, y in sorted(full):
        d.box((x, y), (x + side, y + side), BLUE, PALE[BLUE], 1.4)
    d.path([(x, height[x]) for x in range(9)], RED, 3)
    d.label((4.0, 7.0), "missing: exactly empty,\na cone passes it in one step", GREY, size=14)
    d.label((8.3, 1.3), "the surface", RED, "start")
    d.box((8.5, 7.1), (9.1, 7.7), BLUE, PALE[BLUE], 1.4)
    d.label((9.4, 7.4), "leaf with geometry: one of its\n2 x 2 voxels meets the surface", INK, "start", size=14)
    d.box((8.5, 5.7), (9.1, 6.3), GREEN, PALE[GREEN], 1)
    d.label((9.4, 6.0), "border node: empty neighbour,\nside, edge or corner", INK, "start", size=14)
    d.box((8.5, 4.3), (9.1, 4.9), INK, "none", 1.6)
    d.label((9.4, 4.6), "their parents, and border nodes of theirs", INK, "start", size=14)
    d.label((4.0, -0.4), "in three dimensions: 8 children, 26 neighbours", INK, place="below", size=14)
    return d


def brick():
    """Two leaves beside each other, their voxels, and the samples of their bricks."""
    d = Drawing("A brick has samples at the corners, edges and the middle of its node; neighbours hold copies of those between them",
                -0.6, -1.7, 15.0, 5.4)
    for left, color in ((0, BLUE), (5.4, ORANGE)):
        d.box((left, 0), (left + 4, 4), color, PALE[color], 2)
        d.line((left + 2, 0), (left + 2, 4), GREY, 0.8, "5 4")
        d.line((left, 2), (left + 4, 2), GREY, 0.8, "5 4")
        _samples(d, (left, 0), 4, color, 6)
    for y in (0, 2, 4):
        d.arrow((4.2, y), (5.2, y), RED, 2, both=True)
    d.label((4.7, 4.5), "the same place:\nadd, keep twice", RED, place="above", size=14)
    d.label((1, 1), "voxel", GREY, size=14)
    d.label((2, -0.3), "leaf a: 3 x 3 samples", BLUE, place="below")
    d.label((7.4, -0.3), "leaf b", ORANGE, place="below")
    d.label((10.1, 4.2), "per axis, of the two voxels:", INK, "start")
    d.label((10.3, 3.5), "sample 0:  1/2, 0", INK, "start")
    d.label((10.3, 2.9), "sample 1:  1/2, 1/2", INK, "start")
    d.label((10.3, 2.3), "sample 2:  0, 1/2", INK, "start")
    d.label((10.1, 1.3), "shared: half from a and half\nfrom b, so their sum is the\nmean of the two voxels", INK, "start", "center", 14)
    return d


def kernels():
    """Across: a quarter, a half, a quarter; along: a half, one, a half, the front one first."""
    d = Drawing("A new sample across the direction is the mean (1/4, 1/2, 1/4) of old ones, along it their sum (1/2, 1, 1/2), front first",
                -0.8, -1.5, 14.6, 4.0)
    for x0, weights, color, name in ((0, ("1/4", "1/2", "1/4"), BLUE, "across: a mean"), (8, ("1/2", "1", "1/2"), ORANGE, "along: a sum, front first")):
        for i in range(5):
            d.dot((x0 + 1.4 * i, 0.6), GREY, 4)
        for i in (0, 2, 4):
            d.dot((x0 + 1.4 * i, 2.8), INK, 6)
        for i, text in zip((1, 2, 3), weights):
            d.arrow((x0 + 1.4 * i, 0.75), (x0 + 2.8, 2.6), color, 2)
            d.label((x0 + 1.4 * i, 0.25), text, color, place="below")
        d.label((x0 + 2.8, 3.3), name, color, place="above")
    d.label((-0.5, -0.9), "old samples, s apart; new ones, 2 s apart", INK, "start", "below", 14)
    d.arrow((11.6, -0.75), (13.4, -0.75), RED, 2)
    d.label((11.4, -0.75), "light leaves this way", RED, "end", size=14)
    d.label((13.7, -0.75), "front", RED, "start", size=14)
    return d


def descent():
    """A cone, and the nodes that it samples: small ones near its start, large ones far away."""
    d = Drawing("A cone samples nodes whose samples are as far apart as the cone is wide, and jumps over what is missing",
                -0.5, 0.2, 15.4, 6.3, 46)
    d.polygon([(0, 2), (15, 4.6), (15, 2.2)], PALE[ORANGE], PALE[ORANGE], 1)
    slope = 1.4 / 15
    for x, side in ((0.5, 0.5), (1.0, 0.5), (6.0, 1.5), (12.0, 3.0)):
        y = 2 + slope * (x + side / 2)
        low = (y // side) * side
        d.box((x, low), (x + side, low + side), BLUE, "none", 1.6)
        _samples(d, (x, low), side, BLUE, 3)
    d.line((0, 2), (15, 2 + 15 * slope), ORANGE, 1.5)
    for a, b in ((1.5, 6.0), (7.5, 12.0)):
        d.arrow((a, 2 + slope * a), (b, 2 + slope * b), RED, 2.2)
    d.label((3.6, 3.3), "missing: to the cell's exit", RED, size=14)
    d.label((9.6, 3.5), "missing", RED, size=14)
    d.label((13.5, 6.1), "coarse bricks", BLUE, place="below", size=14)
    d.label((1.0, 1.1), "leaves", BLUE, place="below", size=14)
    d.dot((0, 2), INK, 5)
    return d
