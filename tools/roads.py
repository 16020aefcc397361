#!/usr/bin/env python3
"""The roads to the same light side by side: every method of the book on the same scenes, cameras and bounces.

  ./run roads                 table, sheet and plot of all scenes, in out/roads/
  ./run roads --publish       the same as docs/roads.md with its pictures
  ./run roads --quick         one small scene, to see that everything works

A method's time is what all its passes take from nothing to the picture; its bytes are those of its own resources, without
the scene's. The path tracer's rows have few samples a pixel; the truth that all are compared with has many.
"""
import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.dont_write_bytecode = True
from pages import ROOT, chapters  # noqa: E402
from report_analysis import pareto_front  # noqa: E402

METHODS = {"12": "dense voxels", "17": "octree", "18": "voxel rays",
           "19": "vertices", "20": "form factors"}
SCENES = {"cornell_box": 0, "colonnade": 1, "glossy_room": 0, "white_furnace": 0}  # scene: camera
BOUNCES = [1, -1]
TRACED = [4, 32]  # samples a pixel of the path tracer's own rows


def words_of(bounces):
    return "all bounces" if bounces < 0 else f"{bounces} bounce" + ("s" if bounces > 1 else "")


def cost_of(stats):
    """(ms from nothing to the picture, bytes of the method's own resources) of what --stats wrote."""
    ms = sum(p["min_ms"] for p in stats["passes"])
    return ms, sum(r["bytes"] for r in stats["resources"] if not r["name"].startswith("scene "))


class Roads:
    def __init__(self, root, bin_folder, output, size, truth_spp):
        self.root, self.bin, self.output, self.size, self.truth_spp = root, bin_folder, output, size, truth_spp
        self.pictures = output / "pictures"
        self.pictures.mkdir(parents=True, exist_ok=True)
        self.environment = dict(os.environ, CONEBOOK_ROOT=str(root))
        self.environment.setdefault("MESA_SHADER_CACHE_DIR", str(bin_folder.parent / "shader_cache"))

    def run(self, program, *arguments):
        result = subprocess.run([str(self.bin / program), *map(str, arguments)], env=self.environment,
                                capture_output=True, text=True)
        if result.returncode:
            said = (result.stderr.strip().splitlines() or ["nothing was said"])[-1]
            raise RuntimeError(f"{program} {' '.join(map(str, arguments))}: code {result.returncode}: {said}")
        return result.stdout

    def what(self, scene):
        return ["--scene", self.root / "assets" / f"{scene}.glb", "--camera", SCENES[scene], "--size", self.size]

    def traced(self, scene, bounces, spp, seed):
        picture = self.pictures / f"{scene}_{bounces}_spp_{spp}.exr"
        said = self.run("reference", *self.what(scene), "--bounces", bounces, "--spp", spp, "--seed", seed, "--output", picture)
        return picture, 1000.0 * float(re.search(r"(\S+) s in all", said).group(1))

    def error(self, picture, truth):
        file = self.output / "error.json"
        self.run("compare", picture, truth, "--block", 4, "--no-flip", "--json", file)
        told = json.loads(file.read_text())
        file.unlink()
        return told["signed_ratio"], told["smape"]

    def rows(self, scene, bounces, programs, traced):
        """One row a method: name, picture, ms, bytes, signed ratio, SMAPE. The first is the truth."""
        truth, ms = self.traced(scene, bounces, self.truth_spp, 1)
        rows = [{"method": f"truth, {self.truth_spp} samples", "picture": truth, "ms": ms, "bytes": 0, "signed": 1.0, "smape": 0.0}]
        for number, program in programs.items():
            picture, stats = self.pictures / f"{scene}_{bounces}_{number}.exr", self.output / "stats.json"
            self.run(program, "--headless", *self.what(scene), "--set", f"bounces={bounces}", "--output", picture,
                     "--stats", stats)
            ms, size = cost_of(json.loads(stats.read_text()))
            stats.unlink()
            rows.append({"method": f"{number} {METHODS[number]}", "picture": picture, "ms": ms, "bytes": size})
        for spp in traced:
            picture, ms = self.traced(scene, bounces, spp, 0)
            rows.append({"method": f"traced, {spp} samples", "picture": picture, "ms": ms, "bytes": 0})
        for row in rows[1:]:
            row["signed"], row["smape"] = self.error(row["picture"], truth)
        for row in rows:
            row.update(scene=scene, bounces=bounces)
        print(f"{scene}, {words_of(bounces)}: {len(rows)} pictures", flush=True)
        return rows

    def sheet(self, scene, rows, file):
        labels = [word for row in rows for word in ("--label", row["method"][:24])]
        self.run("sheet", "--columns", 4, "--width", 236, *labels, "--output", file, *(row["picture"] for row in rows))


def table(rows):
    """Markdown: a row a method, those on the Pareto front of time and error in bold."""
    own = rows[1:]
    front = set(pareto_front([(row["ms"], row["smape"]) for row in own]))
    lines = ["| method | signed ratio | SMAPE | time, s | memory, MB |", "|---|---|---|---|---|"]
    for i, row in enumerate(own):
        name = f"**{row['method']}**" if i in front else row["method"]
        memory = f"{row['bytes'] / 1e6:.1f}" if row["bytes"] else "-"
        lines.append(f"| {name} | {row['signed']:.3f} | {row['smape']:.3f} | {row['ms'] / 1000:.2f} | {memory} |")
    return "\n".join(lines)


def page(groups, folder, size, has_plot):
    """The page; `folder` is where its pictures lie, as seen from it."""
    lines = ["# The roads to the same light", "",
             f"Every method of the book that has all of the light, on the same scenes and cameras, {size} pixels, default settings. "
             "The error is that of the whole picture against the path tracer with as many bounces, in blocks of 4x4 pixels. "
             "The time is that of all passes, from nothing to the picture; a frame in which only the camera moves is cheaper. "
             "Methods in bold are on the Pareto front: nothing here is both faster and nearer.", ""]
    if has_plot:
        lines += [f"![time against error of every method, a plot a scene]({folder}/pareto.png)", ""]
    for scene in dict.fromkeys(scene for scene, _ in groups):
        lines += [f"## {scene}", ""]
        for (name, bounces), rows in groups.items():
            if name == scene:
                words = words_of(bounces)
                lines += [f"### {scene}, {words}", "",
                          f"![{scene} with {words} by every method]({folder}/{scene}_{bounces}.png)", "", table(rows), ""]
    return "\n".join(lines)


def draw_pareto(groups, file):
    from report_figures import COLORS, WIDTH, plain_ticks, pyplot, save
    plt = pyplot()
    columns = min(2, len(groups))
    lines = (len(groups) + columns - 1) // columns
    figure, axes = plt.subplots(lines, columns, figsize=(WIDTH, 3.2 * lines), squeeze=False)
    for axis in list(axes.flat)[len(groups):]:
        axis.set_visible(False)
    for axis, ((scene, bounces), rows) in zip(axes.flat, groups.items()):
        points = [(row["ms"] / 1000, max(row["smape"], 1e-4)) for row in rows[1:]]
        front = pareto_front(points)
        axis.plot(*zip(*(points[i] for i in front)), "-", color=COLORS[0])
        for (x, y), row in zip(points, rows[1:]):
            axis.plot(x, y, "x" if row["method"].startswith("path") else "o", color=COLORS[1])
            axis.annotate(row["method"], (x, y), fontsize=6, xytext=(4, 3), textcoords="offset points")
        axis.set(title=f"{scene}, {words_of(bounces)}", xscale="log", yscale="log", xlabel="s", ylabel="SMAPE")
        plain_ticks(axis.xaxis)
        plain_ticks(axis.yaxis)
    save(plt, figure, file)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, default=ROOT / "build" / "bin", help="the folder of the programs")
    parser.add_argument("--output", type=Path, default=ROOT / "out" / "roads", help="where pictures and page go")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--size", default="256x256", help="of the pictures")
    parser.add_argument("--spp", type=int, default=1024, help="samples a pixel of the truth")
    parser.add_argument("--quick", action="store_true", help="one scene, small, one bounce")
    parser.add_argument("--publish", action="store_true", help="write docs/roads.md and docs/roads/ too")
    parser.add_argument("--only", nargs="+", choices=METHODS, default=list(METHODS), help="these chapters alone")
    options = parser.parse_args()
    scenes, bounces, traced = options.scenes, BOUNCES, TRACED
    if options.quick:
        scenes, bounces, traced, options.size, options.spp = scenes[:1], BOUNCES[:1], TRACED[:1], "64x64", 32
    there = {name[:2]: name for name in chapters(ROOT) if name[:2] in METHODS and name[:2] in options.only}
    roads = Roads(ROOT, options.bin.resolve(), options.output.resolve(), options.size, options.spp)
    groups = {(scene, k): roads.rows(scene, k, there, traced) for scene in scenes for k in bounces}
    for (scene, k), rows in groups.items():
        roads.sheet(scene, rows, roads.output / f"{scene}_{k}.png")
    from report_figures import available
    if available():
        draw_pareto(groups, roads.output / "pareto.png")
    (roads.output / "roads.md").write_text(page(groups, ".", options.size, available()) + "\n")
    plain = [{**row, "picture": row["picture"].name} for rows in groups.values() for row in rows]
    (roads.output / "roads.json").write_text(json.dumps(plain, indent=1) + "\n")
    if options.publish:
        folder = ROOT / "docs" / "roads"
        folder.mkdir(exist_ok=True)
        for picture in roads.output.glob("*.png"):
            shutil.copy(picture, folder)
        (ROOT / "docs" / "roads.md").write_text(page(groups, "roads", options.size, available()) + "\n")
    print(f"{roads.output / 'roads.md'}")
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except (OSError, RuntimeError, ValueError) as fault:
        print(f"roads: {fault}", file=sys.stderr)
        sys.exit(2)
