"""What docs/14_speed_against_error.md says: words, numbers and tables made of the rows of a report.

Every sentence is chosen by the data, so that it stays true when they change.
"""
from report_analysis import Report, error, geometric_mean
from report_words import NOISY, PART_NAMES, code, factor, joined, marked, megabytes, ms, share, table


class Answers:
    """The functions that the marks of the page call by name."""

    def __init__(self, data):
        self.report = Report(data)
        self.data = data

    # --- The run ---

    def machine(self):
        m = self.data["machine"]
        return (f"{m['cpu']}, {m['cores']} cores, {m['driver']}; load {m['load']:.1f} before it began; "
                f"commit {m['commit'][:10]}{m['commit'][40:]}, {m['date']}")

    def kind_of_run(self):
        return "a quick run of coarse settings, which only shows that all works" if self.data["quick"] else "a full run"

    def duration(self):
        return f"{self.data['seconds'] / 60:.0f} minutes"

    def row_count(self):
        return str(len(self.data["rows"]))

    def pixels(self):
        return self.data["size"]

    def block(self):
        return f"{self.data['block']} x {self.data['block']}"

    def frames(self):
        return str(self.data["frames"])

    def scene_names(self):
        return joined(f"`{s}`" for s in self.report.scenes)

    def baseline_parameters(self):
        return " ".join(f"{k}={v}" for k, v in self.data["baseline"].items() if not k.startswith("light_"))

    def references(self):
        return joined(f"{name.replace(' ', ' at ')}: {r['spp']} samples a pixel" for name, r in self.data["references"].items())

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
        measured = self.report.measured_errors()
        noisy = [m for m in measured if m[2]["noisy"]]
        if not noisy:
            return "No row of this run has a reference whose noise is above a tenth of the error that it judges"
        worst = max(noisy, key=lambda m: m[2]["noise"] / m[2]["smape"])
        return (f"In {len(noisy)} of {len(measured)} comparisons the reference's noise is above a tenth of the error, and the error "
                f"carries a {NOISY} (worst: `{worst[0]['id']}`, {PART_NAMES[worst[1]]}, {worst[2]['noise'] / worst[2]['smape']:.2f} of it)")

    # --- Conclusions ---

    def conclusion_path_tracer(self):
        pairs = self.report.against_path_tracer()

        def won(share_, factor_=1):
            return sum(error(r) < error(t[factor_, share_]) for r, t in pairs)
        ratios = [error(r) / error(t[1, True]) for r, t in pairs]
        return (f"In the time of a frame in which lights move, the cones have less error than the path tracer in {won(False)} of {len(pairs)} "
                f"cases, and in {won(True)} of {len(pairs)} when the path tracer's neighbours share as the cones' do; with four times the "
                f"time it is {won(False, 4)} and {won(True, 4)}. Against the sharing path tracer at equal time the cones have "
                f"{factor(min(ratios))} to {factor(max(ratios))} times its error")

    def conclusion_time(self):
        rows = [self.report.row(s) for s in self.report.scenes]
        times, errors, once = ([f(r) for r in rows] for f in (lambda r: r["ms_frame"], error, lambda r: r["ms_scene"]))
        return (f"At {self.data['size']} the defaults take {ms(min(times))} to {ms(max(times))} a frame when lights move, after {ms(min(once))} to "
                f"{ms(max(once))} once a scene, and have a SMAPE of {share(min(errors))} to {share(max(errors))}")

    def _change(self, setting):
        s = self.report.setting(setting)
        return s and (f"{factor(s['relative_time'])} times the time and {factor(s['relative_error'])} times the error "
                      f"({factor(s['worst_error'])} in the worst scene)")

    def _changes(self, *settings):
        found = [f"`{s}` has {self._change(s)}" for s in settings if self._change(s)]
        return joined(found) if found else "no scene of this run has these rows"

    def conclusion_walk(self):
        return "Against the defaults " + self._changes("walk=march")

    def conclusion_bounces(self):
        return "Against the defaults " + self._changes("bounces=0", "bounces=1", "bounces=2")

    def conclusion_front(self):
        along = self.half_the_error()
        return self.defaults_on_front() + ". " + along[0].upper() + along[1:]

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

    def _change_table(self, found):
        return table(["setting", "time over the baseline's", "error over the baseline's", "in the worst scene"],
                     [[f"`{s['setting']}`", factor(s["relative_time"]), factor(s["relative_error"]), factor(s["worst_error"])]
                      for s in found])

    def not_worth(self):
        found = sorted(self.report.not_worth(), key=lambda s: -s["relative_time"])
        return self._change_table(found) if found else "Every single change that takes longer than the baseline also has less error."

    def bargains(self):
        found = sorted(self.report.bargains(), key=lambda s: s["relative_time"])
        return self._change_table(found) if found else "No single change saves a tenth of the time without a twentieth more error."

    def defaults_on_front(self):
        base, front = self.report.baseline(), self.report.front()
        if any(s["setting"] == "baseline" for s in front):
            return "The defaults (rows `*/baseline`) are on the front: no setting is both faster and nearer to the truth"
        better = [s for s in front if s["ms"] <= base["ms"] and s["error"] <= base["error"]]
        nearest = min(better, key=lambda s: s["error"])
        return (f"The defaults (rows `*/baseline`, {self._of(base)}) are not on the front: {code(nearest['setting'])} "
                f"is no slower and no worse ({self._of(nearest)})")

    def front_table(self):
        return table(["setting", "ms a frame", "time over the baseline's", "SMAPE", "over the baseline's", "memory"],
                     [[f"`{s['setting']}`", f"{s['ms']:.0f}", factor(s["relative_time"]), share(s["error"]),
                       factor(s["relative_error"]), megabytes(s["bytes"])] for s in self.report.front()])

    # --- The path tracer ---

    def path_tracer_table(self):
        """Cones, and the path tracer in the time of a frame and in four times that, alone and with sharing."""
        names = {(1, False): "path tracer, equal time", (1, True): "path tracer that shares, equal time",
                 (4, False): "path tracer, four times the time", (4, True): "path tracer that shares, four times"}
        rows = []
        for row, traced in self.report.against_path_tracer():
            methods = [("**cones, defaults**", row["ms_frame"], "", row)]
            methods += [(name, traced[key]["ms_total"], traced[key]["spp"], traced[key]) for key, name in names.items()]
            for name, time, spp, measured in methods:
                e = measured["errors"]["final"]
                rows.append([f"`{row['scene']}`, {row['size']}", name, spp, f"{time:.0f}", marked(e), share(e["signed_ratio"]),
                             share(e["p95"]), share(measured["errors"]["final_pixels"]["smape"])])
        return table(["scene", "method", "samples", "ms", "SMAPE", "signed ratio", "95th percentile", "SMAPE by pixels"], rows)

    def scope_table(self):
        rows = [[f"`{r['scene']}`, {r['size']}", f"{r['ms_scene']:.0f}", f"{r['ms_light']:.0f}", f"{r['ms_camera']:.0f}",
                 f"**{r['ms_frame']:.0f}**"] for r, _ in self.report.against_path_tracer()]
        return table(["scene", "once a scene, ms", "when a light moves", "every frame", "light and camera: the frame that is compared"], rows)

    def published_table(self):
        rows = [[p["experiment"], p["table"], f"`{p['scene']}`", p["label"], factor(p["published"]), factor(p["ours"]),
                 share(p["smape"])] for p in self.data["published"]]
        return table(["what is swept", "there", "scene", "value", "published ratio", "ours", "our SMAPE, all light"], rows) if rows \
            else "This run has none of these rows."

    # --- Sweeps ---

    def slopes(self):
        sentences = [f"{slope:.2f} on `{scene}`" for scene in self.report.scenes if (slope := self.report.slope(scene)) is not None]
        return "N to the power of " + joined(sentences) if sentences else "not measured in this run"

    def voxel_table(self):
        rows = []
        for scene in self.report.scenes:
            for r in self.report.sweep(scene, "voxels"):
                e = r["errors"]["indirect_diffuse"]
                if e:
                    rows.append([f"`{r['id']}`", r["parameters"]["voxels"], f"{r['ms_steady']:.0f}", f"{r['ms_scene']:.0f}",
                                 megabytes(r["bytes"]), share(e["signed_ratio"]), marked(e), share(e["p95"])])
        return table(["row", "N", "ms a frame", "ms once a scene", "memory", "signed ratio", "SMAPE", "95th percentile"], rows)

    def sweep_table(self, name, part="final"):
        """One line a value: geometric means of ratios, each to the baseline of the same scene, and the worst scene's.

        A value that fewer scenes have says so; since every ratio is to its own scene, that cannot make it look better."""
        rows = []
        scenes = [s for s in self.report.scenes if len(self.report.sweep(s, name)) > 1]
        for value in self.data["sweep_order"].get(name, []):
            have = [r for s in scenes for r in self.report.sweep(s, name) if r["sweep_values"][name] == value]
            if not have:
                continue
            ratios, whole = self.report.ratios(have, part), self.report.ratios(have)
            noisy = any((r["errors"].get(part) or {}).get("noisy") for r in have)
            steps = [(r["steps"], r["fetches"]) for r in have if r["steps"] or r["fetches"]]
            signed = [error(r, part, "signed_ratio") for r in have if error(r, part, "signed_ratio") is not None]
            base = " (baseline)" if any(r["setting"] == "baseline" for r in have) else ""
            rows.append([value + base, len({r["scene"] for r in have}), factor(geometric_mean([r["relative_time"] for r in have])),
                         *((f"{sum(column) / len(steps):.0f}" for column in zip(*steps)) if steps else ("-", "-")),
                         f"{min(signed):.3f} to {max(signed):.3f}" if signed else "-",
                         (factor(geometric_mean(ratios)) + NOISY * noisy) if ratios else "-",
                         factor(max(ratios)) if ratios else "-", *([factor(geometric_mean(whole))] if part != "final" else [])])
        if not rows:
            return "This run has none of these rows."
        return table([name.replace("_", " "), "scenes", "time", "steps a point", "fetches a point", "signed ratio", "SMAPE",
                      "SMAPE, worst scene", *(["SMAPE, all light"] if part != "final" else [])], rows)

    def sweep_figure(self, name, says):
        drawn = any(len(self.report.sweep(s, name)) > 1 for s in self.report.core)
        return f"![{says}](data/14_{name}.png)" if drawn else ""

    def parts_table(self):
        rows = []
        for scene in self.report.scenes:
            for part, name in PART_NAMES.items():
                e = self.report.row(scene)["errors"].get(part)
                if e:
                    rows.append([f"`{scene}`", name, share(e["signed_ratio"]), marked(e), share(e["nrmse"]), share(e["p95"]),
                                 share(e.get("flip")), share(e["noise"])])
        return table(["scene", "part", "signed ratio", "SMAPE", "NRMSE", "95th percentile", "FLIP", "noise, as SMAPE"], rows)

    def count_table(self):
        """What the baseline's cones look up."""
        rows = [[f"`{s}`", f"{r['points_per_pixel']:.2f}", *(f"{r[k]:.0f}" for k in ("steps", "fetches")),
                 *(f"{r[k]:.0f}" if r["specular_fetches"] else "-" for k in ("specular_steps", "specular_fetches"))]
                for s in self.report.scenes for r in [self.report.row(s)]]
        return table(["scene", "points a pixel", "diffuse: steps a point", "fetches a point", "specular: steps a pixel",
                      "fetches a pixel"], rows)

    def ladder_figure(self):
        return "![what each shortcut adds to the light or takes from it, stacked, for each scene](data/14_ladder.png)" \
            if self.data["ladder"] else "No figure, either."

    def ladder_table(self):
        """The steps of the ladder of chapter 13, signed, in % of the mean of R1."""
        ladder = self.data["ladder"]
        if not ladder:
            return "This run has no ladder."
        names = list(dict.fromkeys(name for climbed in ladder.values() for name, _ in climbed["steps"]))
        rows = [[f"`{scene}`", *(f"{dict(climbed['steps']).get(name, 0.0):+.1f}" for name in names), f"{climbed['total']:+.1f}",
                 f"{climbed['standard_error']['R1']:.1f}"] for scene, climbed in ladder.items()]
        return table(["scene, % of R1's mean", *names, "R5 - R0", "R1's standard error"], rows)

    def pass_table(self):
        """Where the baseline's time goes."""
        rows = []
        scopes = {n: scope for s in self.report.scenes for n, scope in self.report.row(s)["scopes"].items()}
        for name, scope in sorted(scopes.items(), key=lambda item: ("scene", "light", "camera").index(item[1])):
            times = (self.report.row(s)["ms"].get(name) for s in self.report.scenes)
            rows.append([name, scope, *("-" if t is None else f"{t:.1f}" for t in times)])
        for key in ("scene", "light", "camera"):
            rows.append([f"**sum, {key}**", key, *(f"{self.report.row(s)['ms_' + key]:.0f}" for s in self.report.scenes)])
        return table(["pass, ms", "scope", *(f"`{s}`" for s in self.report.scenes)], rows)

    def command(self, row_id):
        return next(r["command"] for r in self.data["rows"] if r["id"] == row_id)
