#!/usr/bin/env python3
"""Every shader text that the chapters load passes glslangValidator, a compiler that no driver of OpenGL's shares, as
OpenGL 4.5 core. Each chapter runs with every view and with every value of every choice that it brings, over scenes with
and without textures, masks, emission and specular lobes; gl::Shaders writes what it compiles (CONEBOOK_DUMP_SHADERS).

Usage: shader_variants_test.py BIN [CHAPTER...]    code 77: glslangValidator is not installed
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["cornell_box", "colonnade", "emissive_shapes", "materials"]
# Numbers that switch programs, besides the choices that --list-params names.
NUMBERS = ["depth_bits=12", "level=1", "bounces=0", "bounces=1", "sky=1", "sky=0", "aimed_rays=0", "aimed_rays=4",
           "specular_cones=4", "shadow_cones=1", "ao_strength=0.5", "bounce_strength=2"]
SMALL = ["--headless", "--size", "16x16"]
# Those that are refused without another setting.
TOGETHER = {"conservative=off": ["voxelizer=raster"]}
KEPT_SMALL = {"voxels": "voxels=16", "shadow_map_size": "shadow_map_size=64", "spp": "spp=1"}


def listed(program, option):
    """What the program prints for --list-views or --list-params: a line each, split into its columns."""
    text = subprocess.run([program, option], capture_output=True, text=True, check=True).stdout
    return [line for line in text.splitlines() if line.strip()]


def choices(program):
    """Of each parameter: its other values than the default, where --list-params names them."""
    found = {}
    for line in listed(program, "--list-params"):
        name, default, values = re.match(r"(\S+)\s+(\S+)\s+(\S+(?: \| \S+)*)", line).groups()
        values = values.split(" | ")
        found[name] = [value for value in values if value != default and not value.isdigit()] if len(values) > 1 else []
    return found


def runs_of(program, known_parameters, known_views):
    """The argument lists of one chapter's runs. What earlier chapters brought, they have tried."""
    parameters = choices(program)
    small = [KEPT_SMALL[name] for name in parameters if name in KEPT_SMALL]
    scene = lambda name: ["--scene", str(ROOT / "assets" / f"{name}.glb")]
    settings = lambda *more: ["--set", *small, *more] if small or more else []
    runs = [[*scene(name), *settings()] for name in SCENES]
    runs += [[*scene("materials"), "--view", view, *settings()]
             for view in (line.split()[0] for line in listed(program, "--list-views")) if view not in known_views]
    new = [f"{name}={value}" for name, values in parameters.items() if name not in known_parameters
           for value in values]
    new += [number for number in NUMBERS if number.split("=")[0] in parameters.keys() - known_parameters]
    runs += [[*scene("emissive_shapes"), *settings(setting, *TOGETHER.get(setting, []))] for setting in new]
    # And those of earlier chapters in this one's programs: the first other value of each at once, the second, ...
    old = {name: values for name, values in parameters.items() if name in known_parameters and values}
    for turn in range(max(map(len, old.values()), default=0)):
        setting = [f"{name}={values[turn % len(values)]}" for name, values in old.items()]
        runs.append([*scene("materials"), *settings(*setting)])
    known_parameters.update(parameters)
    known_views.update({line.split()[0] for line in listed(program, "--list-views")})
    return runs


def run(program, arguments, dump):
    environment = dict(os.environ, CONEBOOK_DUMP_SHADERS=str(dump), CONEBOOK_STRICT="0")
    result = subprocess.run([program, *SMALL, *arguments], env=environment, capture_output=True, text=True)
    return "" if result.returncode == 0 else f"{Path(program).name} {' '.join(arguments)}: {result.stderr.strip()}"


def check(file):
    """glslangValidator's complaints, with the names of the files instead of the numbers of source strings."""
    text = file.read_text()
    result = subprocess.run(["glslangValidator", str(file)], capture_output=True, text=True)
    sources = dict(re.findall(r"^// source string (\d+): (.*)$", text, re.M))
    complaints = [re.sub(r"^(ERROR|WARNING): (\d+):(\d+):", lambda m: f"{m[1]}: {sources.get(m[2], m[2])}:{m[3]}:", line)
                  for line in result.stdout.splitlines() if line.startswith(("ERROR", "WARNING"))]
    if result.returncode != 0 and not complaints:
        complaints = [f"{file.name}: code {result.returncode}: {result.stdout.strip()}"]
    return complaints


def main():
    if shutil.which("glslangValidator") is None:
        print("skipped: glslangValidator is not installed (package glslang-tools)")
        return 77
    binaries, wanted = Path(sys.argv[1]), sys.argv[2:]
    chapters = sorted(path.parent.name for path in (ROOT / "chapters").glob("*/main.cpp"))
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        parameters, views, jobs = set(), set(), []
        for chapter in chapters:
            runs = runs_of(str(binaries / chapter), parameters, views)
            if not wanted or chapter in wanted:
                jobs += [(str(binaries / chapter), arguments) for arguments in runs]
        failures = [text for text in pool.map(lambda job: run(*job, folder), jobs) if text]
        files = sorted(Path(folder).iterdir())
        of_all = list(pool.map(check, files))
        complaints = sorted({line for lines in of_all for line in lines if "compilation errors" not in line})
        bad = sum(1 for lines in of_all if lines)
        print("\n".join(failures + complaints))
    print(f"{len(jobs)} runs, {len(failures)} failed; {len(files)} shader texts, {bad} with complaints")
    return 1 if failures or bad or not files else 0


if __name__ == "__main__":
    sys.exit(main())
