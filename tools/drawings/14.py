"""Drawings of docs/14_speed_against_error.md."""
from drawing import BLUE, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def front():
    """Settings as points of time and error, those that none beats, and what a budget takes."""
    d = Drawing("Settings as points of time and error: the front, what is beaten, and what a budget takes", -1.4, -0.9, 11.2, 5.6)
    points = [(0.8, 4.5), (1.6, 2.9), (2.7, 1.9), (4.6, 1.2), (7.4, 0.7)]
    beaten = [(2.2, 3.9), (3.6, 2.8), (4.2, 4.2), (5.8, 2.0), (6.9, 1.6), (8.3, 1.3), (7.4, 3.4)]
    d.polygon([(2.7, 1.9), (10.4, 1.9), (10.4, 5.2), (2.7, 5.2)], PALE[GREY], LIGHT, 1)
    d.arrow((0, 0), (10.6, 0), INK)
    d.arrow((0, 0), (0, 5.3), INK)
    d.label((10.5, -0.2), "time t", INK, "end", "below")
    d.label((-0.15, 5.1), "error e", INK, "end", "center", 14)
    stairs = [(0.8, 5.2)]
    for (x0, y0), (x1, _) in zip(points, points[1:]):
        stairs += [(x0, y0), (x1, y0)]
    stairs += [points[-1], (10.4, points[-1][1])]
    d.path(stairs, BLUE, 2)
    for p in beaten:
        d.dot(p, GREY, 5)
    for p in points:
        d.dot(p, BLUE, 6)
    d.dot((2.7, 1.9), RED, 6)
    d.label((2.6, 1.65), "s", RED, "end", "below", bold=True)
    d.label((6.2, 4.8), "s beats all in this area: slower, and no better", GREY, size=14)
    d.line((6.2, 0), (6.2, 1.75), ORANGE, 1.8, "6 4")
    d.label((6.2, -0.2), "budget", ORANGE, place="below")
    d.circle((4.6, 1.2), 0.22, ORANGE, "none", 2)
    d.label((4.5, 0.85), "takes this one", ORANGE, "middle", "below", 14)
    d.label((8.7, 0.85), "the front F", BLUE, place="above", size=14)
    return d
