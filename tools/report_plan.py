"""What the report measures: rows, each a scene and the parameters that differ from the baseline's."""
import itertools
import math
from dataclasses import dataclass, field

CORE_SCENES = ["cornell_box", "cornell_area", "colonnade", "glossy_room"]
OUTSIDE_SCENES = {"sponza": "scenes/sponza_crytek.glb"}  # in the folder of real scenes, where there is one
LARGE_SCENE, LARGE_SIZE = "cornell_box", "1280x720"  # one row of this size against the path tracer

PARTS = ["final", "direct", "indirect_diffuse", "indirect_specular"]
# What a parameter can change; every other one changes all that comes by way of the voxels.
CHANGES_ONLY = {"shadows": ["final", "direct"], "light_radius": [], "light_angle": [], "accumulate": [],
                "aimed_rays": ["final", "indirect_diffuse"], "specular_cones": ["final", "indirect_specular"],
                "gather_scale": ["final", "indirect_diffuse"]}
INDIRECT = ["final", "indirect_diffuse", "indirect_specular"]

# A frame by itself in which everything is made anew: what a frame takes in which objects and lights move, and its error
# without the mean of many.
ALONE = {"update": "always", "accumulate": "off"}
# The path tracer's lights have no size: cones to them are made as narrow as they can be, so that what is measured is the
# method and not a penumbra.
NARROW_LIGHTS = {"light_radius": "0.001", "light_angle": "0.05"}
MARCH = {"walk": "march"}

SWEEPS = {
    "walk": [{"walk": w} for w in ("leap", "march")],
    "gather_scale": [{"gather_scale": s} for s in ("1", "2", "4")],
    "cones": [{"cones": c} for c in ("1", "5", "6", "9", "16", "32")],
    "interleave": [{"interleave": i} for i in ("off", "on", "every_pixel")],
    "links": [{"links": n} for n in ("1", "5", "9", "16")],
    "voxels": [{"voxels": v} for v in ("32", "64", "128", "256")],
    "bounces": [{"bounces": b} for b in ("0", "1", "2", "4", "-1")],
    "aperture": [{"aperture": a} for a in ("0", "3", "10", "20")],
    "start_offset": [{"start_offset": o} for o in ("0.25", "0.75", "1.5")],
    "step": [{"step": s, **MARCH} for s in ("0.5", "1", "2")],
    "directions": [{"directions": d, **MARCH} for d in ("per_face", "anisotropic", "isotropic")],
    "format": [{"format": f} for f in ("rgba16f", "rgba8", "r11g11b10f")],
    "shadows": [{"shadows": "map"}, {"shadows": "cone", **NARROW_LIGHTS}, {"shadows": "volume"}],
}
# Of parameters that the other scenes have no use for.
SCENE_SWEEPS = {
    "cornell_area": {"aimed_rays": [{"aimed_rays": n} for n in ("0", "2", "6", "16")]},
    "glossy_room": {"specular_cones": [{"specular_cones": n} for n in ("1", "2", "4", "8")]},
}
GRID = [
    {"voxels": "32", "cones": "6", "gather_scale": "4", "links": "1"},
    {"voxels": "64", "cones": "6", "gather_scale": "4"},
    {"voxels": "64", "cones": "16", "gather_scale": "4"},
    {"voxels": "64", "cones": "32"},
    {"cones": "32", "links": "16"},
    {"cones": "32", "links": "16", "gather_scale": "1"},
]

OVERHEAD_S = 2.5  # of a row, beside its frames
# Left out last when time is short: what the page's conclusions speak of.
WANTED = ("baseline", "walk=march", "bounces=1", "bounces=2", "voxels=64", "cones=32", "gather_scale=1", "links=1")
# About how many times the baseline's time a setting takes; only the number of frames depends on it.
SLOW_SETTINGS = {("voxels", "256"): 8.0, ("voxels", "64"): 0.5, ("voxels", "32"): 0.4, ("bounces", "0"): 0.1,
                 ("bounces", "1"): 0.5, ("cones", "32"): 1.5, ("step", "0.5"): 2.0, ("walk", "march"): 8.0,
                 ("interleave", "every_pixel"): 12.0, ("gather_scale", "1"): 2.0, ("links", "16"): 1.5}

QUICK_SCENES = ["cornell_box", "glossy_room"]
QUICK_BASE = {"voxels": "32"}
QUICK_SWEEPS = {
    "voxels": [{"voxels": v} for v in ("16", "32")],
    "walk": SWEEPS["walk"],
    "cones": [{"cones": c} for c in ("6", "16")],
    "bounces": [{"bounces": b} for b in ("0", "2", "-1")],
    "shadows": [{"shadows": "map"}, {"shadows": "cone", **NARROW_LIGHTS}],
}
QUICK_GRID = [{"voxels": "16", "gather_scale": "4"}]

# Sponza takes long: few rows, of what matters most.
OUTSIDE_SWEEPS = {
    "voxels": [{"voxels": v} for v in ("64", "128", "256")],
    "walk": SWEEPS["walk"],
    "cones": [{"cones": c} for c in ("16", "32")],
    "gather_scale": [{"gather_scale": s} for s in ("1", "2")],
    "links": [{"links": n} for n in ("1", "5")],
    "bounces": [{"bounces": b} for b in ("1", "2", "-1")],
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
        return max(1, min(most, 3 if expected_ms < 700 else 2 if expected_ms < 2000 else 1))

    def expected_ms(self, baseline_ms):
        """A guess at the time of a frame."""
        return baseline_ms * math.prod(SLOW_SETTINGS.get(item, 1.0) for item in self.settings.items())

    def expected_seconds(self, most_frames, baseline_ms):
        """A guess at the time until the row is measured: frames, counting of look-ups, comparing."""
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
    size: str           # WxH
    large_size: str     # of the one large row
    frames: int
    most_spp: int       # of the references, where there is time for it
    drift_every: int    # rows between two runs of the baseline
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
    base = {**ALONE, **(QUICK_BASE if quick else {})}
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
        return Plan(used, base, "48x48", "96x54", 2, 64, 4, rows)
    return Plan(used, base, "256x256", LARGE_SIZE, 3, 4096, 9, rows)
