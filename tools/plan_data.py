#!/usr/bin/env python3
"""Measure what chapter 16 plans with: error, times and bytes of the settings that it may choose, into assets/plan.json.

Every setting is measured alone, against a baseline, on every scene; some are measured together as well, so that a test can
see how well chapter 16 puts them together (tests/16_only_what_is_needed_test.cpp). By chapter 14's program, against the path
tracer, as ./run report does. Run it on an idle machine.
"""
import argparse
import json
import os
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True
from pages import ROOT  # noqa: E402
from report_measure import Bench, counts_of, machine, times_of  # noqa: E402, F401
from report_plan import ALONE, CORE_SCENES, OUTSIDE_SCENES  # noqa: E402

SIZE = "256x256"
BASELINE = {"voxels": "128", "cones": "16", "gather_scale": "2", "bounces": "-1", "format": "rgba16f", "shadow_map_size": "1024"}
ALONE_SETTINGS = {"voxels": ["32", "64", "96", "192"], "cones": ["5", "9", "32"], "gather_scale": ["1", "4"],
                  "bounces": ["1", "2", "4"], "format": ["rgba8"], "shadow_map_size": ["256", "512"]}
TOGETHER = [{"voxels": "64", "cones": "9"}, {"voxels": "64", "gather_scale": "4"}, {"voxels": "32", "cones": "5", "gather_scale": "4"},
            {"voxels": "64", "bounces": "2"}, {"voxels": "96", "cones": "32", "gather_scale": "1"},
            {"voxels": "64", "format": "rgba8", "shadow_map_size": "256"}]
OUTSIDE_VOXELS = ["64", "192"]  # of scenes that take long


def rows_of(scene):
    rows = [{}]
    for name, values in ALONE_SETTINGS.items():
        rows += [{name: value} for value in values if scene in CORE_SCENES or name != "voxels" or value in OUTSIDE_VOXELS]
    return rows + (TOGETHER if scene in CORE_SCENES else TOGETHER[:2])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--bin", type=Path, default=os.environ.get("CONEBOOK_BIN", ROOT / "build" / "bin"))
    parser.add_argument("--shared", type=Path, default=os.environ.get("CONEBOOK_SHARED", ROOT.parent / "shared"))
    parser.add_argument("--keep", type=Path, help="folder of references, kept for the next time")
    parser.add_argument("--seconds", type=float, default=20, help="of the path tracer, a scene")
    parser.add_argument("--frames", type=int, default=3, help="of which the fastest counts")
    options = parser.parse_args()
    folder = options.keep or Path(tempfile.mkdtemp())
    bench = Bench(ROOT, Path(options.bin), Path(options.shared), folder, SIZE)
    scenes, driver = [], ""
    for scene in CORE_SCENES + list(OUTSIDE_SCENES):
        if not bench.scene_file(scene).exists():
            print(f"plan_data: {scene} is left out: there is no {bench.scene_file(scene)}")
            continue
        reference = bench.make_reference(scene, SIZE, options.seconds, 4096)
        rows = []
        for settings in rows_of(scene):
            together = len(settings) > 1
            stats = bench.render(scene, {**ALONE, **BASELINE, **settings}, options.frames, count=False, parts=False)
            times, error = times_of(stats), bench.compare(bench.pictures / f"{scene}.exr", reference)
            rows.append({"set": settings, "together": together, "error": round(error["smape"], 5),
                         "ms": {name: round(ms, 3) for name, ms in times["ms"].items()}, "scopes": times["scopes"],
                         "bytes": sum(r["bytes"] for r in stats["resources"]),
                         "counts": {c["name"]: c["value"] for c in stats["counts"] if c["name"].startswith("occupied") or
                                    c["name"] == "fragments"}})
            driver = stats["driver"]
            print(f"{scene:14s} {' '.join(f'{k}={v}' for k, v in settings.items()) or 'baseline':48s} error {error['smape']:.4f} "
                  f"noise {error['noise']:.4f} camera {times['ms_camera']:.0f} ms", flush=True)
        scenes.append({"name": bench.scene_file(scene).stem, "rows": rows})
    data = {"size": [int(n) for n in SIZE.split("x")], "machine": machine(ROOT, driver), "baseline": BASELINE, "scenes": scenes}
    # A row a line: differences stay readable.
    text = json.dumps(data)
    for mark in ('{"set"', '{"name"'):
        text = text.replace(mark, "\n" + mark)
    (ROOT / "assets" / "plan.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
