#!/usr/bin/env python3
"""./run roads: the parts of its page on data whose answers are known, and a quick run from end to end.

Usage: roads_test.py [FOLDER OF THE PROGRAMS]; without it the run is left out.
"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent
TOOLS = ROOT / "tools"
sys.path.insert(0, str(TOOLS))
from roads import METHODS, cost_of, page, table, words_of  # noqa: E402
from pages import chapters  # noqa: E402

BIN = None


def row(method, ms, smape, size=0):
    return {"method": method, "ms": ms, "smape": smape, "signed": 1.0, "bytes": size}


class Parts(unittest.TestCase):
    def test_cost_leaves_the_scene_out(self):
        stats = {"passes": [{"min_ms": 2.5}, {"min_ms": 4.0}],
                 "resources": [{"name": "scene geometry", "bytes": 1000}, {"name": "patches", "bytes": 70}]}
        self.assertEqual(cost_of(stats), (6.5, 70))

    def test_table_has_the_front_in_bold(self):
        lines = table([row("truth", 9e9, 0.0), row("a", 1000, 0.2, 2_000_000), row("b", 2000, 0.3), row("c", 3000, 0.1)]).split("\n")
        self.assertEqual(lines[2], "| **a** | 1.000 | 0.200 | 1.00 | 2.0 |")
        self.assertEqual(lines[3], "| b | 1.000 | 0.300 | 2.00 | - |")  # a is faster and nearer
        self.assertTrue(lines[4].startswith("| **c**"))
        self.assertEqual(len(lines), 5)  # the truth has no row

    def test_page_groups_by_scene(self):
        rows = [row("truth", 1, 0.0), row("a", 1, 0.1)]
        text = page({("box", 1): rows, ("box", -1): rows, ("room", 1): rows}, "roads", "64x64", True)
        self.assertEqual(text.count("## box\n"), 1)
        self.assertIn("### box, all bounces", text)
        self.assertIn("](roads/room_1.png)", text)
        self.assertIn("](roads/pareto.png)", text)

    def test_words(self):
        self.assertEqual([words_of(k) for k in (-1, 1, 2)], ["all bounces", "1 bounce", "2 bounces"])


class QuickRun(unittest.TestCase):
    def test_writes_page_sheet_and_numbers(self):
        if BIN is None:
            self.skipTest("no folder of the programs was given")
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([sys.executable, TOOLS / "roads.py", "--quick", "--bin", BIN, "--output", folder],
                                    capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            rows = json.loads((Path(folder) / "roads.json").read_text())
            own = [r for r in rows if r["method"][:2] in METHODS]
            self.assertEqual([r["method"][:2] for r in own], [c[:2] for c in chapters(ROOT) if c[:2] in METHODS])
            for r in own:
                self.assertGreater(r["ms"], 0.0)
                self.assertGreater(r["bytes"], 0)
                self.assertTrue(0.8 < r["signed"] < 1.25, r)  # of the whole picture
                self.assertLess(r["smape"], 0.2, r)
            page_text = (Path(folder) / "roads.md").read_text()
            for r in own:
                self.assertIn(r["method"], page_text)
            self.assertGreater((Path(folder) / "cornell_box_1.png").stat().st_size, 1000)

    def test_refuses_what_it_does_not_know(self):
        for wrong in (["--scenes", "nowhere"], ["--only", "99"]):
            result = subprocess.run([sys.executable, TOOLS / "roads.py", *wrong], capture_output=True, text=True)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(wrong[1], result.stderr)


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        BIN = sys.argv.pop(1)
    unittest.main()
