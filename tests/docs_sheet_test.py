#!/usr/bin/env python3
"""The sheet tool averages in linear light, cuts out and arranges as it says. Usage: docs_sheet_test.py SHEET

PNG files are written and read here with zlib alone, so that the tool is not compared with itself.
"""
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib
from pathlib import Path


def write_png(path, rows):
    """rows: lists of (r, g, b)."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    raw = b"".join(b"\0" + bytes(v for pixel in row for v in pixel) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(raw)) +
                     chunk(b"IEND", b""))


def read_png(path):
    """Rows of (r, g, b); 8 bit RGB or RGBA, not interlaced."""
    data, position, pixels = path.read_bytes(), 8, b""
    while position < len(data):
        length, kind = struct.unpack(">I4s", data[position:position + 8])
        body = data[position + 8:position + 8 + length]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", body[:10])
            assert depth == 8 and color in (2, 6)
            step = 3 if color == 2 else 4
        elif kind == b"IDAT":
            pixels += body
        position += 12 + length
    pixels, stride = zlib.decompress(pixels), width * step
    previous, rows = bytearray(stride), []
    for y in range(height):
        kind, row = pixels[y * (stride + 1)], bytearray(pixels[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):  # PNG specification, section 9
            a = row[i - step] if i >= step else 0
            b = previous[i]
            c = previous[i - step] if i >= step else 0
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, nearest)[kind]) & 255
        rows.append([tuple(row[i:i + 3]) for i in range(0, stride, step)])
        previous = row
    return rows


def srgb(linear):
    """The byte for linear light above 0.0031308 (IEC 61966-2-1)."""
    return round(255 * (1.055 * linear ** (1 / 2.4) - 0.055))


class Sheet(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def sheet(self, pictures, *options, code=0):
        names = [self.folder / f"{i}.png" for i in range(len(pictures))]
        for name, rows in zip(names, pictures):
            write_png(name, rows)
        out = self.folder / "out.png"
        result = subprocess.run([SHEET, "--output", out, *options, *names], capture_output=True, text=True)
        self.assertEqual(result.returncode, code, result.stderr)
        if code:
            self.assertFalse(out.exists())
            return result.stderr
        return read_png(out)

    def test_a_picture_alone_stays_as_it_is(self):
        rows = [[(x * 25, y * 60, (x * y) % 256) for x in range(10)] for y in range(4)]
        self.assertEqual(self.sheet([rows]), rows)

    def test_pictures_are_averaged_in_linear_light(self):
        checkerboard = [[(255,) * 3 if (x + y) % 2 else (0,) * 3 for x in range(8)] for y in range(8)]
        # half of white's light is sRGB 188; averaged bytes would be 128
        self.assertEqual(self.sheet([checkerboard], "--width", "4"), [[(srgb(1 / 2),) * 3] * 4] * 4)

    def test_scaling_by_a_fraction_weighs_by_area(self):
        # 3 pixels to 2: the first covers all of pixel 0 and half of pixel 1, so 2/3 of white
        rows = [[(255,) * 3, (0,) * 3, (0,) * 3]] * 3
        self.assertEqual([row[0][0] for row in self.sheet([rows], "--width", "2")], [srgb(2 / 3)] * 2)

    def test_crop_and_arrangement(self):
        red = [[(255, 0, 0) if x >= 2 and y >= 1 else (9, 9, 9) for x in range(4)] for y in range(3)]
        blue = [[(0, 0, 255)] * 4 for _ in range(3)]
        rows = self.sheet([red, blue, red], "--columns", "2", "--gap", "1", "--crop", "2,1,2,2")
        white, r, b = (255, 255, 255), (255, 0, 0), (0, 0, 255)
        self.assertEqual(rows, [[r, r, white, b, b]] * 2 + [[white] * 5] + [[r, r, white, white, white]] * 2)

    def test_radiance_is_tone_mapped_as_the_programs_do_it(self):
        for extension in ("png", "exr"):
            subprocess.run([SHEET.parent / "01_first_light", "--headless", "--size", "64x64", "--output",
                            self.folder / f"picture.{extension}"], check=True)
        subprocess.run([SHEET, "--output", self.folder / "out.png", self.folder / "picture.exr"], check=True)
        shown, expected = read_png(self.folder / "out.png"), read_png(self.folder / "picture.png")
        differences = [abs(a - b) for row, other in zip(shown, expected) for p, q in zip(row, other) for a, b in zip(p, q)]
        self.assertEqual(len(differences), 64 * 64 * 3)
        self.assertLessEqual(max(differences), 1)  # the two compute powers differently: rounding to bytes may differ by one
        self.assertGreater(max(max(pixel) for row in expected for pixel in row), 100)  # not a black picture

    def test_labels_stand_above_their_pictures(self):
        grey = [[(90, 90, 90)] * 60 for _ in range(5)]
        alone = self.sheet([grey])
        rows = self.sheet([grey, grey], "--gap", "2", "--label", "lit", "--label", "I")
        self.assertEqual([row[:60] for row in rows[-5:]], alone)  # the picture stays as it is
        self.assertEqual({pixel for row in rows[:-5] for pixel in row}, {(0, 0, 0), (255, 255, 255)})
        ink = [sum(row[x] == (0, 0, 0) for row in rows[:-5] for x in part) for part in (range(60), range(62, 122))]
        self.assertGreater(ink[0], ink[1])  # three letters, one letter
        self.assertGreater(ink[1], 0)

    def test_the_colour_bar_has_the_colours_of_the_programs(self):
        grey = [[(90, 90, 90)] * 201 for _ in range(5)]
        # shares of white as bytes; counts as linear light (shaders/common/color_scales.glsl, 2 and 4 of 1 .. 16);
        # differences at -1, 0, 1 times their full colour
        expected = {"grey": {0.2: (51,) * 3, 0.5: (128,) * 3}, "heat": {0.25: (191, 0, 0), 0.5: (255, 128, 0)},
                    "counts": {0.25: [srgb(c) for c in (0.05, 0.25, 0.9)], 0.5: [srgb(c) for c in (0.1, 0.8, 0.2)]},
                    "difference": {0.25: (0, 115, 255), 0.5: (0, 0, 0), 0.75: (255, 89, 0)}}
        for colors, places in expected.items():
            rows = self.sheet([grey], "--scale", colors, "--unit", "m")
            bar = rows[5 + 8 + 9]  # below the picture and the gap, in the middle of the bar
            for place, color in places.items():
                found = bar[round(place * 200)]
                self.assertLessEqual(max(abs(a - b) for a, b in zip(found, color)), 1, (colors, place, found))
            self.assertGreater(sum(pixel == (0, 0, 0) for row in rows[5 + 8 + 18:] for pixel in row), 50)  # numbers, unit

    def test_text_that_does_not_fit_is_refused(self):
        picture = [[(0, 0, 0)] * 40] * 4
        self.assertIn("'a long label' is wider than its picture of 40 pixels",
                      self.sheet([picture], "--label", "a long label", code=1))
        self.assertIn("1 labels for 2 pictures", self.sheet([picture, picture], "--label", "a", code=1))
        self.assertIn("only ASCII can be written", self.sheet([picture], "--label", "\u00b2", code=1))

    def test_a_crop_outside_is_refused(self):
        message = self.sheet([[[(0, 0, 0)] * 4] * 4], "--crop", "2,2,3,1", code=1)
        self.assertEqual(len(message.splitlines()), 1, message)
        self.assertIn("0.png: the crop lies outside the picture of 4x4", message)


if __name__ == "__main__":
    SHEET = Path(sys.argv.pop(1)).resolve()  # the programs are beside it
    unittest.main()
