"""Runs the programs of the book for tools/report.py: renders, references with a cache, comparisons."""
import hashlib
import json
import math
import os
import re
import shlex
import subprocess
import time
from pathlib import Path

CHAPTER = "14_speed_against_error"
BLOCK = 4  # pixels along a side of the blocks that are compared
NEAR, TRIES = 0.1, 5  # how near the path tracer's time is to be to the cones', and how often it may try
NOISE_SHARE = 0.1  # of the error, above which a reference counts as noisy


class Failed(RuntimeError):
    """A program of the book ended with a code above 0."""


def file_hash(path):
    return hashlib.sha256(Path(path).read_bytes()).hexdigest()[:16]


def parameters_by_name(listing):
    """The defaults, from what --list-params prints."""
    return {line.split()[0]: line.split()[1] for line in listing.splitlines() if line.strip()}


def timed_trace(said):
    """(samples a pixel, seconds for them, seconds in all) of what `reference` prints."""
    match = re.search(r"(\d+) samples per pixel, .*?(\S+) s for the samples, (\S+) s in all", said)
    if not match:
        raise Failed(f"reference printed no times: {said.strip()}")
    return int(match.group(1)), float(match.group(2)), float(match.group(3))


class Bench:
    """The programs, and where their output goes. `size`: WxH of every picture that names no other."""

    def __init__(self, root, bin_folder, shared, output, size):
        self.root, self.bin, self.shared, self.output, self.size = root, bin_folder, shared, output, size
        self.references = output / "references"
        self.pictures = output / "pictures"
        for folder in (self.references, self.pictures):
            folder.mkdir(parents=True, exist_ok=True)
        self.environment = dict(os.environ, CONEBOOK_ROOT=str(root))
        self.environment.setdefault("MESA_SHADER_CACHE_DIR", str(bin_folder.parent / "shader_cache"))
        self.tracer_hash = file_hash(bin_folder / "reference")
        self.found = {}

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

    def render(self, scene, settings, frames, size=None, count=True, parts=True):
        """Render and time. Returns what --stats tells; the parts of the light are then in self.pictures."""
        picture = self.pictures / f"{scene}.exr"
        stats = self.pictures / f"{scene}.json"
        words = [f"{k}={v}" for k, v in settings.items()]
        words += ["count_fetches=on"] * count + ["write_parts=on"] * parts
        common = ["--headless", "--size", size or self.size, "--frames", str(frames), "--set", *words]
        self.run(CHAPTER, "--scene", self.scene_file(scene), *common, "--output", picture, "--stats", stats)
        told = json.loads(stats.read_text())
        told["command"] = shlex.join(["./run", "14", "--scene", self.scene_name(scene), *common, "--print-stats"])
        return told

    def part_picture(self, scene, part):
        return self.pictures / f"{scene}_{part}.exr"

    def make_reference(self, scene, size, seconds, most_spp):
        """Trace for about so many seconds, all parts of the light, unless a trace with as many samples is kept."""
        key = hashlib.sha256(json.dumps([file_hash(self.scene_file(scene)), size, self.tracer_hash]).encode())
        stem = self.references / f"{scene}_{size}_{key.hexdigest()[:12]}"
        note = stem.with_suffix(".json")
        kept = json.loads(note.read_text()) if note.exists() else {"spp": 0, "asked_s": 0.0}
        if kept["spp"] < most_spp and kept["asked_s"] < 0.95 * seconds:
            options = ["--size", size, "--spp", most_spp, "--max-seconds", f"{seconds:.1f}", "--write-parts"]
            said = self.run("reference", "--scene", self.scene_file(scene), *options, "--output", f"{stem}.exr", "--error",
                            f"{stem}_error.exr")
            spp, traced, _ = timed_trace(said)
            command = shlex.join(["./run", "reference", "--scene", self.scene_name(scene), "--size", size, "--spp", str(spp),
                                  "--write-parts", "--output", "reference.exr", "--error", "reference_error.exr"])
            kept = {"spp": spp, "seconds": traced, "asked_s": seconds, "command": command}
            note.write_text(json.dumps(kept))
        self.found[scene, size] = {"stem": stem, **kept}
        return self.found[scene, size]

    def reference(self, scene, size=None):
        return self.found[scene, size or self.size]

    def trace_for(self, scene, size, target_ms, share):
        """The path tracer with the number of samples whose time is nearest to `target_ms`: (picture, samples, ms, command).

        Nearest to within a tenth, or the best of a few tries; at least one sample. Loading, building and making pictures of sums do not count."""
        spp, tried = 4, {}
        for _ in range(TRIES):
            picture, taken_ms, command = self.trace(scene, size, spp, share)
            tried[spp] = taken_ms
            closer = max(1, round(spp * target_ms / taken_ms))
            if abs(taken_ms / target_ms - 1) < NEAR or closer in tried:
                break
            spp = closer
        nearest = min(tried, key=lambda n: abs(math.log(tried[n] / target_ms)))
        if nearest != spp:
            picture, _, command = self.trace(scene, size, nearest, share)
        return picture, nearest, tried[nearest], command

    def trace(self, scene, size, spp, share):
        """The path tracer with few samples: (picture, ms of the samples, command). Another seed than the references'."""
        picture = self.pictures / f"{scene}_traced.exr"
        options = ["--size", size, "--spp", str(spp), "--bounces", "-1", "--seed", "1", *["--share"] * share]
        said = self.run("reference", "--scene", self.scene_file(scene), *options, "--output", picture)
        command = shlex.join(["./run", "reference", "--scene", self.scene_name(scene), *options, "--output", "traced.exr"])
        return picture, 1000 * timed_trace(said)[1], command

    def compare(self, picture, reference, part="final", flip=False, block=BLOCK):
        """The measures that the report keeps, or None where this part of the reference is black."""
        result = self.pictures / "compare.json"
        name = "" if part == "final" else f"_{part}"
        self.run("compare", picture, f"{reference['stem']}{name}.exr", "--json", result, "--block", block, "--reference-error",
                 f"{reference['stem']}{name}_error.exr", *([] if flip else ["--no-flip"]))
        m = json.loads(result.read_text())
        mean = m["mean_reference"]
        if not mean:
            return None
        kept = {"signed_ratio": m["signed_ratio"], "smape": m["smape"], "p95": m["relative_error_p95"], "nrmse": m["nrmse"],
                "noise": m["noise_smape"], "noisy": m["noise_smape"] > NOISE_SHARE * m["smape"]}
        if flip:
            kept["flip"] = m["hdr_flip"]
        return kept

    def heat_map(self, picture, reference, output):
        self.run("compare", picture, f"{reference['stem']}.exr", "--no-flip", "--heatmap", output)


def times_of(stats):
    """ms of every pass (the fastest frame's) and their sums by scope: scene (once, or when triangles move), light (when a
    light moves), camera (every frame); frame = light + camera: every frame when lights move."""
    sums = {"scene": 0.0, "light": 0.0, "camera": 0.0}
    for p in stats["passes"]:
        sums[p["scope"]] += p["min_ms"]
    return {"ms": {p["name"]: p["min_ms"] for p in stats["passes"]},
            "scopes": {p["name"]: p["scope"] for p in stats["passes"]},
            "ms_scene": sums["scene"], "ms_light": sums["light"], "ms_camera": sums["camera"],
            "ms_frame": sums["light"] + sums["camera"], "ms_total": sum(sums.values())}


COUNTS = {"points_per_pixel": "points that gather, per pixel", "steps": "walk steps per point, diffuse",
          "fetches": "fetches per point, diffuse", "specular_steps": "walk steps per pixel, specular",
          "specular_fetches": "fetches per pixel, specular"}


def counts_of(stats):
    """What the cones look up: see chapters/14_speed_against_error/fetch_counter.hpp."""
    by_name = {c["name"]: c["value"] for c in stats["counts"]}
    return {key: by_name.get(name, 0.0) for key, name in COUNTS.items()}


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
    load = os.getloadavg()[0]
    return {"cpu": cpu, "cores": os.cpu_count(), "driver": driver, "commit": (git("rev-parse", "HEAD") or "unknown") + changed,
            "load": load, "date": time.strftime("%Y-%m-%d %H:%M UTC", time.gmtime())}
