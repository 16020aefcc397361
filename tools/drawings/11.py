"""Drawings of docs/11_emissives.md."""
from drawing import BLUE, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing


def ratio():
    """Exact light times the share of it that rays find to arrive, at three points under a lamp and behind a block."""
    d = Drawing("Three points below a lamp: rays to parts of it say which share of the exact light arrives", -0.4, -1.2, 15.4, 5.4)
    parts = [(3.2 + 0.8 * i, 4.6) for i in range(6)]
    d.box((2.8, 4.6), (7.6, 4.85), ORANGE, PALE[ORANGE], 1.5)
    for p in parts:
        d.dot(p, ORANGE, 5)
    d.label((5.2, 4.95), "lamp, 6 of its parts", ORANGE, place="above")
    d.line((-0.2, 0.4), (13.2, 0.4), INK, 2.5)
    block = (7.2, 10.2, 1.8, 2.3)  # x0, x1, y0, y1
    d.box((block[0], block[2]), (block[1], block[3]), INK, LIGHT, 2)
    for x, rays in ((2.2, (0, 2, 4)), (7.5, (0, 2, 5)), (10.5, (1, 3, 5))):
        reached = 0
        for i in rays:
            q, p = parts[i], (x, 0.4)
            at = lambda y: p[0] + (q[0] - p[0]) * (y - p[1]) / (q[1] - p[1])
            low, high = sorted((at(block[2]), at(block[3])))
            if high < block[0] or low > block[1]:
                d.line(p, q, BLUE, 1.5)
                reached += 1
                continue
            # where the ray enters the block: through its lower side, or its left or right one
            y = block[2] if block[0] <= at(block[2]) <= block[1] else \
                p[1] + (q[1] - p[1]) * ((block[1] if at(block[2]) > block[1] else block[0]) - p[0]) / (q[0] - p[0])
            d.line(p, (at(y), y), RED, 1.5)
            d.line((at(y), y), q, RED, 1, "3 5")
        d.dot((x, 0.4), INK, 5)
        word = {3: "all arrive:\nS / U = 1, the light\nis exact", 0: "none arrives:\nS / U = 0, dark"}.get(
            reached, f"{reached} of 3 arrive:\nS / U is about {reached}/3")
        d.label((x, 0.2), word, INK, place="below", size=14)
    d.label((9.0, 2.9), "a block", INK, size=14)
    d.label((10.9, 3.9), "blue: reaches the part\nred: is stopped\nneighbours ask other parts", GREY, "start", size=13)
    return d
