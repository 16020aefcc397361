"""What the report measures: rows, each a scene and the parameters that differ from the baseline's."""
import itertools
import math
from dataclasses import dataclass, field

CORE_SCENES = ["cornell_box", "cornell_area", "colonnade", "glossy_room"]
OUTSIDE_SCENES = {"sponza": "scenes/sponza_crytek.glb"}  # in the folder of real scenes, where there is one

PARTS = ["direct", "indirect_diffuse", "indirect_specular", "final"]
# What a parameter can change; every other one changes all that comes by way of the voxels.
CHANGES_ONLY = {"shadows": ["direct", "final"], "light_radius": [], "light_angle": [],
                "aimed_rays": ["indirect_diffuse", "final"], "specular_cones": ["indirect_specular", "final"]}
INDIRECT = ["indirect_diffuse", "indirect_specular", "final"]

# The path tracer's lights have no size: cones to them are made as narrow as they can be, so that what is measured is the
# method and not a penumbra.
NARROW_LIGHTS = {"light_radius": "0.001", "light_angle": "0.05"}

SWEEPS = {
    "voxels": [{"voxels": v} for v in ("32", "64", "128", "256")],
    "cones": [{"cones": c, "interleave": i} for i in ("on", "off") for c in ("5", "6", "9", "16", "32")],
    "aperture": [{"aperture": a} for a in ("3", "10", "20", "40")],
    "step": [{"step": s} for s in ("0.25", "0.5", "1", "2")],
    "start_offset": [{"start_offset": o} for o in ("0.25", "0.75", "1.5")],
    "directions": [{"directions": d} for d in ("per_face", "anisotropic", "isotropic")],
    "format": [{"format": f} for f in ("rgba16f", "rgba8", "r11g11b10f")],
    "bounces": [{"bounces": b} for b in ("0", "1", "2", "3", "4", "-1")],
    "shadows": [{"shadows": "map"}, {"shadows": "cone", **NARROW_LIGHTS}, {"shadows": "volume"}],
}
# Of parameters that the other scenes have no use for.
SCENE_SWEEPS = {
    "cornell_area": {"aimed_rays": [{"aimed_rays": n} for n in ("0", "2", "6", "16")]},
    "glossy_room": {"specular_cones": [{"specular_cones": n} for n in ("1", "2", "4", "8")]},
}
GRID = [
    {"voxels": "32", "cones": "5", "interleave": "off", "step": "2", "bounces": "1"},
    {"voxels": "32", "cones": "5", "step": "2", "bounces": "1"},
    {"voxels": "32", "aperture": "20", "bounces": "-1"},
    {"voxels": "32", "cones": "16", "bounces": "-1"},
    {"voxels": "64", "cones": "5", "interleave": "off", "step": "2", "bounces": "1"},
    {"voxels": "64", "aperture": "20", "bounces": "-1"},
    {"voxels": "64", "step": "2", "bounces": "-1"},
    {"voxels": "64", "bounces": "-1"},
    {"voxels": "64", "cones": "16", "bounces": "-1"},
    {"cones": "16", "bounces": "-1"},
]

OVERHEAD_S = 3.0  # of a row, beside its frames
# Left out last when time is short: the ends of the sweeps that everybody asks for.
WANTED = ("baseline", "voxels=256", "bounces=-1")
# About how many times the baseline's time a setting takes; only the number of frames depends on it.
SLOW_SETTINGS = {("voxels", "256"): 8.0, ("voxels", "64"): 0.5, ("voxels", "32"): 0.3, ("bounces", "-1"): 5.0,
                 ("bounces", "4"): 3.0, ("bounces", "1"): 0.4, ("cones", "16"): 2.5, ("cones", "32"): 5.0, ("step", "0.25"): 3.0,
                 ("interleave", "off"): 0.5, ("format", "r11g11b10f"): 2.5}

QUICK_SCENES = ["cornell_box", "glossy_room"]
QUICK_BASE = {"voxels": "48"}
QUICK_SWEEPS = {
    "voxels": [{"voxels": v} for v in ("24", "32", "48")],
    "cones": [{"cones": "6", "interleave": "on"}, {"cones": "5", "interleave": "on"}, {"cones": "6", "interleave": "off"}],
    "step": [{"step": s} for s in ("1", "2")],
    "directions": [{"directions": d} for d in ("per_face", "isotropic")],
    "format": [{"format": f} for f in ("rgba16f", "rgba8")],
    "bounces": [{"bounces": b} for b in ("0", "1", "2", "-1")],
    "shadows": [{"shadows": "map"}, {"shadows": "cone", **NARROW_LIGHTS}],
}
QUICK_GRID = [{"voxels": "24", "step": "2", "bounces": "1"}]

# Sponza takes long: few rows, of what matters most.
OUTSIDE_SWEEPS = {
    "voxels": [{"voxels": v} for v in ("64", "128", "256")],
    "cones": [{"cones": "16"}],
    "directions": [{"directions": "isotropic"}],
    "bounces": [{"bounces": "1"}, {"bounces": "-1"}],
}


@dataclass
class Row:
    scene: str
    settings: dict                              # what differs from the baseline; empty for the baseline itself
    sweeps: list = field(default_factory=list)  # the sweeps that it belongs to

    def frames(self, most, baseline_ms):
        """Frames to take the fastest of, fewer where they take seconds. `baseline_ms`: a frame of the baseline's, or None."""
        if baseline_ms is None:
            return most
        expected_ms = self.expected_ms(baseline_ms)
        return max(1, min(most, 3 if expected_ms < 700 else 2 if expected_ms < 3000 else 1))

    def expected_ms(self, baseline_ms):
        """A guess at the time of a frame."""
        return baseline_ms * math.prod(SLOW_SETTINGS.get(item, 1.0) for item in self.settings.items())

    def expected_seconds(self, most_frames, baseline_ms):
        """A guess at the time until the row is measured: frames, counting of fetches, comparing."""
        counting = 0.5
        return OVERHEAD_S + (self.frames(most_frames, baseline_ms) + counting) * self.expected_ms(baseline_ms) / 1000

    @property
    def setting(self):
        return " ".join(f"{k}={v}" for k, v in self.settings.items()) or "baseline"

    @property
    def id(self):
        return f"{self.scene}/{self.setting.replace(' ', ',')}"

    def parts(self):
        """Parts of the light that can differ from the baseline's."""
        if not self.settings:
            return list(PARTS)
        changed = {part for name in self.settings for part in CHANGES_ONLY.get(name, INDIRECT)}
        return [part for part in PARTS if part in changed]


@dataclass
class Plan:
    scenes: list
    base: dict          # parameters that all rows share and that are not the program's defaults
    size: int           # pixels along both sides
    frames: int
    spp: dict           # of the references, by part
    drift_every: int    # rows between two runs of the baseline
    path_tracer_rows: int
    rows: list


def same(a, b):
    """Whether two parameter values as text mean the same."""
    try:
        return float(a) == float(b)
    except ValueError:
        return a == b


def rows_of(scene, sweeps, grid, defaults):
    """The rows of one scene. `defaults` are the baseline's values: a setting that equals them is the baseline."""
    rows = {}
    sources = itertools.chain(((name, s) for name, values in sweeps.items() for s in values),
                              (("grid", s) for s in grid))
    baseline = Row(scene, {})
    rows[baseline.setting] = baseline
    for sweep, settings in sources:
        differing = {k: v for k, v in settings.items() if not same(v, defaults.get(k, ""))}
        if set(differing) <= set(NARROW_LIGHTS):
            differing = {}
        row = rows.setdefault(Row(scene, differing).setting, Row(scene, differing))
        if sweep not in row.sweeps:
            row.sweeps.append(sweep)
    return list(rows.values())


def fitting(rows, seconds, most_frames, baseline_ms):
    """The rows that can be measured in so many seconds, in their order, and those that are left out: the slowest of the
    grid first, then the slowest others, those of WANTED last, and never the baseline."""
    def rank(row):
        return row.setting in WANTED, row.sweeps != ["grid"], -row.expected_seconds(most_frames, baseline_ms)
    left_out = []
    for row in sorted((r for r in rows if r.settings), key=rank):
        kept = [r for r in rows if r not in left_out]
        if sum(r.expected_seconds(most_frames, baseline_ms) for r in kept) <= seconds:
            break
        left_out.append(row)
    return [r for r in rows if r not in left_out], left_out


def make_plan(quick, scenes, defaults, shared):
    """`defaults`: the program's parameters by name. `shared`: folder of real scenes, or None."""
    base = dict(QUICK_BASE if quick else {})
    baseline = {**defaults, **base}
    chosen = scenes or (QUICK_SCENES if quick else CORE_SCENES + list(OUTSIDE_SCENES))
    rows = []
    used = []
    for scene in chosen:
        if scene in OUTSIDE_SCENES:
            if shared is None or not (shared / OUTSIDE_SCENES[scene]).exists():
                print(f"report: {scene} is left out: there is no {OUTSIDE_SCENES[scene]} in the folder of real scenes")
                continue
            rows += rows_of(scene, OUTSIDE_SWEEPS, [], baseline)
        elif scene not in CORE_SCENES:
            raise ValueError(f"--scenes: {scene} is none of {', '.join(CORE_SCENES + list(OUTSIDE_SCENES))}")
        else:
            sweeps = QUICK_SWEEPS if quick else {**SWEEPS, **SCENE_SWEEPS.get(scene, {})}
            rows += rows_of(scene, sweeps, QUICK_GRID if quick else GRID, baseline)
        used.append(scene)
    if quick:
        return Plan(used, base, 64, 2, {"direct": 64, "indirect_diffuse": 128, "indirect_specular": 64, "final": 128},
                    6, 2, rows)
    return Plan(used, base, 256, 3,
                {"direct": 64, "indirect_diffuse": 512, "indirect_specular": 256, "final": 384}, 9, 5, rows)
