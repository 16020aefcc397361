"""Drawings of docs/16_only_what_is_needed.md."""
from drawing import BLUE, GREEN, GREY, INK, LIGHT, ORANGE, PALE, RED, Drawing

# What reads what: place, name, and what it reads.
_PARTS = {
    "lights": ((0.2, 6.0), "lights", []),
    "maps": ((3.2, 6.0), "shadow maps", ["lights"]),
    "triangles": ((0.2, 4.0), "triangles", []),
    "voxels": ((3.2, 4.0), "light in voxels", ["triangles", "maps"]),
    "links": ((6.2, 5.0), "further bounces", ["voxels"]),
    "emission": ((6.2, 3.1), "emission pyramid", ["voxels"]),
    "pyramid": ((9.2, 4.0), "light pyramid", ["voxels", "links"]),
    "surfaces": ((9.2, 1.0), "g-buffer", ["triangles"]),
    "direct": ((12.2, 6.0), "direct light", ["maps", "surfaces"]),
    "diffuse": ((12.2, 4.0), "diffuse cones", ["pyramid", "surfaces"]),
    "aimed": ((12.2, 2.5), "emitters' light", ["emission", "surfaces"]),
    "specular": ((12.2, 1.0), "specular cones", ["pyramid", "surfaces"]),
    "picture": ((15.2, 4.0), "picture", ["direct", "diffuse", "aimed", "specular"]),
}
_SIZE = (2.4, 0.7)


def _graph(title, zero):
    """The parts; those that are zero in this scene, and those that nobody reads any more, are left out."""
    used, asks = set(), ["picture"]
    while asks:
        name = asks.pop()
        if name not in used and name not in zero:
            used.add(name)
            asks += _PARTS[name][2]
    d = Drawing(title, 0.0, 0.5, 17.8, 7.1, 50)
    for name, (place, _, reads) in _PARTS.items():
        for other in reads:
            begin = _PARTS[other][0]
            both = name in used and other in used
            d.arrow((begin[0] + _SIZE[0], begin[1] + 0.35), (place[0], place[1] + 0.35), INK if both else LIGHT,
                    1.4 if both else 1.0, head=8)
    for name, (place, text, _) in _PARTS.items():
        color = RED if name in zero else GREEN if name in used else GREY
        end = (place[0] + _SIZE[0], place[1] + _SIZE[1])
        d.box(place, end, color, PALE[color] if name in used or name in zero else "#ffffff", 1.6)
        d.label((place[0] + _SIZE[0] / 2, place[1] + _SIZE[1] / 2), text, INK if name in used else color, size=13)
        if name in zero:
            d.label((place[0] + _SIZE[0] / 2, place[1] - 0.03), "zero in this scene", RED, place="below", size=12)
    return d


def reads():
    """A Lambertian box with a lamp: nothing shines, no lobe."""
    return _graph("What each part of a frame reads; in a scene of Lambertian surfaces in which nothing shines, two parts are zero",
                  {"emission", "aimed", "specular"})


def choice():
    """Error over time: settings, the budget, and the one that is chosen."""
    d = Drawing("Of the settings that keep to the error the fastest is taken; of those within the time the most exact", -1.0, -1.0,
                11.0, 6.2)
    d.arrow((0, 0), (10.4, 0), INK, 1.5)
    d.arrow((0, 0), (0, 5.8), INK, 1.5)
    d.label((10.3, -0.15), "time", INK, "end", "below")
    d.label((-0.15, 5.7), "error", INK, "end")
    settings = [(0.9, 5.1), (1.4, 3.9), (2.0, 4.4), (2.3, 3.1), (3.1, 3.6), (3.6, 2.2), (4.4, 2.9), (5.2, 1.6), (6.1, 2.5), (6.6, 1.25),
                (7.6, 1.8), (8.6, 1.0), (9.4, 1.5)]
    error, time = 2.5, 7.0
    d.line((0, error), (10.2, error), ORANGE, 1.5, "6 4")
    d.label((10.2, error + 0.05), "the error", ORANGE, "end", "above")
    d.line((time, 0), (time, 5.6), BLUE, 1.5, "6 4")
    d.label((time + 0.1, 5.4), "the time", BLUE, "start")
    for x, y in settings:
        d.dot((x, y), GREY, 4)
    fastest = min(p for p in settings if p[1] <= error)
    exact = min((p for p in settings if p[0] <= time), key=lambda p: p[1])
    for (x, y), color, text in ((fastest, ORANGE, "the fastest\nthat is exact enough"), (exact, BLUE, "the most exact\nthat is fast enough")):
        d.circle((x, y), 0.18, color, "none", 2.5)
        d.label((x, y - 0.25), text, color, place="below", size=13)
    return d
