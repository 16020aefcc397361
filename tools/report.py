#!/usr/bin/env python3
"""Measure speed against error: many settings of the cones, and the path tracer, on several scenes.

Writes report.json, report.csv and figures into the output folder; with --publish also into docs/data, and the page
docs/14_speed_against_error.md anew. Run it on an idle machine: times are ratios to a baseline that runs again and
again, but a busy neighbour still shows.

References are kept in the output folder and used again by later runs, as are finished rows with --resume. A long
./run report --references-only --reference-minutes 60 beforehand makes the references better than a short run can.
"""
import argparse
import csv
import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

sys.dont_write_bytecode = True
from pages import ROOT  # noqa: E402
from report_analysis import Report, error  # noqa: E402
from report_measure import BLOCK, CHAPTER, NOISE_SHARE, Bench, Failed, counts_of, file_hash, machine, times_of  # noqa: E402
from report_plan import (CORE_SCENES, GRID, LARGE_SCENE, PARTS, QUICK_SWEEPS, SCENE_SWEEPS, SWEEPS, fitting,  # noqa: E402
                         make_plan)
import report_published  # noqa: E402

MEASURES = ["signed_ratio", "smape", "p95", "nrmse", "noise", "noisy", "flip"]
LADDER_S, LADDER_SPP = 15, 256  # a scene, about; samples a pixel
PUBLISHED_S = 70                # the experiments of the thesis on one scene, about
LARGE_REFERENCE_SHARE = 1.6     # of the time for references, over a scene's
ALL_SWEEPS = {**SWEEPS, **{name: values for sweeps in SCENE_SWEEPS.values() for name, values in sweeps.items()}}
SWEPT = {name for values in (*ALL_SWEEPS.values(), *QUICK_SWEEPS.values(), GRID) for s in values for name in s}


class Progress:
    """One line a row, with the time that has gone."""

    def __init__(self, started):
        self.started, self.done = started, 0

    def step(self, text):
        self.done += 1
        print(f"[{(time.monotonic() - self.started) / 60:5.1f} min] {text}", flush=True)


class Kept:
    """Finished rows, a line of JSON each, for --resume. A row belongs to the programs that measured it."""

    def __init__(self, file, bench, resume):
        self.programs = "".join(file_hash(bench.bin / p) for p in (CHAPTER, "reference", "compare"))
        self.file, self.rows = file, {}
        if resume and file.exists():
            for line in file.read_text().splitlines():
                row = json.loads(line)
                if row.pop("programs") == self.programs:
                    self.rows[row["id"], row["size"]] = row
        elif not resume:
            file.unlink(missing_ok=True)

    def find(self, row_id, size):
        return self.rows.get((row_id, size))

    def keep(self, row):
        with open(self.file, "a") as out:
            out.write(json.dumps({**row, "programs": self.programs}) + "\n")


class Measurement:
    """All rows. `deadline`: of time.monotonic(), by which it should be done; rows that do not fit are left out."""

    def __init__(self, bench, plan, defaults, started, deadline, kept):
        self.bench, self.plan, self.deadline, self.kept = bench, plan, deadline, kept
        self.defaults = {**defaults, **plan.base}
        self.rows, self.failed, self.left_out, self.published = [], [], [], []
        self.references = {}
        self.progress = Progress(started)

    def make_references(self, seconds):
        """`seconds`: for all of them."""
        wanted = [(scene, self.plan.size, 1.0) for scene in self.plan.scenes]
        if LARGE_SCENE in self.plan.scenes:
            wanted.append((LARGE_SCENE, self.plan.large_size, LARGE_REFERENCE_SHARE))
        for scene, size, share in wanted:
            reference = self.bench.make_reference(scene, size, seconds * share / sum(w[2] for w in wanted), self.plan.most_spp)
            self.references[f"{scene} {size}"] = {k: reference[k] for k in ("spp", "seconds", "command")}
            self.progress.step(f"reference of {scene}, {size}: {reference['spp']} samples a pixel")

    def errors(self, row, baseline, size):
        """Of every part against all bounces, by blocks; of the whole also by pixels."""
        found = {}
        reference = self.bench.reference(row.scene, size)
        for part in PARTS:
            if baseline and part not in row.parts():
                found[part] = baseline["errors"][part] and dict(baseline["errors"][part], same_as=baseline["id"])
            else:
                found[part] = self.bench.compare(self.bench.part_picture(row.scene, part), reference, part,
                                                 flip=part == "final" and baseline is None)
        found["final_pixels"] = self.bench.compare(self.bench.part_picture(row.scene, "final"), reference, block=1)
        return found

    def measure(self, row, baseline, size=None):
        size = size or self.plan.size
        known = self.kept.find(row.id, size)
        if known and baseline is not None:
            return known
        settings = {**self.plan.base, **row.settings}
        stats = self.bench.render(row.scene, settings, row.frames(self.plan.frames, baseline and baseline["times"][-1]), size)
        parameters = {**self.defaults, **row.settings}
        times = times_of(stats)
        made = {"id": row.id, "kind": "cones", "scene": row.scene, "size": size, "setting": row.setting, "sweeps": row.sweeps,
                "command": stats["command"], "parameters": {k: v for k, v in parameters.items() if k in SWEPT},
                **times, "relative_time": times["ms_frame"] / (baseline["times"][-1] if baseline else times["ms_frame"]),
                **counts_of(stats), "bytes": sum(r["bytes"] for r in stats["resources"]),
                "errors": self.errors(row, baseline, size), "driver": stats["driver"]}
        self.kept.keep(made)
        return made

    def choose(self, rows, scenes_left, baseline_ms):
        """What fits into this scene's share of the time that is left."""
        kept, left_out = fitting(rows, (self.deadline - time.monotonic()) / scenes_left, self.plan.frames, baseline_ms)
        for row in left_out:
            self.left_out.append(row.id)
            self.progress.step(f"{row.id} is left out: it would take about "
                               f"{row.expected_seconds(self.plan.frames, baseline_ms):.0f} s")
        return kept

    def run_scene(self, scene):
        rows = [r for r in self.plan.rows if r.scene == scene]
        first = self.measure(rows[0], None)
        first["times"] = [first["ms_frame"]]
        self.say(first)
        self.trace(first, self.plan.size)
        rows = self.choose(rows, len(self.plan.scenes) - self.plan.scenes.index(scene), first["ms_frame"])
        measured = [first]
        for i, row in enumerate(rows[1:], 1):
            if i % self.plan.drift_every == 0:
                stats = self.bench.render(scene, self.plan.base, rows[0].frames(self.plan.frames, first["times"][0]),
                                          count=False, parts=False)
                first["times"].append(times_of(stats)["ms_frame"])
                self.rows.append({"id": f"{scene}/drift {i}", "kind": "drift", "scene": scene, "setting": "baseline",
                                  "command": stats["command"], **times_of(stats)})
                self.progress.step(f"{scene}/baseline again: {first['times'][-1] / first['times'][0]:.3f} of its first time")
            try:
                measured.append(self.measure(row, first))
            except Failed as fault:  # the others are still worth having
                self.failed.append(row.id)
                self.progress.step(f"{row.id} failed: {fault}")
                continue
            self.say(measured[-1])
        # One time for the baseline, and all others as multiples of it: what drifts is the machine.
        times = sorted(first.pop("times"))
        for row in measured:
            row["ms_steady"] = row["relative_time"] * times[len(times) // 2]
        self.rows += measured

    def run_large(self):
        """One row with many pixels."""
        row = next(r for r in self.plan.rows if r.scene == LARGE_SCENE)
        measured = {**self.measure(row, None, self.plan.large_size), "kind": "large"}
        self.rows.append(measured)
        self.say(measured)
        self.trace(measured, self.plan.large_size)

    def trace(self, row, size):
        """The path tracer in the time of a frame of this row and in four times that, alone and with neighbours that share."""
        reference = self.bench.reference(row["scene"], size)
        for factor in (1, 4):
            for share in (False, True):
                picture, spp, taken_ms, command = self.bench.trace_for(row["scene"], size, factor * row["ms_frame"], share)
                errors = {"final": self.bench.compare(picture, reference),
                          "final_pixels": self.bench.compare(picture, reference, block=1)}
                self.rows.append({"id": f"{row['scene']}/path_tracer,{size},{spp} spp{',share' * share}", "kind": "path_tracer",
                                  "scene": row["scene"], "size": size, "equal_to": row["id"], "share": share, "factor": factor,
                                  "spp": spp, "ms_total": taken_ms, "command": command, "errors": errors})
                self.progress.step(f"{self.rows[-1]['id']}: {taken_ms:.0f} ms for {factor} x {row['ms_frame']:.0f}, SMAPE "
                                   f"{errors['final']['smape']:.4f}")

    def repeat_published(self, experiments, deadline):
        for scene in report_published.SCENES:
            if scene in self.plan.scenes:
                self.published += report_published.repeat(self.bench, self.plan, scene, experiments,
                                                          lambda: time.monotonic() > deadline, self.progress.step)

    def say(self, row):
        self.progress.step(f"{row['id']}: {row['ms_frame']:.0f} ms, {row['relative_time']:.2f} of the baseline, SMAPE "
                           f"{error(row):.4f}")


def climb_ladder(scene, size, voxels, output, bin_folder):
    """Signed steps of the ladder of errors (chapter 13) for one bounce of diffuse light, in % of the mean of R1: the path
    tracer with as many bounces."""
    file = output / f"ladder_{scene}.json"
    result = subprocess.run([sys.executable, str(ROOT / "tools" / "ladder.py"), "--scene", str(ROOT / "assets" / f"{scene}.glb"),
                             "--size", f"{size}x{size}", "--voxels", voxels, "--spp", str(LADDER_SPP), "--bounces", "1",
                             "--json", str(file), "--bin", str(bin_folder)],
                            capture_output=True, text=True)
    if result.returncode:
        raise Failed(f"ladder {scene}: code {result.returncode}: {(result.stderr.strip().splitlines() or ['nothing was said'])[-1]}")
    rungs = json.loads(file.read_text())
    return {"steps": [[r["step"], r["step_percent"]] for r in rungs["rungs"][1:]], "total": rungs["total_percent"],
            "standard_error": rungs["standard_error_percent"], "size": size, "voxels": int(voxels)}


def write_csv(file, rows):
    passes = list(dict.fromkeys(name for row in rows for name in row.get("ms", {})))
    parts = [*PARTS, "final_pixels"]
    head = ["id", "kind", "scene", "size", "setting", "sweeps", "equal_to", "share", "factor", "spp", "relative_time", "ms_steady",
            "ms_frame", "ms_scene", "ms_light", "ms_camera", "ms_total", *(f"ms {p}" for p in passes), "points_per_pixel", "steps",
            "fetches", "specular_steps", "specular_fetches", "bytes", *(f"{part} {m}" for part in parts for m in MEASURES), "command"]
    with open(file, "w", newline="") as out:
        table = csv.writer(out)
        table.writerow(head)
        for row in rows:
            values = {**row, "sweeps": " ".join(row.get("sweeps", [])),
                      **{f"ms {p}": ms for p, ms in row.get("ms", {}).items()},
                      **{f"{part} {m}": v for part, measures in row.get("errors", {}).items() for m, v in (measures or {}).items()}}
            table.writerow([values.get(name, "") for name in head])


def rounded(value):
    """Seven digits are more than any clock or path tracer has."""
    if isinstance(value, float):
        return float(f"{value:.7g}")
    if isinstance(value, dict):
        return {k: rounded(v) for k, v in value.items()}
    return [rounded(v) for v in value] if isinstance(value, list) else value


def as_json(data):
    """A line a row, so that two runs can be compared."""
    head = {k: v for k, v in data.items() if k != "rows"}
    rows = ",\n".join(json.dumps(rounded(row)) for row in data["rows"])
    return json.dumps(rounded(head), indent=1)[:-2] + ',\n "rows": [\n' + rows + "\n]}\n"


def parse():
    parser = argparse.ArgumentParser(prog="./run report", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true",
                        help="two scenes, small and coarse: whether all works, in a minute")
    parser.add_argument("--output", type=Path, help="default out/report, or out/report_quick")
    parser.add_argument("--scenes", nargs="+", help=f"some of: {' '.join(CORE_SCENES)} sponza")
    parser.add_argument("--only", nargs="+", metavar="SWEEP", help="these sweeps alone (and grid), to try them")
    parser.add_argument("--minutes", type=float, default=18,
                        help="for all but the figures; rows that do not fit are left out, the slowest first; default 18")
    parser.add_argument("--reference-minutes", type=float, default=None,
                        help="of these for the references, where none as good are kept; default 5")
    parser.add_argument("--references-only", action="store_true", help="make the references, and measure nothing")
    parser.add_argument("--resume", action="store_true", help="go on with the finished rows of a run that was cut off")
    parser.add_argument("--again", action="store_true", help="measure nothing: draw, and publish, what --output holds")
    parser.add_argument("--publish", action="store_true", help="take the result as the book's: docs/data and the page")
    parser.add_argument("--no-figures", action="store_true", help="do not draw; without this, python3-matplotlib is needed")
    parser.add_argument("--bin", type=Path, default=os.environ.get("CONEBOOK_BIN"),
                        help="folder of the programs; default build/bin")
    parser.add_argument("--shared", type=Path, default=os.environ.get("CONEBOOK_SHARED"),
                        help="folder of real scenes; default ../shared")
    options = parser.parse_args()
    options.output = (options.output or ROOT / "out" / ("report_quick" if options.quick else "report")).resolve()
    options.shared = Path(options.shared or ROOT.parent / "shared").resolve()
    options.bin = Path(options.bin or ROOT / "build" / "bin").resolve()
    if options.reference_minutes is None:
        options.reference_minutes = 0.1 if options.quick else 5.0
    return options


def measure_all(options, bench, plan, defaults):
    """Everything that report.json holds; None with --references-only."""
    started = time.monotonic()
    whole = not options.only
    ladder_scenes = [s for s in plan.scenes if s in CORE_SCENES] if whole and not options.quick else []
    reserve = (LADDER_S * len(ladder_scenes) + PUBLISHED_S * 2 * (not options.quick)) if whole else 0
    about = machine(ROOT, "")  # before this run makes a load of its own
    measurement = Measurement(bench, plan, defaults, started, started + 60 * options.minutes - reserve,
                              Kept(options.output / "rows.jsonl", bench, options.resume))
    print(f"report: {len(plan.rows)} settings on {len(plan.scenes)} scenes, {plan.size} pixels", flush=True)
    measurement.make_references(60 * options.reference_minutes)
    if options.references_only:
        return None
    if LARGE_SCENE in plan.scenes:
        measurement.run_large()
    for scene in plan.scenes:
        measurement.run_scene(scene)
    ladder = {}
    for scene in ladder_scenes:
        try:
            ladder[scene] = climb_ladder(scene, 64, defaults["voxels"], options.output, bench.bin)
            measurement.progress.step(f"ladder of {scene}: {ladder[scene]['total']:+.1f} %")
        except Failed as fault:
            measurement.failed.append(f"ladder of {scene}")
            print(f"report: {fault}", file=sys.stderr)
    if whole:
        experiments = [e for e in report_published.EXPERIMENTS if not options.quick or e["name"] == "shadows on voxels"]
        measurement.repeat_published(experiments, max(started + 60 * options.minutes, time.monotonic() + 2 * PUBLISHED_S))
    sweeps = QUICK_SWEEPS if options.quick else ALL_SWEEPS
    about["driver"] = next(r["driver"] for r in measurement.rows if "driver" in r)
    for row in measurement.rows:
        row.pop("driver", None)
        if row["kind"] == "cones":
            row["sweep_values"] = {s: " ".join(row["parameters"][n] for n in sweeps.get(s, [{}])[0]) for s in row["sweeps"]}
    orders = {name: list(dict.fromkeys(" ".join(s.get(n, measurement.defaults.get(n, "")) for n in values[0]) for s in values))
              for name, values in sweeps.items()}
    return {"machine": about, "quick": options.quick, "size": plan.size, "large_size": plan.large_size, "frames": plan.frames,
            "block": BLOCK, "noise_share": NOISE_SHARE, "left_out": measurement.left_out, "failed": measurement.failed,
            "core_scenes": [s for s in plan.scenes if s in CORE_SCENES], "references": measurement.references,
            "baseline": {k: measurement.defaults[k] for k in sorted(SWEPT)}, "sweep_order": orders, "ladder": ladder,
            "published": measurement.published, "seconds": time.monotonic() - started, "rows": measurement.rows}


def publish(output):
    """Returns the exit code."""
    folder = ROOT / "docs" / "data"
    for old in folder.glob("14_*.png"):
        old.unlink()
    for file in (output / "report.json", output / "report.csv", *(output / "figures").glob("*.png")):
        shutil.copy(file, folder / file.name)
    import report_page
    return report_page.write(ROOT)


def main():
    options = parse()
    if not options.no_figures:
        import report_figures
        if not report_figures.available():
            print("report: figures need python3-matplotlib (apt-get install python3-matplotlib); --no-figures does without",
                  file=sys.stderr)
            return 2
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        bench = Bench(ROOT, options.bin, options.shared, options.output, "")
        defaults = bench.defaults()
        plan = make_plan(options.quick, options.scenes, defaults, options.shared)
        bench.size = plan.size
        if options.only:
            plan.rows = [r for r in plan.rows if not r.settings or set(r.sweeps) & set(options.only)]
        if options.again:
            data = json.loads((options.output / "report.json").read_text())
            for scene in plan.scenes:
                bench.make_reference(scene, plan.size, 0.0, plan.most_spp)
        else:
            data = measure_all(options, bench, plan, defaults)
            if data is None:
                return 0
            (options.output / "report.json").write_text(as_json(data))
            write_csv(options.output / "report.csv", rounded(data["rows"]))
            print(f"report: {options.output / 'report.json'}, {data['seconds'] / 60:.1f} minutes")
        if not options.no_figures:
            figures = options.output / "figures"
            figures.mkdir(exist_ok=True)
            report_figures.draw(Report(data), bench, plan, figures)
        code = publish(options.output) if options.publish else 0
    except (Failed, OSError, ValueError) as fault:
        print(f"report: {fault}", file=sys.stderr)
        return 1
    if data.get("failed"):
        print(f"report: {len(data['failed'])} rows failed: {' '.join(data['failed'])}", file=sys.stderr)
        return 1
    return code


if __name__ == "__main__":
    sys.exit(main())
