#!/usr/bin/env python3
"""The ladder of errors: from the path tracer to the frame as shipped, one shortcut a rung.

  R0  path tracer, all bounces
  R1  path tracer, --bounces of them           truncation
  R2  512 rays a pixel into the finest voxels  voxelization, and the bounces between voxels
  R3  512 cones of 6 degrees a pixel           filtering
  R4  the 256 cones of 16 neighbours a pixel   quadrature
  R5  16 cones in one of 2 x 2 pixels, shared  reconstruction

Each rung is a command and a row: how far its mean is from the rung before, in per cent of R1's mean; SMAPE against the
rung before and against R1; 95th percentile of the relative error against R1. The signed steps add up to R5 - R0.
docs/13_ground_truth.md explains rungs and measures.
"""
import argparse
import json
import os
import re
import shlex
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.dont_write_bytecode = True
from pages import ROOT  # noqa: E402

VIEWS = ["final", "direct", "indirect_diffuse", "indirect_specular", "emission"]
DIGITS = 3  # of the percentages that are printed
STEP_NAMES = ["", "truncation", "voxelization", "filtering", "quadrature", "reconstruction"]
STEP_ROUNDING = 0.5 * 10.0**-DIGITS


class LadderError(Exception):
    pass


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise LadderError(message)


def parse(arguments):
    parser = Parser(prog="./run ladder", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--scene", default="assets/cornell_box.glb", help=".gltf or .glb; default: the Cornell box")
    parser.add_argument("--view", default="indirect_diffuse", choices=VIEWS, help="part of the light; indirect_diffuse")
    parser.add_argument("--bounces", type=int, default=1, help="indirect bounces of R1 to R5; default 1")
    parser.add_argument("--size", default="128x128", help="WxH in pixels; default 128x128")
    parser.add_argument("--voxels", type=int, default=128, help="along the longest side; default 128")
    parser.add_argument("--spp", type=int, default=1024, help="samples per pixel of the path tracer; default 1024")
    parser.add_argument("--block", type=int, default=4, help="SMAPE and percentile over N x N pixels; default 4")
    parser.add_argument("--camera", type=int, help="the scene's Nth camera")
    parser.add_argument("--set", nargs="+", default=[], metavar="NAME=VALUE", help="for R2 to R5: chapter 12's parameters")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the rows here, too")
    parser.add_argument("--bin", type=Path, default=ROOT / "build" / "bin", help="the folder of the programs")
    options = parser.parse_args(arguments)
    if not re.fullmatch(r"[1-9]\d*x[1-9]\d*", options.size):
        parser.error(f"--size {options.size}: expected WxH")
    if options.spp < 2:
        parser.error(f"--spp {options.spp}: a standard error needs at least 2 samples")
    if not -1 <= options.bounces <= 64:
        parser.error(f"--bounces {options.bounces}: must be -1 .. 64")
    for value in options.set:
        if not re.fullmatch(r"[a-z_]+=\S+", value):
            parser.error(f"--set {value}: expected NAME=VALUE")
    scene = Path(options.scene)
    if not scene.exists() and (ROOT / scene).exists():
        options.scene = str(ROOT / scene)
    elif not scene.exists():
        parser.error(f"{scene}: there is no such scene")
    if options.json and not options.json.absolute().parent.is_dir():
        parser.error(f"--json {options.json}: there is no such folder")
    return options


def rungs(options):
    """(name, what it is, words of the command without its output) of each rung."""
    camera = [] if options.camera is None else ["--camera", str(options.camera)]
    common = ["--scene", options.scene, "--size", options.size, *camera]

    def traced(bounces):
        return ["reference", *common, "--spp", str(options.spp), "--bounces", str(bounces), "--part", options.view]

    def cones(*settings):
        chosen = [f"voxels={options.voxels}", f"bounces={options.bounces}", *settings, *options.set]
        return ["12_second_bounce", "--headless", *common, "--view", options.view, "--set", *chosen]

    # snippet: rungs
    return [("R0", "path tracer, all bounces", traced(-1)),
            ("R1", "path tracer, as many bounces", traced(options.bounces)),
            ("R2", "512 rays, finest voxels", cones("interleave=every_pixel", "cones=32", "aperture=0.1")),
            ("R3", "512 narrow cones", cones("interleave=every_pixel", "cones=32")),
            ("R4", "256 cones, nothing shared", cones("interleave=every_pixel")),
            ("R5", "as shipped", cones())]
    # end snippet


def as_typed(name, words):
    return f"./run {shlex.join(words)} --output {name}.exr"


def run(options, words):
    """What the program printed. Its failure is one line that names it."""
    environment = dict(os.environ, CONEBOOK_ROOT=os.environ.get("CONEBOOK_ROOT", str(ROOT)))
    environment.setdefault("MESA_SHADER_CACHE_DIR", str(options.bin.absolute().parent / "shader_cache"))
    try:
        result = subprocess.run([str(options.bin / words[0]), *words[1:]], env=environment, capture_output=True,
                                text=True)
    except OSError as error:
        raise LadderError(f"{options.bin / words[0]}: {error.strerror}; build it first") from error
    if result.returncode:
        lines = (result.stderr.strip() or "no message").splitlines()
        raise LadderError(f"{words[0]} failed with code {result.returncode}: {lines[-1]}")
    return result.stdout


def compare(options, folder, image, reference, block):
    run(options, ["compare", str(folder / image), str(folder / reference), "--no-flip", "--block", str(block), "--json",
                  str(folder / "compared.json")])
    return json.loads((folder / "compared.json").read_text())


def error_of_mean(printed):
    """Mean over the channels of the standard error that `reference` prints, which bounds that of their mean."""
    match = re.search(r"standard error of that mean (\S+) (\S+) (\S+)", printed)
    if not match:
        raise LadderError("reference printed no standard error of the mean")
    return sum(float(value) for value in match.groups()) / 3.0


def climb(options, folder):
    """All rungs, each printed as soon as it stands. Returns what --json gets."""
    rows, scale, errors, r1_mean = [], 1.0, {}, None
    for number, (name, what, words) in enumerate(rungs(options)):
        started = time.monotonic()
        picture = f"{name}.exr"
        printed = run(options, [*words, "--output", str(folder / picture)])
        seconds = time.monotonic() - started
        row = {"rung": name, "what": what, "step": STEP_NAMES[number], "command": as_typed(name, words), "seconds": seconds}
        if name in ("R0", "R1"):
            errors[name] = error_of_mean(printed)
        rows.append(row)
        if name == "R0":
            continue
        # Every mean over the pixels where R1 sees geometry: the same ones for all rungs, so that steps add up.
        if name == "R1":
            of_r0 = compare(options, folder, "R0.exr", "R1.exr", 1)
            r1_mean = of_r0["mean_reference"]
            if not r1_mean > 0.0:
                raise LadderError(f"{options.view} of {options.scene} is black: nothing to relate errors to")
            # The program's mean runs over all pixels, also over those without geometry, whose error is 0.
            scale = of_r0["width"] * of_r0["height"] / of_r0["pixels"]
            rows[0]["mean"], row["mean"] = of_r0["mean_image"], r1_mean
            write_row(rows[0])
        else:
            row["mean"] = compare(options, folder, picture, "R1.exr", 1)["mean_image"]
        before = rows[-2]
        row["step_percent"] = 100.0 * (row["mean"] - before["mean"]) / r1_mean
        row["smape_before"] = compare(options, folder, picture, f"{before['rung']}.exr", options.block)["smape"]
        against = compare(options, folder, picture, "R1.exr", options.block)
        row["smape_r1"], row["p95_r1"] = against["smape"], against["relative_error_p95"]
        write_row(row)
    # The total is measured by itself, from the first picture to the last, and not added up.
    whole = compare(options, folder, "R5.exr", "R0.exr", 1)
    return {"rungs": rows,
            "scene": options.scene, "view": options.view, "bounces": options.bounces, "voxels": options.voxels,
            "size": options.size, "spp": options.spp, "block": options.block, "set": options.set,
            "total_percent": 100.0 * (whole["mean_image"] - whole["mean_reference"]) / r1_mean,
            "sum_of_steps_percent": sum(round(row["step_percent"], DIGITS) for row in rows[1:]),
            "standard_error_percent": {name: 100.0 * scale * e / r1_mean for name, e in errors.items()}}


def write_row(row):
    step = f"{row['step']:<15}"
    numbers = f"{'':>8} {'':>8} {'':>7} {'':>7}"
    if row["step"]:
        numbers = (f"{row['step_percent']:>+8.{DIGITS}f} {row['smape_before']:>8.4f} {row['smape_r1']:>7.4f} "
                   f"{row['p95_r1']:>7.3f}")
    print(f"{row['rung']}  {row['what']:<29} {step} {row['mean']:>9.6f} {numbers} {row['seconds']:>7.1f}", flush=True)


def write_json(file, data):
    unfinished = file.with_name(f"{file.name}.{os.getpid()}.part")
    try:
        unfinished.write_text(json.dumps(data, indent=1) + "\n")
        os.replace(unfinished, file)
    except OSError as error:
        unfinished.unlink(missing_ok=True)
        raise LadderError(f"{file}: cannot be written: {error.strerror}") from error


def main(arguments):
    options = parse(arguments)
    for name, _, words in rungs(options):
        print(as_typed(name, words))
    print(f"\n{'':<33} {'step':<15} {'mean':>9} {'step %':>8} {'SMAPE to':>8} {'SMAPE':>7} {'p95':>7} {'time':>7}")
    print(f"{'':<33} {'':<15} {'W/sr m2':>9} {'of R1':>8} {'before':>8} {'to R1':>7} {'to R1':>7} {'s':>7}", flush=True)
    with tempfile.TemporaryDirectory(prefix="ladder_") as folder:
        data = climb(options, Path(folder))
    total, added = data["total_percent"], data["sum_of_steps_percent"]
    error = data["standard_error_percent"]
    # Five rounded steps and the rounded total; the programs round each channel of a pixel to float as well.
    slack = 6 * STEP_ROUNDING
    print(f"\nsum of the steps {added:+.{DIGITS}f} %, R5 - R0 {total:+.{DIGITS}f} %: equal to rounding (+-{slack:.{DIGITS}f})"
          f"\nstandard error of the mean: R0 {error['R0']:.3f} %, R1 {error['R1']:.3f} %")
    if abs(added - total) > slack:
        raise LadderError(f"the steps add up to {added:+.{DIGITS}f} %, but R5 - R0 is {total:+.{DIGITS}f} %")
    if options.json:
        write_json(options.json, data)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except LadderError as failure:
        print(f"ladder: {failure}", file=sys.stderr)
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
