"""A drawing in SVG: lines, arrows, boxes, curves and labels in the coordinates of what is drawn, y up.

Lengths are in the drawing's own unit, widths of lines and sizes of text in pixels. Elements are painted in the order in
which they are added. The text of an SVG depends on its calls alone: the same on every machine.
"""
import math
import re
from xml.sax.saxutils import escape

# One palette for all pages. Colour never carries a meaning alone: what is drawn with it has a label.
INK, GREY, LIGHT = "#222222", "#888888", "#e4e4e4"     # outlines and text, helping lines, filled solids
BLUE, ORANGE, GREEN, RED = "#1f6fb4", "#d9730d", "#2e8540", "#c22f2f"
PALE = {BLUE: "#dbe9f5", ORANGE: "#fbe6d1", GREEN: "#dcefdf", RED: "#f7dede", GREY: LIGHT, INK: LIGHT}  # for areas

TEXT_SIZE = 15  # pixels
BASELINES = {"below": 1.0, "center": 0.35, "above": -0.35}  # from the point to the baseline, in text sizes
SUBSCRIPT = re.compile(r"_(\{[^}]*\}|[A-Za-z0-9])")


def number(value):
    """At most two digits after the point: a hundredth of a pixel, whatever the machine's last bits are."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


class Drawing:
    """A picture of x0..x1 by y0..y1 units, `scale` pixels to a unit. `title` says what is to be seen."""

    def __init__(self, title, x0, y0, x1, y1, scale=50):
        self.title, self.x0, self.y1, self.scale = title, x0, y1, scale
        self.width, self.height = (x1 - x0) * scale, (y1 - y0) * scale
        self.elements = []

    def pixel(self, point):
        return (point[0] - self.x0) * self.scale, (self.y1 - point[1]) * self.scale

    def add(self, name, text=None, **attributes):
        """An element by its SVG name; _ in names of attributes stands for -, None leaves one out."""
        words = [name] + [f'{key.replace("_", "-")}="{number(value) if isinstance(value, (int, float)) else value}"'
                          for key, value in attributes.items() if value is not None]
        self.elements.append(f'<{" ".join(words)}/>' if text is None else f'<{" ".join(words)}>{text}</{name}>')

    def path(self, points, color=INK, width=1.5, dashes=None, fill="none", closed=False):
        """A line through the points; dashes: lengths of dash and gap in pixels, '6 4'."""
        pixels = [" ".join(map(number, self.pixel(point))) for point in points]
        self.add("path", d="M" + " L".join(pixels) + (" Z" if closed else ""), fill=fill, stroke=color,
                 stroke_width=width, stroke_dasharray=dashes, stroke_linejoin="round", stroke_linecap="round")

    def line(self, a, b, color=INK, width=1.5, dashes=None):
        self.path([a, b], color, width, dashes)

    def polygon(self, points, color=INK, fill=LIGHT, width=1.5):
        self.path(points, color, width, None, fill, closed=True)

    def box(self, a, b, color=INK, fill="none", width=1.5):
        """A rectangle along the axes; a and b are two opposite corners."""
        self.polygon([a, (b[0], a[1]), b, (a[0], b[1])], color, fill, width)

    def circle(self, center, radius, color=INK, fill="none", width=1.5):
        """radius in units."""
        x, y = self.pixel(center)
        self.add("circle", cx=x, cy=y, r=radius * self.scale, fill=fill, stroke=color, stroke_width=width)

    def dot(self, center, color=INK, radius=4):
        """A filled point; radius in pixels."""
        x, y = self.pixel(center)
        self.add("circle", cx=x, cy=y, r=radius, fill=color)

    def arc(self, center, radius, begin, end, color=INK, width=1.5, dashes=None):
        """From angle to angle (degrees, counter-clockwise from +x); radius in units."""
        steps = max(2, math.ceil(abs(end - begin) / 4))
        angles = [math.radians(begin + (end - begin) * i / steps) for i in range(steps + 1)]
        self.path([(center[0] + radius * math.cos(a), center[1] + radius * math.sin(a)) for a in angles], color, width,
                  dashes)

    def arrow(self, a, b, color=INK, width=1.5, both=False, dashes=None, head=10):
        """A line from a to b with its head at b, or at both ends; head: its length in pixels."""
        (ax, ay), (bx, by) = self.pixel(a), self.pixel(b)
        length = math.hypot(bx - ax, by - ay)
        ux, uy = (bx - ax) / length, (by - ay) / length
        stop = 0.8 * head / self.scale  # the line ends inside the head, whose tip stays sharp

        def tip(x, y, ux, uy):
            wings = [(x, y)] + [(x - head * ux - side * head * uy, y - head * uy + side * head * ux)
                                for side in (0.4, -0.4)]
            self.add("path", d="M" + " L".join(f"{number(px)} {number(py)}" for px, py in wings) + " Z", fill=color)

        def inner(point, sign):
            return point[0] + sign * stop * ux, point[1] - sign * stop * uy

        self.line(inner(a, 1) if both else a, inner(b, -1), color, width, dashes)
        tip(bx, by, ux, uy)
        if both:
            tip(ax, ay, -ux, -uy)

    def label(self, point, text, color=INK, anchor="middle", place="center", size=TEXT_SIZE, bold=False):
        """Text at a point. anchor: start, middle, end (which end of the text is there); place: above, center, below.

        `x_i` and `x_{near}` make a subscript; `\\n` begins a new line. A white rim keeps it readable on lines.
        """
        x, y = self.pixel(point)
        lines = text.split("\n")
        first = {"below": 0.0, "center": (1 - len(lines)) / 2, "above": 1 - len(lines)}[place]
        for i, line in enumerate(lines):
            small = number(0.75 * size)
            shifted = SUBSCRIPT.sub(lambda m: f'<tspan dy="{number(0.25 * size)}" font-size="{small}">'
                                    f'{m[1].strip("{}")}</tspan>\0', escape(line))
            # the way back up goes to what follows; an empty span would not move anything
            shifted = re.sub(r"\0([^<\0]+)", lambda m: f'<tspan dy="{number(-0.25 * size)}">{m[1]}</tspan>', shifted)
            self.add("text", shifted.replace("\0", ""), x=x, y=y + size * (BASELINES[place] + 1.2 * (first + i)),
                     fill=color, font_size=size, text_anchor=anchor, font_weight="bold" if bold else None,
                     stroke="#ffffff", stroke_width=3, paint_order="stroke")

    def svg(self):
        head = (f'<svg xmlns="http://www.w3.org/2000/svg" width="{number(self.width)}" height="{number(self.height)}" '
                f'viewBox="0 0 {number(self.width)} {number(self.height)}" font-family="sans-serif">')
        return "\n".join([head, f"<title>{escape(self.title)}</title>", '<rect width="100%" height="100%" fill="#ffffff"/>',
                          *self.elements, "</svg>", ""])
