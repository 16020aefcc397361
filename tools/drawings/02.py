"""Drawings of docs/02_g_buffer.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, RED, Drawing


def position_from_depth():
    """Pixel and depth value give back the point of the surface."""
    d = Drawing("The ray of a pixel's centre meets the surface where the depth value says: pixel and depth give the position",
                0, 0, 12.4, 5.6)
    eye, axis_y, near_x, far_x = (0.8, 2.6), 2.6, 2.6, 11.2

    def on_ray(x):
        return x, axis_y + (x - eye[0]) * 0.14

    hit = on_ray(8.0)
    d.line(eye, (11.9, axis_y), GREY, 1, "6 4")
    d.label((11.9, axis_y - 0.15), "axis", GREY, "end", "below")
    for sign in (1, -1):  # the frustum
        d.line(eye, (far_x, axis_y + sign * 2.0 * (far_x - eye[0]) / 10.4), LIGHT, 1.5)
    for x, text in ((near_x, "near plane: depth 1"), (far_x, "far plane: depth 0")):
        half = 2.0 * (x - eye[0]) / 10.4
        d.line((x, axis_y - half), (x, axis_y + half), INK, 1.5)
        d.label((x, axis_y - half - 0.1), text, INK, "start" if x == near_x else "end", "below")
    d.path([(7.1, 1.5), (8.0, hit[1]), (8.5, 4.6)], GREY, 3)
    d.line(eye, hit, ORANGE, 2)
    d.line(hit, on_ray(11.2), ORANGE, 1, "3 4")
    d.dot(on_ray(near_x), BLUE, 5)
    d.label((near_x + 0.1, on_ray(near_x)[1] + 0.25), "pixel (x, y)", BLUE, "start", "above")
    d.arrow((eye[0], 0.9), (hit[0], 0.9), GREEN, 1.5, both=True)
    d.line((hit[0], 0.8), hit, GREEN, 1, "3 4")
    d.line((eye[0], 0.8), eye, GREEN, 1, "3 4")
    d.label((4.4, 0.9), "t", GREEN, place="above", bold=True)
    d.dot(hit, RED, 5)
    d.label((hit[0] + 0.2, hit[1] - 0.1), "p: depth z", RED, "start", "below", bold=True)
    d.dot(eye, INK, 6)
    d.label((eye[0], eye[1] + 0.2), "eye", INK, place="above")
    return d


def depth_range():
    """Steps of depth with the planes of the camera, and with planes next to the scene."""
    d = Drawing("Steps of depth from a near plane at the eye are wide at the scene far away; between two planes next to the "
                "scene they are fine", 0, 0, 12.4, 5.0)
    for y, steps, name, color in ((3.3, (1.9, 2.5, 3.5, 5.2, 8.0, 11.6), "planes as the file has them", RED),
                                  (0.9, [9.0 + 0.13 * i for i in range(17)], "planes next to the scene", GREEN)):
        d.box((9.3, y + 0.1), (10.8, y + 1.1), GREY, LIGHT)
        d.label((10.05, y + 0.6), "scene", INK)
        d.line((0.9, y), (12.0, y), GREY, 1)
        d.dot((0.9, y), INK, 6)
        d.label((0.9, y + 0.2), "eye", INK, place="above")
        for x in steps:
            d.line((x, y - 0.15), (x, y + 0.15), color, 1.5)
        d.label((1.6, y + 0.75), name, color, "start")
    d.label((1.9, 3.05), "near", RED, place="below")
    d.label((11.6, 3.05), "far", RED, place="below")
    d.label((8.9, 0.65), "near", GREEN, "end", "below")
    d.label((11.2, 0.65), "far", GREEN, "start", "below")
    d.label((6.6, 3.05), "one step: t² Δz / z_{near}", RED, place="below")
    return d
