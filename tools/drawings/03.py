"""Drawings of docs/03_shadow_map.md."""
from drawing import BLUE, GREY, INK, LIGHT, ORANGE, RED, Drawing


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
