"""Runs the programs of the book for tools/report.py: renders, references with a cache, comparisons."""
import hashlib
import json
import os
import re
import shlex
import subprocess
import time
from pathlib import Path

CHAPTER = "14_speed_against_error"
SCENE_PASSES = {"voxelize", "average", "emitters"}  # once for a scene that stands still
LIGHT_PASSES = {"shadow maps", "voxel shading", "light pyramid", "further bounces"}  # when a light moves; all others: camera
BLOCK = 4  # pixels along a side of the blocks that are compared
NOISE_SHARE = 0.1  # of the error, above which a reference counts as noisy


class Failed(RuntimeError):
    """A program of the book ended with a code above 0."""


def file_hash(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]


def parameters_by_name(listing):
    """The defaults, from what --list-params prints."""
    return {line.split()[0]: line.split()[1] for line in listing.splitlines() if line.strip()}


class Bench:
    """The programs, and where their output goes. `size`: pixels along both sides of every picture."""

    def __init__(self, root, bin_folder, shared, output, size):
        self.root, self.bin, self.shared, self.output, self.size = root, bin_folder, shared, output, size
        self.references = output / "references"
        self.pictures = output / "pictures"
        for folder in (self.references, self.pictures):
            folder.mkdir(parents=True, exist_ok=True)
        self.environment = dict(os.environ, CONEBOOK_ROOT=str(root))
        self.environment.setdefault("MESA_SHADER_CACHE_DIR", str(bin_folder.parent / "shader_cache"))
        self.tracer_hash = file_hash(bin_folder / "reference")

    def run(self, program, *arguments):
        result = subprocess.run([str(self.bin / program), *map(str, arguments)], env=self.environment,
                                capture_output=True, text=True)
        if result.returncode:
            said = (result.stderr.strip().splitlines() or ["nothing was said"])[-1]
            raise Failed(f"{program} {shlex.join(map(str, arguments))}: code {result.returncode}: {said}")
        return result.stdout

    def defaults(self):
        return parameters_by_name(self.run(CHAPTER, "--list-params"))

    def scene_file(self, scene):
        from report_plan import OUTSIDE_SCENES
        return self.shared / OUTSIDE_SCENES[scene] if scene in OUTSIDE_SCENES else self.root / "assets" / f"{scene}.glb"

    def scene_name(self, scene):
        """As the reader types it."""
        from report_plan import OUTSIDE_SCENES
        return f"../shared/{OUTSIDE_SCENES[scene]}" if scene in OUTSIDE_SCENES else f"assets/{scene}.glb"

    def render(self, scene, settings, frames, count=True):
        """Render and time. Returns what --stats tells; the parts of the light are then in self.pictures."""
        picture = self.pictures / f"{scene}.exr"
        stats = self.pictures / f"{scene}.json"
        words = [f"{k}={v}" for k, v in settings.items()]
        words += ["voxelize_every_frame=on"] + (["count_fetches=on", "write_parts=on"] if count else [])
        common = ["--headless", "--size", f"{self.size}x{self.size}", "--frames", str(frames), "--set", *words]
        self.run(CHAPTER, "--scene", self.scene_file(scene), *common, "--output", picture, "--stats", stats)
        told = json.loads(stats.read_text())
        told["command"] = shlex.join(["./run", "14", "--scene", self.scene_name(scene), *common, "--print-stats"])
        return told

    def part_picture(self, scene, part):
        return self.pictures / f"{scene}_{part}.exr"

    def reference(self, scene, part, bounces, spp):
        """The path tracer's picture, from the cache where it is: dict of file, error file, seconds, black, command."""
        file = self.scene_file(scene)
        key = hashlib.sha256(json.dumps([file_hash(file), self.size, spp, bounces, part, self.tracer_hash]).encode())
        name = f"{scene}_{part}_{bounces}_{key.hexdigest()[:12]}"
        picture, errors, note = (self.references / (name + end) for end in (".exr", "_error.exr", ".json"))
        if not (picture.exists() and errors.exists() and note.exists()):
            options = ["--size", f"{self.size}x{self.size}", "--spp", spp, "--bounces", bounces, "--part", part]
            started = time.monotonic()
            said = self.run("reference", "--scene", file, *options, "--output", picture, "--error", errors)
            seconds = time.monotonic() - started
            means = re.search(r"mean radiance\s+(\S+) (\S+) (\S+)", said)
            command = shlex.join(["./run", "reference", "--scene", self.scene_name(scene), *map(str, options),
                                  "--output", "reference.exr", "--error", "error.exr"])
            note.write_text(json.dumps({"seconds": seconds, "spp": spp, "command": command,
                                        "black": all(float(m) == 0.0 for m in means.groups())}))
        return {"picture": picture, "error": errors, **json.loads(note.read_text())}

    def trace(self, scene, spp):
        """The path tracer with few samples: (picture, seconds, command). All bounces, another seed than the references."""
        picture = self.pictures / f"{scene}_traced.exr"
        options = ["--size", f"{self.size}x{self.size}", "--spp", spp, "--bounces", -1, "--seed", 1]
        started = time.monotonic()
        self.run("reference", "--scene", self.scene_file(scene), *options, "--output", picture)
        seconds = time.monotonic() - started
        command = shlex.join(["./run", "reference", "--scene", self.scene_name(scene), *map(str, options),
                              "--output", "traced.exr"])
        return picture, seconds, command

    def compare(self, picture, reference, flip=False, block=BLOCK):
        """The measures that the report keeps. Relative to the reference's mean, so that scenes can be compared."""
        result = self.pictures / "compare.json"
        self.run("compare", picture, reference["picture"], "--json", result, "--block", block, "--reference-error",
                 reference["error"], *([] if flip else ["--no-flip"]))
        m = json.loads(result.read_text())
        mean = m["mean_reference"]
        kept = {"signed_ratio": m["signed_ratio"], "smape": m["smape"], "nrmse": m["nrmse"],
                "p95": m["relative_error_p95"], "noise": m["noise_rms"] / mean,
                "nrmse_without_noise": m["rmse_without_noise"] / mean, "noisy_reference": m["noisy_reference"]}
        if flip:
            kept["flip"] = m["hdr_flip"]
        return kept

    def heat_map(self, picture, reference, output):
        self.run("compare", picture, reference["picture"], "--no-flip", "--heatmap", output)


def times_of(stats):
    """ms of every pass (the fastest frame's) and their sums: scene, light, camera, frame = light + camera, total."""
    passes = {p["name"]: p["min_ms"] for p in stats["passes"]}
    scene = sum(ms for name, ms in passes.items() if name in SCENE_PASSES)
    light = sum(ms for name, ms in passes.items() if name in LIGHT_PASSES)
    total = sum(passes.values())
    return {"ms": passes, "ms_scene": scene, "ms_light": light, "ms_camera": total - scene - light,
            "ms_frame": total - scene, "ms_total": total}


def counted(stats, name):
    return next((c["value"] for c in stats["counts"] if c["name"] == name), 0.0)


def machine(root, driver):
    """What the times were measured on."""
    cpu = "unknown"
    try:
        cpu = re.search(r"^model name\s*:\s*(.*)$", Path("/proc/cpuinfo").read_text(), re.M).group(1)
    except (OSError, AttributeError):
        pass

    def git(*words):
        try:
            return subprocess.run(["git", "-C", str(root), *words], capture_output=True, text=True).stdout.strip()
        except OSError:
            return ""
    changed = " with changes" if git("status", "--porcelain", "--untracked-files=no") else ""
    return {"cpu": cpu, "cores": os.cpu_count(), "driver": driver, "commit": (git("rev-parse", "HEAD") or "unknown") + changed,
            "date": time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime())}
