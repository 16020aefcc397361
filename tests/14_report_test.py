#!/usr/bin/env python3
"""The report of chapter 14: its analysis on data whose answers are known, its page, and a quick run from end to end.

Usage: 14_report_test.py [FOLDER OF THE PROGRAMS]; without it the run is left out.
"""
import csv
import json
import math
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parent.parent
TOOLS = ROOT / "tools"
sys.path.insert(0, str(TOOLS))
from report_analysis import Report, fit_power, pareto_front  # noqa: E402
from report_answers import Answers  # noqa: E402
from report_measure import Failed, parameters_by_name, timed_trace, times_of  # noqa: E402
from report_plan import CORE_SCENES, GRID, SWEEPS, fitting, make_plan, rows_of  # noqa: E402

BIN = None
DEFAULTS = {"voxels": "128", "cones": "16", "interleave": "on", "aperture": "0", "step": "1", "start_offset": "0.75", "walk": "leap",
            "gather_scale": "2", "links": "5", "directions": "per_face", "format": "rgba16f", "bounces": "-1", "shadows": "map",
            "light_radius": "0.05", "light_angle": "0.53"}


class ParetoFront(unittest.TestCase):
    def test_drops_what_is_beaten(self):
        points = [(4.0, 1.0), (1.0, 4.0), (2.0, 2.0), (3.0, 2.0), (2.5, 3.0), (5.0, 1.0), (6.0, 0.5)]
        self.assertEqual(pareto_front(points), [1, 2, 0, 6])

    def test_agrees_with_the_definition(self):
        points = [((37 * i) % 101, (53 * i) % 97) for i in range(200)]
        front = set(pareto_front(points))
        for i, (t, e) in enumerate(points):
            beaten = any(a <= t and b <= e and (a < t or b < e) for a, b in points)
            first = points.index((t, e)) == i
            self.assertEqual(i in front, first and not beaten, (t, e))

    def test_one_point_and_none(self):
        self.assertEqual(pareto_front([(1.0, 1.0)]), [0])
        self.assertEqual(pareto_front([]), [])


class FitPower(unittest.TestCase):
    def test_finds_a_law(self):
        slope, c = fit_power([(n, 3.0 * n ** -0.7) for n in (32, 64, 128, 256)])
        self.assertAlmostEqual(slope, -0.7)
        self.assertAlmostEqual(c, 3.0)

    def test_needs_two_sizes(self):
        self.assertIsNone(fit_power([(32, 1.0), (32, 2.0)]))


class PlanOfRows(unittest.TestCase):
    def test_a_setting_that_is_the_default_is_the_baseline(self):
        rows = rows_of("cornell_box", SWEEPS, [], DEFAULTS)
        self.assertEqual([r.setting for r in rows].count("baseline"), 1)
        self.assertEqual(set(rows[0].sweeps), set(SWEEPS) - {"step", "directions"})  # which are of cones that march
        march = next(r for r in rows if r.setting == "walk=march")
        self.assertEqual(set(march.sweeps), {"walk", "step", "directions"})
        self.assertEqual(len({r.id for r in rows}), len(rows))
        moved = rows_of("cornell_box", SWEEPS, [], {**DEFAULTS, "links": "9", "voxels": "100"})
        self.assertIn("links=5", [r.setting for r in moved])
        self.assertIn("voxels=128", [r.setting for r in moved])

    def test_only_parts_that_can_change_are_compared(self):
        rows = {r.setting: r for r in rows_of("cornell_box", SWEEPS, [], DEFAULTS)}
        self.assertNotIn("direct", rows["links=1"].parts())
        self.assertEqual(rows["shadows=volume"].parts(), ["final", "direct"])
        self.assertEqual(rows["gather_scale=4"].parts(), ["final", "indirect_diffuse"])

    def test_every_scene_and_sweep_is_there(self):
        plan = make_plan(False, None, DEFAULTS, None)
        self.assertEqual(plan.scenes, CORE_SCENES)
        for scene in CORE_SCENES:
            for sweep in SWEEPS:
                self.assertTrue(any(r.scene == scene and sweep in r.sweeps for r in plan.rows), (scene, sweep))

    def test_rows_that_do_not_fit_are_left_out(self):
        rows = rows_of("cornell_box", SWEEPS, GRID, DEFAULTS)
        self.assertEqual(fitting(rows, 1e9, 3, 1000.0), (rows, []))
        total = sum(r.expected_seconds(3, 1000.0) for r in rows)
        kept, left_out = fitting(rows, 0.8 * total, 3, 1000.0)
        self.assertLessEqual(sum(r.expected_seconds(3, 1000.0) for r in kept), 0.8 * total)
        self.assertEqual({r.id for r in kept} | {r.id for r in left_out}, {r.id for r in rows})
        self.assertTrue(all(r.sweeps == ["grid"] for r in left_out[:2]))
        self.assertTrue({"baseline", "walk=march", "bounces=2"} <= {r.setting for r in kept})
        self.assertEqual([r.setting for r in fitting(rows, 0.0, 3, 1000.0)[0]], ["baseline"])

    def test_an_unknown_scene_is_refused(self):
        with self.assertRaisesRegex(ValueError, "atlantis"):
            make_plan(True, ["atlantis"], DEFAULTS, None)


class ReadingPrograms(unittest.TestCase):
    def test_passes_go_where_they_belong(self):
        stats = {"passes": [{"name": n, "scope": s, "min_ms": ms} for n, s, ms in
                            [("shadow maps", "light", 1), ("voxelize", "scene", 2), ("links", "scene", 4), ("light pyramid", "light", 8),
                             ("diffuse cones", "camera", 16)]]}
        times = times_of(stats)
        self.assertEqual([times[k] for k in ("ms_scene", "ms_light", "ms_camera", "ms_frame", "ms_total")], [6, 9, 16, 25, 31])

    def test_times_of_a_trace(self):
        self.assertEqual(timed_trace("a.exr: final, shared, 8x8, 12 samples per pixel, -1 bounces, 0.500 s for the samples, 0.526 s in all\n"),
                         (12, 0.5, 0.526))
        with self.assertRaises(Failed):
            timed_trace("nothing")

    def test_defaults(self):
        self.assertEqual(parameters_by_name("voxels   128   4 .. 512  voxels\nstep  1  0 .. 4  -\n"), {"voxels": "128", "step": "1"})


def measures(smape, noisy=False):
    return {"smape": smape, "signed_ratio": 1.0, "p95": 0.1, "noise": 0.05 * smape, "noisy": noisy}


def synthetic(scenes, traced=()):
    """Data: {scene: {setting: (ms, error)}}; the first setting is the baseline. `traced`: of the first scene's baseline,
    (factor, share, error)."""
    rows = []
    for scene, settings in scenes.items():
        base = next(iter(settings.values()))[0]
        rows += [{"id": f"{scene}/{name}", "kind": "cones", "scene": scene, "size": "8x8", "setting": name, "sweeps": ["links"],
                  "sweep_values": {"links": name}, "parameters": {"voxels": "64"}, "ms_steady": ms, "ms_frame": ms, "ms_scene": 1,
                  "ms_total": ms + 1, "relative_time": ms / base, "steps": 10, "fetches": 5, "bytes": 1e6,
                  "errors": {"final": measures(e), "final_pixels": measures(e)}} for name, (ms, e) in settings.items()]
    scene = next(iter(scenes))
    rows += [{"id": f"{scene}/traced {i}", "kind": "path_tracer", "scene": scene, "size": "8x8", "equal_to": f"{scene}/baseline",
              "factor": f, "share": share, "spp": 1, "ms_total": 1, "errors": {"final": measures(e, True), "final_pixels": measures(2 * e)}}
             for i, (f, share, e) in enumerate(traced)]
    names = list(dict.fromkeys(name for settings in scenes.values() for name in settings))
    return {"rows": rows, "core_scenes": list(scenes), "sweep_order": {"links": names}, "machine": {"driver": "llvmpipe"},
            "baseline": {}, "size": "8x8"}


class AnswersOfKnownData(unittest.TestCase):
    DATA = synthetic({"box": {"baseline": (100, 0.20), "a=1": (50, 0.40), "b=1": (200, 0.21), "c=1": (150, 0.09), "d=1": (80, 0.205)}},
                     [(1, False, 0.3), (1, True, 0.1), (4, False, 0.15), (4, True, 0.05)])

    def test_front_and_budgets(self):
        report = Report(self.DATA)
        self.assertEqual([s["setting"] for s in report.front()], ["a=1", "d=1", "baseline", "c=1"])
        self.assertIsNone(report.within(49))
        self.assertEqual(report.within(99)["setting"], "d=1")
        self.assertEqual(report.within(1000)["setting"], "c=1")
        self.assertEqual([(a["setting"], b["setting"]) for a, b in report.halvings()], [("a=1", "baseline"), ("baseline", "c=1")])
        self.assertEqual([s["setting"] for s in report.not_worth()], ["b=1"])
        self.assertEqual([s["setting"] for s in report.bargains()], ["d=1"])

    def test_words_follow_the_data(self):
        answers = Answers(self.DATA)
        self.assertIn("nothing fits", answers.budget(10))
        self.assertIn("`a=1`", answers.budget(10))
        self.assertIn("5.00 times the budget", answers.budget(10))
        self.assertIn("`c=1`", answers.budget(1000))
        self.assertIn("2.00 times the time", answers.half_the_error())
        self.assertIn("are on the front", answers.defaults_on_front())
        self.assertIn("`b=1`", answers.not_worth())
        self.assertNotIn("`d=1`", answers.not_worth())
        worse = Answers(synthetic({"box": {"baseline": (100, 0.2), "a=1": (90, 0.1)}}))
        self.assertIn("not on the front", worse.defaults_on_front())

    def test_the_path_tracer_gets_what_is_its_due(self):
        said = Answers(self.DATA).conclusion_path_tracer()
        self.assertIn("in 1 of 1 cases, and in 0 of 1 when", said)
        self.assertIn("it is 0 and 0", said)
        self.assertIn("2.00 to 2.00 times its error", said)

    def test_noise_is_said(self):
        answers = Answers(self.DATA)
        self.assertIn("In 4 of 9 comparisons", answers.noise())
        self.assertIn("0.300†", answers.path_tracer_table())
        self.assertNotIn("0.200†", answers.path_tracer_table())

    def test_a_row_of_easy_scenes_does_not_look_better(self):
        # `n=9` is no better than the baseline, and only the easy scene has it: the mean of the errors alone would fall by half.
        answers = Answers(synthetic({"hard": {"baseline": (100, 0.4), "n=1": (50, 0.8)},
                                     "easy": {"baseline": (10, 0.1), "n=1": (5, 0.1), "n=9": (20, 0.1)}}))
        lines = {line.split("|")[1].strip(): [c.strip() for c in line.split("|")[2:-1]]
                 for line in answers.sweep_table("links").splitlines() if line.startswith("| ")}
        self.assertEqual(lines["n=9"][:2] + lines["n=9"][5:], ["1", "2.00", "1.00", "1.00"])
        self.assertEqual(lines["n=1"][:2] + lines["n=1"][5:], ["2", "0.50", "1.41", "2.00"])


class Page(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "docs").mkdir()
        shutil.copy(ROOT / "docs" / "14_speed_against_error.md", self.root / "docs")
        shutil.copytree(ROOT / "docs" / "data", self.root / "docs" / "data")
        self.page = self.root / "docs" / "14_speed_against_error.md"
        self.data = self.root / "docs" / "data" / "report.json"

    def check(self):
        result = subprocess.run([sys.executable, str(TOOLS / "report_page.py"), "--check", "--root", str(self.root)],
                                capture_output=True, text=True)
        return result.returncode, result.stdout + result.stderr

    def test_holds_the_data(self):
        self.assertEqual(self.check()[0], 0, self.check()[1])

    def test_changed_data_are_found(self):
        data = json.loads(self.data.read_text())
        next(r for r in data["rows"] if r["kind"] == "cones")["errors"]["final"]["smape"] += 0.01
        self.data.write_text(json.dumps(data))
        code, said = self.check()
        self.assertEqual(code, 1)
        self.assertIn("is not what docs/data/report.json gives", said)

    def test_an_edited_number_is_found(self):
        text = self.page.read_text()
        self.page.write_text(text.replace("<!-- data: row_count() -->", "<!-- data: row_count() -->9", 1))
        self.assertEqual(self.check()[0], 1)

    def test_a_typed_number_is_found(self):
        self.page.write_text(self.page.read_text() + "\nIt takes 12 ms.\n")
        code, said = self.check()
        self.assertEqual(code, 1)
        self.assertIn("not made from the data", said)

    def test_writing_repairs(self):
        data = json.loads(self.data.read_text())
        data["seconds"] += 3600
        self.data.write_text(json.dumps(data))
        self.assertEqual(self.check()[0], 1)
        subprocess.run([sys.executable, str(TOOLS / "report_page.py"), "--write", "--root", str(self.root)], check=True,
                       capture_output=True)
        self.assertEqual(self.check()[0], 0)


class QuickRun(unittest.TestCase):
    def test_all_rows_are_finite(self):
        if BIN is None:
            self.skipTest("no folder of programs was given")
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([sys.executable, str(TOOLS / "report.py"), "--quick", "--no-figures", "--bin", BIN,
                                     "--output", folder], capture_output=True, text=True)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            data = json.loads((Path(folder) / "report.json").read_text())
            with open(Path(folder) / "report.csv", newline="") as file:
                table = list(csv.DictReader(file))
        self.assertEqual([r["id"] for r in table], [r["id"] for r in data["rows"]])
        planned = make_plan(True, None, data["baseline"], None)
        measured = {r["id"] for r in data["rows"] if r["kind"] == "cones"}
        self.assertEqual(measured, {r.id for r in planned.rows})
        for kind in ("drift", "path_tracer"):
            self.assertTrue(any(r["kind"] == kind for r in data["rows"]), kind)

        def check(value, where):
            if isinstance(value, dict):
                for name, inner in value.items():
                    check(inner, f"{where}/{name}")
            elif isinstance(value, float):
                self.assertTrue(math.isfinite(value), where)
        for row in data["rows"]:
            check(row, row["id"])
            self.assertGreater(row["ms_total"], 0.0, row["id"])
            self.assertIn("./run", row["command"])
            if row["kind"] == "cones":
                self.assertTrue(0.0 < row["errors"]["final"]["smape"] < 1.0, row["id"])
                self.assertEqual(row["steps"] + row["fetches"] > 0.0, row["parameters"]["bounces"] != "0", row["id"])
                self.assertEqual(set(row["scopes"].values()), {"scene", "light", "camera"}, row["id"])
        # What a report must show, whatever the machine: light that is left out is an error.
        report = Report(data)
        for scene in report.scenes:
            none, some = report.row(scene, "bounces=0"), report.row(scene)
            self.assertGreater(none["errors"]["final"]["smape"], 1.5 * some["errors"]["final"]["smape"])
            self.assertLess(none["errors"]["final"]["signed_ratio"], some["errors"]["final"]["signed_ratio"])
        # Each scene and the large row against the path tracer: twice the time classes, alone and sharing.
        self.assertEqual([len(t) for _, t in report.against_path_tracer()], [4] * (len(report.scenes) + 1))
        self.assertTrue(data["published"])
        for name in dir(Answers):
            if name in ("budget", "sweep_table", "sweep_figure", "command") or name.startswith("_"):
                continue
            getattr(Answers(data), name)()  # every sentence can be made of these data


if __name__ == "__main__":
    if len(sys.argv) > 1 and not sys.argv[1].startswith("-"):
        BIN = sys.argv.pop(1)
    unittest.main()
