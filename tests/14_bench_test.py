#!/usr/bin/env python3
"""`./run bench`: exponents and rooflines of data whose answers are known, its scenes, and a quick run.

Usage: 14_bench_test.py [FOLDER OF THE PROGRAMS]; without it the run is left out.
"""
import json
import math
import struct
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
TOOLS = Path(__file__).resolve().parent.parent / "tools"
sys.path.insert(0, str(TOOLS))
import bench_scene  # noqa: E402
from bench import QUICK_BASE, QUICK_SERIES, as_page, cost_ns, exponents, growth, points_of, roofline_fraction  # noqa: E402

BIN = None
COSTS = [{"look_up": "texel r32ui", "bytes": 2e6, "ns": 2.0}, {"look_up": "texel r32ui", "bytes": 32e6, "ns": 6.0},
         {"look_up": "trilinear rgba16f", "bytes": 2e6, "ns": 10.0}, {"look_up": "trilinear rgba16f", "bytes": 32e6, "ns": 20.0}]


class Growth(unittest.TestCase):
    def test_exponents_of_a_law(self):
        self.assertEqual([round(p, 9) for p in exponents([(x, 3.0 * x**1.7) for x in (64, 96, 128, 256)])], [1.7, 1.7])

    def test_a_fixed_cost_hides_growth_and_the_end_shows_it(self):
        p, end = exponents([(x, 100.0 + x) for x in (1, 10, 100, 10_000, 100_000)])
        self.assertLess(p, 0.8)
        self.assertAlmostEqual(end, math.log10(100_100 / 10_100))

    def test_one_point_has_none(self):
        self.assertEqual(exponents([(1, 1)]), (None, None))

    def test_only_one_thing_grows(self):
        points = points_of(QUICK_BASE, QUICK_SERIES)
        self.assertEqual(len(points), 5)
        self.assertEqual(points[0], QUICK_BASE)
        rows = [{**p, "ms": {"cones": p["voxels"] * p["triangles"]}} for p in points]
        self.assertEqual(growth(rows, QUICK_BASE, "voxels"), {"cones": [(16, 3200), (32, 6400)]})
        self.assertEqual([x for x, _ in growth(rows, QUICK_BASE, "size")["cones"]], [48 * 27, 96 * 54])


class Roofline(unittest.TestCase):
    def test_cost_between_and_beyond_the_measured_sizes(self):
        self.assertEqual([cost_ns(COSTS, "texel r32ui", b) for b in (1e6, 2e6, 8e6, 32e6, 1e9)], [2, 2, 4, 6, 6])

    def test_fraction(self):
        row = {"size": "100x100", "points_per_pixel": 0.25, "steps": 100, "fetches": 10, "ms": {"diffuse cones": 2.0},
               "bytes": {"walk volume": 2e6, "light pyramid": 32e6}}
        self.assertAlmostEqual(roofline_fraction(row, COSTS), 2500 * (100 * 2.0 + 10 * 20.0) * 1e-6 / 2.0)
        self.assertIsNone(roofline_fraction({**row, "ms": {}}, COSTS))


class Scenes(unittest.TestCase):
    def test_triangles_are_near_what_was_asked_and_wind_towards_their_normals(self):
        for wanted in (100, 1_000, 10_000):
            positions, normals, indices = bench_scene.mesh(wanted)
            self.assertLess(abs(len(indices) / 3 / wanted - 1), 0.11)
            for i in range(0, len(indices), 3):
                p, q, r = (positions[k] for k in indices[i:i + 3])
                a, b = [q[k] - p[k] for k in range(3)], [r[k] - p[k] for k in range(3)]
                cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
                self.assertGreater(sum(c * n for c, n in zip(cross, normals[indices[i]])), 0)

    def test_lights_share_the_power(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "room.glb"
            bench_scene.write(file, 100, 16)
            data = file.read_bytes()
        self.assertEqual(struct.unpack("<4sII", data[:12]), (b"glTF", 2, len(data)))
        lights = json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])["extensions"]["KHR_lights_punctual"]["lights"]
        self.assertEqual(len(lights), 16)
        self.assertAlmostEqual(sum(light["intensity"] for light in lights), bench_scene.POWER)


class QuickRun(unittest.TestCase):
    def test_gives_a_table(self):
        if BIN is None:
            self.skipTest("no folder of programs was given")
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([sys.executable, str(TOOLS / "bench.py"), "--quick", "--no-figures", "--bin", BIN,
                                     "--output", folder], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            data = json.loads((Path(folder) / "bench.json").read_text())
            self.assertEqual((Path(folder) / "bench.md").read_text(), as_page(data))
        page = as_page(data)
        for one_pass in ("voxelize", "links", "diffuse cones", "composite"):
            self.assertEqual(page.count(f"\n| {one_pass} | "), len(QUICK_SERIES), one_pass)
        self.assertTrue(all(cost["ns"] > 0.0 for cost in data["costs"]))
        by_lights = {r["lights"]: r for r in data["rows"]}
        self.assertEqual(by_lights[4]["bytes"]["shadow maps"], 4 * by_lights[1]["bytes"]["shadow maps"])
        for row in data["rows"]:
            self.assertGreater(row["steps"], 0.0)
            self.assertGreater(roofline_fraction(row, data["costs"]), 0.0)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        BIN = sys.argv.pop(1)
    unittest.main()
