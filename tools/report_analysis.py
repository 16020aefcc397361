"""What the rows of a report say: the Pareto front, slopes, what a budget buys. No numbers are known here but the rows'."""
import math

# The figure by which settings are compared: SMAPE of the final picture against all bounces, 0..1.
MEASURE = ("final", "smape")


def error(row, part=MEASURE[0], measure=MEASURE[1]):
    """An error of a row, or None where the part is black or was not measured."""
    found = (row["errors"].get(part) or {}).get(measure)
    return found if found is not None and math.isfinite(found) else None


def pareto_front(points):
    """Indices of the points (time, error) that no other one beats, in the order of their times.

    A point is beaten when another one is no worse in both and better in one; of equal ones the first stays.
    """
    # snippet: pareto_front
    front, best = [], math.inf
    for i in sorted(range(len(points)), key=lambda i: (points[i][0], points[i][1], i)):
        if points[i][1] < best:
            front.append(i)
            best = points[i][1]
    return front
    # end snippet


def fit_power(points):
    """Exponent p and factor c of error = c x^p, least squares of the logarithms; None for fewer than two different x."""
    logs = [(math.log(x), math.log(y)) for x, y in points if x > 0 and y > 0]
    if len({x for x, _ in logs}) < 2:
        return None
    mx, my = (sum(values) / len(logs) for values in zip(*logs))
    slope = sum((x - mx) * (y - my) for x, y in logs) / sum((x - mx) ** 2 for x, _ in logs)
    return slope, math.exp(my - slope * mx)


def geometric_mean(values):
    return math.exp(sum(map(math.log, values)) / len(values))


class Report:
    """The data of docs/data/report.json, and questions to them."""

    def __init__(self, data):
        self.data = data
        self.rows = [row for row in data["rows"] if row["kind"] == "cones"]
        self.large = [row for row in data["rows"] if row["kind"] == "large"]
        self.traced = [row for row in data["rows"] if row["kind"] == "path_tracer"]
        self.drift = [row for row in data["rows"] if row["kind"] == "drift"]
        self.scenes = list(dict.fromkeys(row["scene"] for row in self.rows))
        self.core = [scene for scene in self.scenes if scene in data["core_scenes"]]

    def row(self, scene, setting="baseline"):
        return next((r for r in self.rows if r["scene"] == scene and r["setting"] == setting), None)

    def sweep(self, scene, name):
        """Rows of a sweep with the baseline among them, in the plan's order of the swept values."""
        rows = [r for r in self.rows if r["scene"] == scene and name in r["sweeps"]]
        order = self.data["sweep_order"].get(name, [])
        return sorted(rows, key=lambda r: order.index(r["sweep_values"][name]) if r["sweep_values"][name] in order else 99)

    def ratios(self, rows, part=MEASURE[0], measure=MEASURE[1]):
        """Of an error to the same scene's baseline, one a row that has both."""
        found = []
        for row in rows:
            own, base = error(row, part, measure), error(self.row(row["scene"]), part, measure)
            if own is not None and base:
                found.append(own / base)
        return found

    def settings(self):
        """Every setting that all core scenes have: its mean time in ms, its mean error, and both over the baseline's.

        Times of different scenes and moments are made comparable first: a row's time is its ratio to the baseline that
        ran last before it, times that scene's baseline.
        """
        found = []
        for setting in dict.fromkeys(r["setting"] for r in self.rows):
            rows = [self.row(scene, setting) for scene in self.core]
            if not rows or any(r is None or error(r) is None for r in rows):
                continue
            ratios = [error(r) / error(self.row(r["scene"])) for r in rows]
            found.append({"setting": setting,
                          "ids": [r["id"] for r in rows],
                          "ms": sum(r["ms_steady"] for r in rows) / len(rows),
                          "relative_time": geometric_mean([r["relative_time"] for r in rows]),
                          "error": sum(error(r) for r in rows) / len(rows),
                          "relative_error": geometric_mean(ratios), "worst_error": max(ratios),
                          "bytes": sum(r["bytes"] for r in rows) / len(rows)})
        return found

    def setting(self, name):
        return next((s for s in self.settings() if s["setting"] == name), None)

    def baseline(self):
        return self.setting("baseline")

    def front(self):
        settings = self.settings()
        return [settings[i] for i in pareto_front([(s["ms"], s["error"]) for s in settings])]

    def within(self, ms):
        """The most accurate setting that takes no more than `ms` a frame, or None."""
        affordable = [s for s in self.settings() if s["ms"] <= ms]
        return min(affordable, key=lambda s: (s["error"], s["ms"]), default=None)

    def fastest(self):
        return min(self.settings(), key=lambda s: s["ms"])

    def most_accurate(self):
        return min(self.settings(), key=lambda s: (s["error"], s["ms"]))

    def halvings(self):
        """Pairs along the front (from, to): the fastest, the next one with half its error, and so on."""
        front, pairs = self.front(), []
        start = front[0]
        for candidate in front[1:]:
            if candidate["error"] <= 0.5 * start["error"]:
                pairs.append((start, candidate))
                start = candidate
        return pairs

    def one_change(self):
        """Settings of the sweeps alone, without the grid's combinations and without what changes nothing but direct light."""
        names = {r["setting"] for r in self.rows if set(r["sweeps"]) - {"grid", "shadows"}}
        return [s for s in self.settings() if s["setting"] in names and s["setting"] != "baseline"]

    def not_worth(self, time=1.05, gain=0.98):
        """One-parameter changes that take more than `time` of the baseline's and leave over `gain` of its error."""
        return [s for s in self.one_change() if s["relative_time"] > time and s["relative_error"] > gain]

    def bargains(self, time=0.9, loss=1.05):
        """One-parameter changes that save time and keep the error within `loss` of the baseline's."""
        return [s for s in self.one_change() if s["relative_time"] < time and s["relative_error"] < loss]

    def slope(self, scene, part="indirect_diffuse", measure="smape"):
        """Exponent of the error over the number of voxels along a side."""
        points = [(float(r["parameters"]["voxels"]), error(r, part, measure)) for r in self.sweep(scene, "voxels")
                  if error(r, part, measure) is not None]
        fit = fit_power(points)
        return fit and fit[0]

    def against_path_tracer(self):
        """(row of cones, {(factor of its time, whether neighbours share): row of the path tracer}), the large row last."""
        found = []
        for row in [*(self.row(scene) for scene in self.scenes), *self.large]:
            traced = {(t["factor"], t["share"]): t for t in self.traced
                      if t["scene"] == row["scene"] and t["size"] == row["size"]}
            if traced:
                found.append((row, traced))
        return found

    def measured_errors(self):
        """(row, part, measures) of everything that was compared by blocks, and not taken over from the baseline."""
        return [(r, part, e) for r in self.rows + self.large + self.traced for part, e in r["errors"].items()
                if e and "same_as" not in e and part != "final_pixels"]
