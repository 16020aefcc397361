#!/usr/bin/env python3
"""How every pass grows with voxels, triangles, lights and pixels, and how near the cones come to what their look-ups cost.

  ./run bench             all of it; tables and figures into out/bench
  ./run bench --quick     few small settings: whether all works
  ./run bench window      the window's frames, where this checkout has that tool

One thing grows, the others stay: a room with bumps on its floor, made for the purpose. The exponent p of ms = c x^p is the
slope of the least squares line through the logarithms; "at the end" is that of the two largest alone, since a fixed cost hides
growth where little is to be done. The roofline of the diffuse cones is their counted look-ups times what one costs by itself
(bench_fetch), interpolated to the size of the volume; the fraction is that time over the measured one. Idle machine, please.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True
import bench_scene  # noqa: E402
from pages import ROOT  # noqa: E402
from report_analysis import fit_power  # noqa: E402
from report_measure import CHAPTER, Failed, counts_of, machine, times_of  # noqa: E402
from report_plan import ALONE  # noqa: E402
from report_words import table  # noqa: E402

BASE = {"voxels": 128, "triangles": 10_000, "lights": 1, "size": "320x180"}
SERIES = {"voxels": [64, 96, 128, 192, 256], "triangles": [100, 1_000, 10_000, 100_000, 1_000_000], "lights": [1, 4, 16, 64],
          "size": ["160x90", "320x180", "640x360", "1280x720", "1920x1080"]}
QUICK_BASE = {"voxels": 32, "triangles": 200, "lights": 1, "size": "48x27"}
QUICK_SERIES = {"voxels": [16, 32], "triangles": [200, 3_000], "lights": [1, 4], "size": ["48x27", "96x54"]}
# Shadow maps of 64 point lights have 384 layers: 1024 texels a side would take 1.6 GB.
SETTINGS = {**ALONE, "shadow_map_size": "256"}
COLORS = ["#1b6ca8", "#c8553d", "#3b7a57", "#8e5ea2", "#6b6b6b", "#d9a441", "#4fb0ae"]


def amount(name, value):
    """What grows, as a number: pixels for a size."""
    return math.prod(map(int, value.split("x"))) if name == "size" else value


def points_of(base, series):
    """All settings of all series, each once, the base first."""
    points = [base]
    for name, values in series.items():
        points += [p for value in values if (p := {**base, name: value}) not in points]
    return points


def growth(rows, base, name):
    """{pass: [(amount, ms)]} of the rows in which `name` alone differs from the base."""
    found = {}
    for row in rows:
        if all(row[key] == base[key] for key in base if key != name):
            for one_pass, ms in row["ms"].items():
                found.setdefault(one_pass, []).append((amount(name, row[name]), ms))
    return {one_pass: sorted(points) for one_pass, points in found.items()}


def exponents(points):
    """(over all, of the two largest): p of ms = c x^p; None where there are not two."""
    fit, end = fit_power(points), fit_power(points[-2:])
    return fit and fit[0], end and end[0]


def cost_ns(costs, look_up, size_bytes):
    """ns of one look-up in a volume of that size: between the measured ones by the logarithm of the size, beyond them theirs."""
    known = sorted((c["bytes"], c["ns"]) for c in costs if c["look_up"] == look_up)
    (small, fast), (large, slow) = known[0], known[-1]
    part = min(max(math.log(size_bytes / small) / math.log(large / small), 0.0), 1.0)
    return fast + part * (slow - fast)


def roofline_fraction(row, costs):
    """What the diffuse cones' look-ups cost by themselves, over what the pass takes; None without both."""
    ms = row["ms"].get("diffuse cones")
    if not ms or not row["steps"]:
        return None
    points = row["points_per_pixel"] * amount("size", row["size"])
    steps = row["steps"] * cost_ns(costs, "texel r32ui", row["bytes"]["walk volume"])
    fetches = row["fetches"] * cost_ns(costs, "trilinear rgba16f", row["bytes"]["light pyramid"])
    return 1e-6 * points * (steps + fetches) / ms


class Programs:
    def __init__(self, bin_folder, folder, frames):
        self.bin, self.folder, self.frames = bin_folder, folder, frames
        self.environment = dict(os.environ, CONEBOOK_ROOT=os.environ.get("CONEBOOK_ROOT", str(ROOT)))
        self.environment.setdefault("MESA_SHADER_CACHE_DIR", str(bin_folder.parent / "shader_cache"))
        self.scenes = {}

    def run(self, program, *arguments):
        try:
            result = subprocess.run([str(self.bin / program), *map(str, arguments)], env=self.environment, capture_output=True,
                                    text=True)
        except OSError as fault:
            raise Failed(f"{self.bin / program}: {fault.strerror}; build it first") from fault
        if result.returncode:
            raise Failed(f"{program}: code {result.returncode}: {(result.stderr.strip().splitlines() or ['nothing was said'])[-1]}")
        return result.stdout

    def scene(self, triangles, lights):
        """(file, triangles)."""
        if (triangles, lights) not in self.scenes:
            file = self.folder / f"room_{triangles}_{lights}.glb"
            self.scenes[triangles, lights] = file, bench_scene.write(file, triangles, lights)
        return self.scenes[triangles, lights]

    def measure(self, point):
        file, triangles = self.scene(point["triangles"], point["lights"])
        stats = self.folder / "stats.json"
        words = [f"{k}={v}" for k, v in {**SETTINGS, "voxels": point["voxels"]}.items()]
        self.run(CHAPTER, "--headless", "--scene", file, "--size", point["size"], "--frames", self.frames, "--set", *words,
                 "count_fetches=on", "--output", self.folder / "picture.exr", "--stats", stats)
        told = json.loads(stats.read_text())
        return {**point, "exact_triangles": triangles, **{k: times_of(told)[k] for k in ("ms", "scopes", "ms_frame", "ms_total")},
                **counts_of(told), "bytes": {r["name"]: r["bytes"] for r in told["resources"]}, "driver": told["driver"]}


def number(value, form="{:.2f}"):
    return "-" if value is None else form.format(value)


def as_page(data):
    """The tables, as Markdown."""
    m = data["machine"]
    lines = ["# How the passes grow", "",
             f"Made by `./run bench`{' --quick: this only shows that it works' if data['quick'] else ''}. {m['cpu']}, {m['cores']} cores, "
             f"{m['driver']}; load {m['load']:.1f} before it began; commit {m['commit'][:10]}{m['commit'][40:]}, {m['date']}.", "",
             "One thing grows, the others stay at " + ", ".join(f"{k} {v}" for k, v in data["base"].items()) + "; a closed room with "
             "bumps on its floor. Every pass runs in every frame; ms of the fastest frame. p: the exponent in ms = c x^p, by least "
             "squares of the logarithms over all columns, and between the last two.", ""]
    for name, values in data["series"].items():
        columns = growth(data["rows"], data["base"], name)
        heads = [str(v) for v in values]
        rows = []
        for one_pass, points in columns.items():
            by_amount = dict(points)
            p, end = exponents(points)
            rows.append([one_pass, data["scopes"][one_pass], *(number(by_amount.get(amount(name, v)), "{:.3g}") for v in values),
                         number(p), number(end)])
        lines += [f"## {'Pixels' if name == 'size' else name.capitalize()}", table(["pass, ms", "scope", *heads, "p", "p at the end"], rows)]
    lines += ["## What a look-up costs", "", "By itself, on all cores, along rays through a volume of this size:",
              table(["look-up", "volume", "ns"], [[c["look_up"], f"{c['bytes'] / 1e6:.0f} MB", f"{c['ns']:.3g}"] for c in data["costs"]]),
              "## The roofline of the diffuse cones", "", "Counted look-ups times the cost of one, over the pass's time: 1 would be a "
              "pass that does nothing but look up.",
              table(["voxels", "triangles", "lights", "size", "points a pixel", "steps a point", "fetches a point", "ms", "fraction"],
                    [[r["voxels"], r["exact_triangles"], r["lights"], r["size"], f"{r['points_per_pixel']:.2f}", f"{r['steps']:.0f}",
                      f"{r['fetches']:.0f}", f"{r['ms'].get('diffuse cones', 0):.3g}", number(roofline_fraction(r, data["costs"]))]
                     for r in data["rows"]])]
    return "\n".join(lines).rstrip() + "\n"


def draw(data, file):
    """ms of the passes that ever take a twentieth of the whole, over what grows."""
    from report_figures import plain_ticks, pyplot, save
    plt = pyplot()
    figure, axes = plt.subplots(3, 2, figsize=(8.4, 7.0), gridspec_kw={"height_ratios": [1, 1, 0.2]})
    shown = [p for p in data["scopes"] if any(r["ms"].get(p, 0) > 0.05 * r["ms_total"] for r in data["rows"])]
    styles = {p: (COLORS[i % len(COLORS)], ("-o", "--s", ":^")[i // len(COLORS) % 3]) for i, p in enumerate(shown)}
    for axis, name in zip(axes.flat, data["series"]):
        for one_pass, points in growth(data["rows"], data["base"], name).items():
            if one_pass in styles:
                color, style = styles[one_pass]
                axis.plot(*zip(*points), style, color=color, markersize=3, label=one_pass)
        axis.set(xscale="log", yscale="log", xlabel="pixels" if name == "size" else name, ylabel="ms")
        plain_ticks(axis.xaxis, sorted(amount(name, v) for v in data["series"][name]))
        plain_ticks(axis.yaxis)
        axis.tick_params(axis="x", labelrotation=20)
    for axis in axes[2]:
        axis.axis("off")
    legend = axes[2][0].legend(*axes[0][0].get_legend_handles_labels(), fontsize=7, ncols=5, loc="upper left", borderaxespad=0)
    legend.set_in_layout(False)  # it is wider than its column
    save(plt, figure, file)


def parse():
    parser = argparse.ArgumentParser(prog="./run bench", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="few small settings, in seconds")
    parser.add_argument("--output", type=Path, help="folder; default out/bench, or out/bench_quick")
    parser.add_argument("--publish", action="store_true", help="copy page, data and figure to docs/data, too")
    parser.add_argument("--no-figures", action="store_true", help="do not draw; without this, python3-matplotlib is needed")
    parser.add_argument("--bin", type=Path, default=os.environ.get("CONEBOOK_BIN"), help="folder of the programs; default build/bin")
    options = parser.parse_args()
    options.output = (options.output or ROOT / "out" / ("bench_quick" if options.quick else "bench")).resolve()
    options.bin = Path(options.bin or ROOT / "build" / "bin").resolve()
    return options


def main():
    options = parse()
    if not options.no_figures:
        from report_figures import available
        if not available():
            print("bench: figures need python3-matplotlib (apt-get install python3-matplotlib); --no-figures does without",
                  file=sys.stderr)
            return 2
    base, series = (QUICK_BASE, QUICK_SERIES) if options.quick else (BASE, SERIES)
    started, about = time.monotonic(), machine(ROOT, "")
    try:
        options.output.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="bench_") as folder:
            programs = Programs(options.bin, Path(folder), 2 if options.quick else 3)
            costs = json.loads(programs.run("bench_fetch", 64 if options.quick else 512))
            print("bench: " + "; ".join(f"{c['look_up']} in {c['bytes'] / 1e6:.0f} MB: {c['ns']:.3g} ns" for c in costs), flush=True)
            rows, points = [], points_of(base, series)
            for i, point in enumerate(points, 1):
                rows.append(programs.measure(point))
                print(f"[{i}/{len(points)}, {(time.monotonic() - started) / 60:.1f} min] "
                      f"{' '.join(f'{k}={v}' for k, v in point.items())}: {rows[-1]['ms_total']:.0f} ms", flush=True)
        about["driver"] = rows[0]["driver"]
        for row in rows:
            row.pop("driver")
        data = {"machine": about, "quick": options.quick, "base": base, "series": series, "costs": costs,
                "scopes": {p: scope for r in rows for p, scope in r["scopes"].items()}, "rows": rows}
        (options.output / "bench.json").write_text(json.dumps(data, indent=1) + "\n")
        (options.output / "bench.md").write_text(as_page(data))
        names = ["bench.json", "bench.md"]
        if not options.no_figures:
            draw(data, options.output / "bench.png")
            names.append("bench.png")
        if options.publish:
            for name in names:
                (ROOT / "docs" / "data" / name).write_bytes((options.output / name).read_bytes())
    except (Failed, OSError, ValueError) as fault:
        print(f"bench: {fault}", file=sys.stderr)
        return 1
    print(as_page(data))
    print(f"bench: {options.output / 'bench.md'}, {(time.monotonic() - started) / 60:.1f} minutes")
    return 0


if __name__ == "__main__":
    sys.exit(main())
