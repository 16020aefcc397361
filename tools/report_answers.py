"""What docs/14_speed_against_error.md says: words, numbers and tables made of the rows of a report.

Every sentence is chosen by the data, so that it stays true when they change.
"""
from report_analysis import Report, error

PART_NAMES = {"direct": "direct", "indirect_diffuse": "indirect diffuse", "indirect_specular": "indirect specular",
              "final": "final, same bounces", "final_all": "final, all bounces"}


def ms(value):
    return f"{value:.0f} ms" if value >= 100 else f"{value:.1f} ms"


def share(value):
    """An error, or nothing where there is none."""
    return "-" if value is None else f"{value:.3f}" if abs(value) < 9.9995 else f"{value:.3g}"


def factor(value):
    return f"{value:.2f}" if value < 9.995 else f"{value:.3g}"


def megabytes(value):
    return f"{value / 1e6:.0f} MB"


def code(setting):
    return "the baseline" if setting == "baseline" else f"`{setting}`"


def joined(words):
    words = list(words)
    return words[0] if len(words) == 1 else ", ".join(words[:-1]) + " and " + words[-1]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(["", *lines, *("| " + " | ".join(map(str, row)) + " |" for row in rows), ""])


class Answers:
    """The functions that the marks of the page call by name."""

    def __init__(self, data):
        self.report = Report(data)
        self.data = data

    # --- The run ---

    def machine(self):
        m = self.data["machine"]
        return f"{m['cpu']}, {m['cores']} cores, {m['driver']}; commit {m['commit'][:10]}{m['commit'][40:]}, {m['date']}"

    def kind_of_run(self):
        return "a quick run, which only shows that all works" if self.data["quick"] else "a full run"

    def duration(self):
        return f"{self.data['seconds'] / 60:.0f} minutes"

    def row_count(self):
        return str(len(self.data["rows"]))

    def pixels(self):
        return f"{self.data['size']} x {self.data['size']}"

    def block(self):
        return f"{self.data['block']} x {self.data['block']}"

    def frames(self):
        return str(self.data["frames"])

    def scene_names(self):
        return joined(f"`{s}`" for s in self.report.scenes)

    def baseline_parameters(self):
        return " ".join(f"{k}={v}" for k, v in self.data["baseline"].items() if not k.startswith("light_"))

    def left_out(self):
        names = self.data.get("left_out", [])
        return "No row was left out for want of time" if not names else \
            f"{len(names)} rows were left out for want of time: " + joined(f"`{name}`" for name in names)

    def drift(self):
        """How much the baseline's own time moves through the run."""
        spread = {}
        for scene in self.report.scenes:
            times = [self.report.row(scene)["ms_frame"]] + [d["ms_frame"] for d in self.report.drift if d["scene"] == scene]
            spread[scene] = max(times) / min(times)
        worst = max(spread, key=spread.get)
        return (f"Through this run the baseline's own time moved by up to a factor of {factor(spread[worst])} (`{worst}`): "
                f"smaller differences between rows of that scene mean nothing")

    def noise(self):
        measured = [(r["id"], p, e["noise"], e["nrmse"]) for r in self.report.rows for p, e in r["errors"].items()
                    if e and "same_as" not in e and p != "final_all_pixels"]
        noisy = len(self.data["noisy"])
        worst = max(measured, key=lambda m: m[2])
        return (f"In {noisy} of {len(measured)} comparisons the reference's noise is above a tenth of the error "
                f"(`noisy_reference` in the data; most in row `{worst[0]}`, {PART_NAMES[worst[1]]}: {worst[2]:.3f} of the mean)")

    # --- What to use ---

    def _of(self, s):
        return f"{ms(s['ms'])} and {share(s['error'])}"

    def budget(self, limit):
        best, base = self.report.within(limit), self.report.baseline()
        rows = "rows `*/" + (best or self.report.fastest())["setting"].replace(" ", ",") + "`"
        if best is None:
            fastest = self.report.fastest()
            return (f"{limit} ms: nothing fits on this machine. The nearest is {code(fastest['setting'])} ({rows}) with {self._of(fastest)}: "
                    f"{factor(fastest['ms'] / limit)} times the budget")
        if best["setting"] == "baseline":
            return f"{limit} ms: the defaults ({rows}): {self._of(best)}; no setting that is as fast comes nearer"
        return (f"{limit} ms: {code(best['setting'])} ({rows}): {self._of(best)}; that is {factor(best['ms'] / base['ms'])} of the "
                f"baseline's time and {factor(best['error'] / base['error'])} of its error")

    def half_the_error(self):
        pairs = self.report.halvings()
        if not pairs:
            front = self.report.front()
            return (f"no setting of this report has half the error of the fastest: from {code(front[0]['setting'])} "
                    f"({self._of(front[0])}) to {code(front[-1]['setting'])} ({self._of(front[-1])}) the error falls to "
                    f"{factor(front[-1]['error'] / front[0]['error'])} of it, for {factor(front[-1]['ms'] / front[0]['ms'])} times the time")
        steps = [f"from {code(a['setting'])} ({self._of(a)}) to {code(b['setting'])} ({self._of(b)}): "
                 f"{factor(b['ms'] / a['ms'])} times the time" for a, b in pairs]
        best, last = self.report.most_accurate(), pairs[-1][1]
        end = f"; below half of {share(last['error'])} no setting comes: the most accurate has {share(best['error'])}"
        return "; ".join(steps) + end

    def not_worth(self):
        found = self.report.not_worth()
        if not found:
            return "Every single change that takes longer than the baseline also has less error."
        base = self.report.baseline()
        rows = sorted(found, key=lambda s: -s["relative_time"])
        return table(["setting", "time over the baseline's", "error over the baseline's"],
                     [[f"`{s['setting']}`", factor(s["relative_time"]), factor(s["error"] / base["error"])] for s in rows])

    def bargains(self):
        found = self.report.bargains()
        if not found:
            return "No single change saves a tenth of the time without a twentieth more error."
        base = self.report.baseline()
        rows = sorted(found, key=lambda s: s["relative_time"])
        return table(["setting", "time over the baseline's", "error over the baseline's"],
                     [[f"`{s['setting']}`", factor(s["relative_time"]), factor(s["error"] / base["error"])] for s in rows])

    def defaults_on_front(self):
        base, front = self.report.baseline(), self.report.front()
        if any(s["setting"] == "baseline" for s in front):
            return "The defaults (rows `*/baseline`) are on the front"
        better = [s for s in front if s["ms"] <= base["ms"] and s["error"] <= base["error"]]
        nearest = min(better, key=lambda s: s["error"])
        return (f"The defaults (rows `*/baseline`, {self._of(base)}) are not on the front: {code(nearest['setting'])} "
                f"is no slower and no worse ({self._of(nearest)})")

    def front_table(self):
        return table(["setting", "ms a frame", "time over the baseline's", "SMAPE", "fetches a pixel", "memory"],
                     [[f"`{s['setting']}`", f"{s['ms']:.0f}", factor(s["relative_time"]), share(s["error"]), f"{s['fetches']:.0f}",
                       megabytes(s["bytes"])] for s in self.report.front()])

    # --- The path tracer ---

    def equal_time(self):
        pairs = self.report.equal_time()
        if not pairs:
            return "This run has no rows of the path tracer."
        by_blocks = sum(error(t) < error(r) for r, t in pairs)
        by_pixels = sum(error(t, "final_all_pixels") < error(r, "final_all_pixels") for r, t in pairs)
        best = min(pairs, key=lambda p: error(p[0]) / error(p[1]))
        worst = max(pairs, key=lambda p: error(p[0]) / error(p[1]))
        software = "llvmpipe" in self.data["machine"]["driver"]
        note = " Both ran on the same cores: a graphics processor would trace the cones much faster, and leave the path tracer as it is." \
            if software else ""
        return (f"In the time of the cones' row the path tracer has less error in {by_blocks} of {len(pairs)} rows when blocks of "
                f"pixels are compared, which average its noise, and in {by_pixels} of {len(pairs)} pixel by pixel. The error of the "
                f"cones over the path tracer's runs from {factor(error(best[0]) / error(best[1]))} (`{best[0]['id']}`) to "
                f"{factor(error(worst[0]) / error(worst[1]))} (`{worst[0]['id']}`).{note}")

    def best_at_equal_time(self):
        sentences = []
        for scene in self.report.core:
            pairs = [p for p in self.report.equal_time() if p[0]["scene"] == scene]
            if pairs:
                row, traced = min(pairs, key=lambda p: error(p[0]))
                sentences.append(f"`{row['id']}` has {share(error(row))}, the path tracer in its {ms(row['ms_total'])} "
                                 f"({traced['spp']} samples a pixel) {share(error(traced))}")
        return "; ".join(sentences) if sentences else "not measured in this run"

    def equal_time_table(self):
        rows = [[f"`{r['id']}`", f"{r['ms_total']:.0f}", share(error(r)), share(error(r, "final_all_pixels")), t["spp"],
                 share(error(t)), share(error(t, "final_all_pixels"))] for r, t in self.report.equal_time()]
        return table(["row", "ms, all passes", "SMAPE, blocks", "SMAPE, pixels", "path tracer: samples a pixel", "SMAPE, blocks",
                      "SMAPE, pixels"], rows)

    # --- Sweeps ---

    def _trend(self, slope):
        return "falls" if slope < -0.05 else "grows" if slope > 0.05 else "hardly changes"

    def slopes(self):
        found = [(scene, self.report.slope(scene)) for scene in self.report.scenes]
        words = [f"on `{scene}` it {self._trend(p)}, as N to the power of {p:.2f}" for scene, p in found if p is not None]
        return joined(words) if words else "not measured in this run"

    def voxel_table(self):
        rows = []
        for scene in self.report.scenes:
            for r in self.report.sweep(scene, "voxels"):
                rows.append([f"`{r['id']}`", r["parameters"]["voxels"], f"{r['ms_steady']:.0f}", f"{r['ms_scene']:.0f}",
                             megabytes(r["bytes"]), *(share(error(r, "indirect_diffuse", m)) for m in ("signed_ratio", "smape", "p95"))])
        return table(["row", "N", "ms a frame", "ms to voxelize", "memory", "signed ratio", "SMAPE", "95th percentile"], rows)

    def sweep_table(self, name, part="indirect_diffuse"):
        """Means over the core scenes."""
        report = self.report
        values = list(dict.fromkeys(r["sweep_values"][name] for s in report.core for r in report.sweep(s, name)))
        values.sort(key=lambda v: report.data["sweep_order"][name].index(v) if v in report.data["sweep_order"][name] else 99)
        if not values:
            return "Not measured in this run."
        rows = []
        for value in values:
            found = [r for s in report.core for r in report.sweep(s, name) if r["sweep_values"][name] == value]
            mark = " (baseline)" if any(not set(r["setting"].split()) - {"baseline"} for r in found) else ""

            def mean(part, measure, rows=found):
                known = [error(r, part, measure) for r in rows if error(r, part, measure) is not None]
                return share(sum(known) / len(known)) if known else "-"
            rows.append([value + mark, factor(sum(r["relative_time"] for r in found) / len(found)),
                         f"{sum(r['fetches'] for r in found) / len(found):.0f}", mean(part, "signed_ratio"), mean(part, "smape"),
                         mean(part, "p95"), mean("final_all", "smape")])
        return table([name.replace("_", " "), "time over the baseline's", "fetches a pixel", "signed ratio", "SMAPE", "95th percentile",
                      "SMAPE of all light"], rows)

    def direction_words(self):
        """What telling directions apart buys, in one sentence."""
        settings = {s["setting"]: s for s in self.report.settings()}
        base = settings["baseline"]
        words = [f"`{name}` has {factor(settings[f'directions={name}']['error'] / base['error'])} times the error in "
                 f"{factor(settings[f'directions={name}']['relative_time'])} of the time" for name in ("anisotropic", "isotropic")
                 if f"directions={name}" in settings]
        return "Against the baseline, " + joined(words) if words else "Not measured in this run"

    def parts_table(self):
        rows = []
        for scene in self.report.scenes:
            row = self.report.row(scene)
            for part, name in PART_NAMES.items():
                e = row["errors"].get(part)
                if e:
                    rows.append([f"`{scene}`", name, *(share(e[m]) for m in ("signed_ratio", "smape", "nrmse", "p95")),
                                 share(e.get("flip")), share(e["noise"])])
        return table(["scene", "part", "signed ratio", "SMAPE", "NRMSE", "95th percentile", "FLIP", "reference's noise"], rows)

    def ladder_figure(self):
        return "![what each shortcut adds to the light or takes from it, stacked, for each scene](data/14_ladder.png)" \
            if self.data["ladder"] else "No figure, either."

    def ladder_table(self):
        """The steps of the ladder of chapter 13, signed, in % of the mean of the truth with as many bounces."""
        ladder = self.data["ladder"]
        if not ladder:
            return "This run has no ladder."
        names = list(dict.fromkeys(name for climbed in ladder.values() for name, _ in climbed["steps"]))
        rows = [[f"`{scene}`", *(f"{dict(climbed['steps']).get(name, 0.0):+.1f}" for name in names), f"{climbed['total']:+.1f}"]
                for scene, climbed in ladder.items()]
        return table(["scene, % of the truth's mean", *names, "together"], rows)

    def pass_table(self):
        """Where the baseline's time goes."""
        rows = []
        names = list(dict.fromkeys(n for s in self.report.scenes for n in self.report.row(s)["ms"]))
        for name in names:
            rows.append([name, *(f"{self.report.row(s)['ms'].get(name, 0.0):.1f}" for s in self.report.scenes)])
        for key, name in [("ms_scene", "sum, once a scene"), ("ms_light", "sum, light"), ("ms_camera", "sum, camera")]:
            rows.append([f"**{name}**", *(f"{self.report.row(s)[key]:.0f}" for s in self.report.scenes)])
        return table(["pass, ms", *(f"`{s}`" for s in self.report.scenes)], rows)

    def command(self, row_id):
        return next(r["command"] for r in self.data["rows"] if r["id"] == row_id)
