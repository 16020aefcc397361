"""Drawings of docs/15_dynamic_scenes.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def lists():
    """Faces of what stands still keep their places; those of what moves stand behind them."""
    d = Drawing("Faces of what stands still keep their places in the list, those of what moves stand behind them with sums of "
                "both", -0.6, -3.6, 13.2, 3.4)
    for i in range(7):
        lost = i in (3, 4)
        d.box((i, 0), (i + 1, 1), BLUE, LIGHT if lost else PALE[BLUE], 1.5)
        d.label((i + 0.5, 0.5), "S", GREY if lost else BLUE, bold=not lost)
    for i in range(4):
        d.box((7.6 + i, 0), (8.6 + i, 1), ORANGE, PALE[ORANGE], 1.5)
        d.label((8.1 + i, 0.5), "S + D" if i in (1, 2) else "D", ORANGE, bold=True)
    d.label((3.5, 1.9), "faces of what stands still: places and sums stay", BLUE)
    d.label((9.6, 1.9), "of voxels in which something moves", ORANGE)
    for i in range(2):
        d.arrow((3.5 + i, -0.1), (9.1 + i, -0.1), GREY, 1.2, dashes="5 4", head=8)
    d.label((6.4, -0.6), "its sums begin with S", GREY, size=14)
    d.box((2.2, -3.2), (10.4, -1.8), INK, "none", 1.2)
    d.label((6.3, -2.2), "list of the voxels of what moves: voxel, its word of the face index before", INK, size=14)
    d.label((6.3, -2.8), "taking out = writing these words back", RED, size=14)
    return d


def events():
    """What runs on which event."""
    d = Drawing("An object that moves runs everything from the shadow maps and its own voxels on, a light what follows from the "
                "maps, a camera the pixels alone", -0.6, -0.8, 14.4, 6.6)
    names = ["voxels\nof the rest", "voxels\nof what moves", "walk volume,\nlinks", "shadow maps,\nvoxel shading",
             "bounces,\npyramids", "pixels"]
    for i, name in enumerate(names):
        d.label((1.2 + 2.3 * i, 5.6), name, INK, size=14)
    rows = [("another grid", range(0, 6), GREY), ("object", range(1, 6), ORANGE), ("light", range(3, 6), GREEN),
            ("camera, setting of pixels", range(5, 6), BLUE)]
    for j, (name, columns, color) in enumerate(rows):
        y = 3.9 - 1.15 * j
        for i in columns:
            d.box((0.25 + 2.3 * i, y), (2.15 + 2.3 * i, y + 0.7), color, PALE.get(color, LIGHT), 1.5)
        first = min(columns)
        if first > 0:
            d.label((0.1 + 2.3 * first, y + 0.35), name, color, "end", bold=True)
        else:
            d.label((1.2, y + 0.35), name, INK, size=13)
    return d
