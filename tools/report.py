#!/usr/bin/env python3
"""Measure speed against error: many settings of the cones, and the path tracer, on several scenes.

Writes report.json, report.csv and figures into the output folder; with --publish also into docs/data, and the page
docs/14_speed_against_error.md anew. Run it on an idle machine: times are ratios to a baseline that runs again and
again, but a busy neighbour still shows.
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
from report_analysis import Report, error, pareto_front  # noqa: E402
from report_measure import BLOCK, NOISE_SHARE, Bench, Failed, counted, machine, times_of  # noqa: E402
from report_plan import CORE_SCENES, GRID, PARTS, QUICK_SWEEPS, SCENE_SWEEPS, SWEEPS, fitting, make_plan  # noqa: E402

MEASURES = ["signed_ratio", "smape", "nrmse", "p95", "flip", "noise", "nrmse_without_noise", "noisy_reference"]
OTHER_BOUNCES_SHARE = 0.5  # of the samples, for the references of the bounces sweep
LADDER_S = 45  # a scene, about
OUTSIDE_SHARE = 0.5        # and for scenes whose rays take long


class Progress:
    """One line a row, with the time that is left."""

    def __init__(self, jobs):
        self.jobs, self.done, self.started = jobs, 0, time.monotonic()

    def step(self, text):
        self.done += 1
        left = (time.monotonic() - self.started) / self.done * max(self.jobs - self.done, 0)
        print(f"[{self.done}/{self.jobs}] {text}, {left / 60:.1f} min left", flush=True)


class Measurement:
    """All rows. `deadline`: of time.monotonic(), by which it should be done; rows that do not fit are left out."""

    def __init__(self, bench, plan, defaults, deadline):
        self.deadline = deadline
        self.bench, self.plan = bench, plan
        self.defaults = {**defaults, **plan.base}
        self.bounces = int(self.defaults["bounces"])
        self.rows = []
        self.noisy = []
        self.failed = []
        self.left_out = []
        per_scene = {s: sum(r.scene == s for r in plan.rows) for s in plan.scenes}
        self.progress = Progress(sum(n + n // plan.drift_every for n in per_scene.values()) +
                                 len(plan.scenes) * plan.path_tracer_rows)

    def reference(self, scene, part, bounces):
        share = 1.0 if bounces in (self.bounces, -1) and part != "indirect_diffuse" or bounces == self.bounces \
            else OTHER_BOUNCES_SHARE
        share *= 1.0 if scene in CORE_SCENES else OUTSIDE_SHARE
        return self.bench.reference(scene, part, 0 if part == "direct" else bounces,
                                    max(16, int(self.plan.spp[part] * share)))

    def errors(self, row, bounces, pictures, baseline):
        """Of every part against the same bounces, and of the whole against all bounces, by blocks and by pixels."""
        found = {}
        changed = row.parts()
        for part in PARTS:
            if part not in changed:
                found[part] = dict(baseline["errors"][part], same_as=baseline["id"]) if baseline["errors"][part] else None
                continue
            if part.startswith("indirect") and bounces == 0:
                found[part] = None
                continue
            if part in ("final", "indirect_specular") and bounces not in (0, self.bounces, -1):
                found[part] = None  # no reference with as many bounces: the diffuse part has one, and final_all
                continue
            reference = self.reference(row.scene, part, bounces)
            found[part] = None if reference["black"] else self.bench.compare(pictures(part), reference)
        whole = self.reference(row.scene, "final", -1)
        found["final_all"] = self.bench.compare(pictures("final"), whole, flip=True)
        found["final_all_pixels"] = self.bench.compare(pictures("final"), whole, block=1)
        for part, measures in found.items():
            if measures and measures["noisy_reference"] and "same_as" not in measures and part != "final_all_pixels":
                self.noisy.append(f"{row.id} {part}")
        return found

    def measure(self, row, baseline):
        settings = {**self.plan.base, **row.settings}
        stats = self.bench.render(row.scene, settings, row.frames(self.plan.frames, baseline and baseline["times"][-1]))
        parameters = {**self.defaults, **row.settings}
        times = times_of(stats)
        steady = baseline["times"][-1] if baseline else times["ms_frame"]
        errors = self.errors(row, int(parameters["bounces"]), lambda part: self.bench.part_picture(row.scene, part), baseline)
        return {"id": row.id, "kind": "cones", "scene": row.scene, "setting": row.setting, "sweeps": row.sweeps,
                "command": stats["command"], "parameters": {k: v for k, v in parameters.items() if k in SWEPT},
                **times, "relative_time": times["ms_frame"] / steady,
                "fetches": counted(stats, "fetches per pixel"), "occupied_faces": counted(stats, "occupied faces"),
                "bytes": sum(r["bytes"] for r in stats["resources"]), "errors": errors, "driver": stats["driver"]}

    def choose(self, rows, scenes_left, baseline_ms, reference_seconds):
        """What fits into this scene's share of the time that is left."""
        share = (self.deadline - time.monotonic()) / scenes_left - reference_seconds
        kept, left_out = fitting(rows, share, self.plan.frames, baseline_ms)
        for row in left_out:
            self.left_out.append(row.id)
            self.progress.step(f"{row.id} is left out: it would take about "
                               f"{row.expected_seconds(self.plan.frames, baseline_ms):.0f} s")
        return kept

    def run_scene(self, scene):
        rows = [r for r in self.plan.rows if r.scene == scene]
        started = time.monotonic()
        first = self.measure(rows[0], None)
        first["times"] = [first["ms_frame"]]
        self.say(first)
        # The references that other numbers of bounces need take about as long as those that the baseline needed.
        rows = self.choose(rows, len(self.plan.scenes) - self.plan.scenes.index(scene), first["ms_frame"],
                           time.monotonic() - started)
        measured = [first]
        for i, row in enumerate(rows[1:], 1):
            if i % self.plan.drift_every == 0:
                stats = self.bench.render(scene, self.plan.base, rows[0].frames(self.plan.frames, first["times"][0]), count=False)
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
        steady = times[len(times) // 2]
        for row in measured:
            row["ms_steady"] = row["relative_time"] * steady
        self.rows += measured
        self.trace(scene, measured)

    def trace(self, scene, measured):
        """The path tracer with the time of the baseline and of the rows of this scene's front."""
        front = [measured[i] for i in pareto_front([(r["ms_steady"], error(r)) for r in measured])]
        wanted = {measured[0]["id"]: measured[0], front[0]["id"]: front[0], front[-1]["id"]: front[-1]}
        for row in front[1:-1][::max(1, len(front) // 3)]:
            wanted.setdefault(row["id"], row)
        reference = self.reference(scene, "final", -1)
        rate = reference["spp"] / reference["seconds"]
        for row in list(wanted.values())[:self.plan.path_tracer_rows]:
            spp = max(1, round(rate * row["ms_total"] / 1000))
            picture, seconds, command = self.bench.trace(scene, spp)
            blocks = self.bench.compare(picture, reference, flip=True)
            pixels = self.bench.compare(picture, reference, block=1)
            self.rows.append({"id": f"{scene}/path_tracer,{spp} spp", "kind": "path_tracer", "scene": scene,
                              "setting": f"path tracer, {spp} spp", "command": command, "equal_to": row["id"], "spp": spp,
                              "ms_total": 1000 * spp / rate, "ms_process": 1000 * seconds,
                              "errors": {"final_all": blocks, "final_all_pixels": pixels}})
            self.progress.step(f"{self.rows[-1]['id']}: SMAPE {blocks['smape']:.4f}")

    def say(self, row):
        smape = error(row)
        self.progress.step(f"{row['id']}: {row['ms_frame']:.0f} ms, {row['relative_time']:.2f} of the baseline, SMAPE {smape:.4f}")


def climb_ladder(scene, size, voxels, output, bin_folder):
    """Signed steps of the ladder of errors (chapter 13) for one bounce of diffuse light, in % of the truth's mean."""
    file = output / f"ladder_{scene}.json"
    result = subprocess.run([sys.executable, str(ROOT / "tools" / "ladder.py"), "--scene", str(ROOT / "assets" / f"{scene}.glb"),
                             "--size", f"{size}x{size}", "--voxels", voxels, "--spp", "512", "--bounces", "1", "--json", str(file),
                             "--bin", str(bin_folder)],
                            capture_output=True, text=True)
    if result.returncode:
        raise Failed(f"ladder {scene}: code {result.returncode}: {(result.stderr.strip().splitlines() or ['nothing was said'])[-1]}")
    rungs = json.loads(file.read_text())
    return {"steps": [[r["step"], r["step_percent"]] for r in rungs["rungs"][1:]], "total": rungs["total_percent"],
            "size": size, "voxels": int(voxels)}


ALL_SWEEPS = {**SWEEPS, **{name: values for sweeps in SCENE_SWEEPS.values() for name, values in sweeps.items()}}
SWEPT = {name for values in (*ALL_SWEEPS.values(), *QUICK_SWEEPS.values(), GRID) for s in values for name in s}


def write_csv(file, rows):
    passes = list(dict.fromkeys(name for row in rows for name in row.get("ms", {})))
    parts = [*PARTS, "final_all", "final_all_pixels"]
    head = ["id", "kind", "scene", "setting", "sweeps", "equal_to", "relative_time", "ms_steady", "ms_frame", "ms_scene",
            "ms_light", "ms_camera", "ms_total", *(f"ms {p}" for p in passes), "fetches", "bytes",
            *(f"{part} {m}" for part in parts for m in MEASURES), "command"]
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
                        help="two scenes, small and coarse: whether all works, in under 3 minutes")
    parser.add_argument("--output", type=Path, help="default out/report, or out/report_quick")
    parser.add_argument("--scenes", nargs="+", help=f"some of: {' '.join(CORE_SCENES)} sponza")
    parser.add_argument("--only", nargs="+", metavar="SWEEP", help="these sweeps alone (and grid), to try them")
    parser.add_argument("--minutes", type=float, default=38,
                        help="rows that do not fit are left out, the slowest first; default 38")
    parser.add_argument("--again", action="store_true", help="measure nothing: draw, and publish, what --output holds")
    parser.add_argument("--publish", action="store_true", help="take the result as the book's: docs/data and the page")
    parser.add_argument("--no-figures", action="store_true", help="do not draw; without this, python3-matplotlib is needed")
    parser.add_argument("--bin", type=Path, default=os.environ.get("CONEBOOK_BIN"),
                        help="folder of the programs; default build/bin")
    parser.add_argument("--shared", type=Path, default=os.environ.get("CONEBOOK_SHARED"),
                        help="folder of real scenes; default ../shared")
    options = parser.parse_args()
    if options.publish and options.quick:
        parser.error("--publish: a quick run is no report")
    options.output = (options.output or ROOT / "out" / ("report_quick" if options.quick else "report")).resolve()
    options.shared = Path(options.shared or ROOT.parent / "shared").resolve()
    options.bin = Path(options.bin or ROOT / "build" / "bin").resolve()
    return options


def measure_all(options, bench, plan, defaults):
    """Everything that report.json holds."""
    started = time.monotonic()
    whole = not options.quick and not options.only
    reserve = LADDER_S * len(plan.scenes) if whole else 0
    measurement = Measurement(bench, plan, defaults, started + 60 * options.minutes - reserve)
    print(f"report: {len(plan.rows)} settings on {len(plan.scenes)} scenes, {plan.size}x{plan.size} pixels", flush=True)
    for scene in plan.scenes:
        measurement.run_scene(scene)
    core = [s for s in plan.scenes if s in CORE_SCENES]
    ladder = {}
    for scene in core if whole else []:
        try:
            ladder[scene] = climb_ladder(scene, 64, defaults["voxels"], options.output, bench.bin)
            print(f"report: ladder of {scene}: {ladder[scene]['total']:+.1f} %", flush=True)
        except Failed as fault:
            measurement.failed.append(f"ladder of {scene}")
            print(f"report: {fault}", file=sys.stderr)
    sweeps = QUICK_SWEEPS if options.quick else ALL_SWEEPS
    driver = next(r["driver"] for r in measurement.rows if "driver" in r)
    for row in measurement.rows:
        row.pop("driver", None)
        if row["kind"] == "cones":
            row["sweep_values"] = {s: " ".join(row["parameters"][n] for n in sweeps.get(s, [{}])[0]) for s in row["sweeps"]}
    orders = {name: list(dict.fromkeys(" ".join(s.get(n, "") for n in values[0]) for s in values))
              for name, values in sweeps.items()}
    return {"machine": machine(ROOT, driver), "quick": options.quick, "size": plan.size, "frames": plan.frames,
            "block": BLOCK, "noise_share": NOISE_SHARE, "noisy": measurement.noisy, "left_out": measurement.left_out,
            "failed": measurement.failed, "core_scenes": core,
            "baseline": {k: measurement.defaults[k] for k in sorted(SWEPT)}, "sweep_order": orders, "ladder": ladder,
            "seconds": time.monotonic() - started, "rows": measurement.rows}


def publish(output):
    """Returns the exit code."""
    folder = ROOT / "docs" / "data"
    for old in folder.glob("*.png"):
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
        bench = Bench(ROOT, options.bin, options.shared, options.output, 64 if options.quick else 256)
        defaults = bench.defaults()
        plan = make_plan(options.quick, options.scenes, defaults, options.shared)
        if options.only:
            plan.rows = [r for r in plan.rows if not r.settings or set(r.sweeps) & set(options.only)]
        if options.again:
            data = json.loads((options.output / "report.json").read_text())
        else:
            data = measure_all(options, bench, plan, defaults)
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
