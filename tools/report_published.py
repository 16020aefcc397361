"""The experiments of Villegas 2016 (chapter 4.3) that can be repeated: its published times as ratios, and ours beside them.

Its own milliseconds are of one graphics processor of 2016: only ratios within a row are compared. Its settings are
ours that come nearest: six wide cones from every pixel that march, nothing shared, two bounces. It measures 256^3 voxels at
1280 x 720; here the defaults' 128^3 and the report's size.
"""
from report_measure import Failed

THESIS = {"walk": "march", "interleave": "off", "cones": "6", "cone_table": "thesis", "aperture": "60", "step": "0.5",
          "bounces": "2"}
SCENES = ("cornell_box", "sponza")  # those of its scenes that this project has; others are not in the folder of real scenes

# What is swept: label, settings; the sum of which passes is compared, or bytes; published ms (MB) by scene.
EXPERIMENTS = [
    {"name": "step of a cone, over its width", "table": "table 6", "passes": ("diffuse cones", "specular cones"),
     "unit": "0.5", "values": [(s, {"step": s}) for s in ("0.1", "0.25", "0.5", "2.5")],
     "published": {"cornell_box": (26.80, 11.57, 7.23, 2.68), "sponza": (29.81, 12.92, 7.01, 2.81)}},
    {"name": "pixels", "table": "table 5", "passes": ("diffuse cones", "specular cones"), "unit": "1",
     "values": [("1", {}), ("2.25", {"size": 1.5})],
     "published": {"cornell_box": (7.23, 15.17), "sponza": (7.01, 16.69)}},
    {"name": "voxels: cones", "table": "tables 3 and 4", "passes": ("diffuse cones", "specular cones"), "unit": "256",
     "values": [(v, {"voxels": v}) for v in ("64", "128", "256")],
     "published": {"cornell_box": (4.79, 5.75, 7.23), "sponza": (5.49, 5.47, 7.01)}},
    {"name": "voxels: memory", "table": "table 10", "passes": "bytes", "unit": "256",
     "values": [(v, {"voxels": v}) for v in ("64", "128", "256")],
     "published": {"cornell_box": (216.7, 253.0, 540.3), "sponza": (216.7, 253.0, 540.3)}},
    {"name": "shadows on voxels", "table": "table 7", "passes": ("voxel shading",), "unit": "none",
     "values": [(v, {"voxel_shadows": v}) for v in ("none", "hard_ray")],
     "published": {"cornell_box": (1.33, 20.32), "sponza": (1.13, 3.31)}},
    {"name": "shadows of pixels", "table": "table 8", "passes": ("direct light", "diffuse cones", "specular cones"),
     "unit": "map", "values": [(v, {"shadows": v}) for v in ("map", "volume", "cone")],
     "published": {"cornell_box": (7.23, 6.50, 10.31), "sponza": (7.01, 6.28, 8.30)}},
]


def sized(size, factor):
    return "x".join(str(round(int(n) * factor)) for n in size.split("x"))


def repeat(bench, plan, scene, experiments, deadline_passed, say):
    """The rows of `experiments` on one scene: dicts of experiment, label, published, ours (both over the unit's), SMAPE.

    `bench.render` and `bench.errors` measure; a render that two experiments share is made once.
    """
    rows, seen = [], {}
    reference = bench.reference(scene, plan.size)
    for experiment in experiments:
        measured = {}
        for label, change in experiment["values"]:
            if deadline_passed():
                return rows
            change = dict(change)
            size = sized(plan.size, change.pop("size", 1.0))
            settings = {**plan.base, **THESIS, **change}
            key = size, tuple(sorted(settings.items()))
            if key not in seen:
                try:
                    stats = bench.render(scene, settings, 1 if settings["step"] == "0.1" else 2, size=size, count=False,
                                         parts=size == plan.size)
                except Failed as fault:
                    say(f"{scene}, {experiment['name']} {label}: {fault}")
                    continue
                error = bench.compare(bench.part_picture(scene, "final"), reference, "final") if size == plan.size else None
                seen[key] = stats, error
            stats, error = seen[key]
            value = sum(r["bytes"] for r in stats["resources"]) if experiment["passes"] == "bytes" else \
                sum(p["min_ms"] for p in stats["passes"] if p["name"] in experiment["passes"])
            measured[label] = value, error
        unit = measured.get(experiment["unit"])
        labels = [label for label, _ in experiment["values"]]
        published = dict(zip(labels, experiment["published"][scene]))
        for label, (value, error) in measured.items() if unit and unit[0] > 0 else ():
            rows.append({"scene": scene, "experiment": experiment["name"], "table": experiment["table"], "label": label,
                         "published": published[label] / published[experiment["unit"]], "ours": value / unit[0],
                         "value": value, "smape": error and error["smape"]})
        say(f"{scene}: {experiment['name']}, {len(measured)} values")
    return rows
