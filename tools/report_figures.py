"""The figures of a report, with matplotlib (Debian: python3-matplotlib)."""
import importlib.util
import os
import tempfile

from report_analysis import error, fit_power, pareto_front

WIDTH, DPI = 8.4, 100  # inches, pixels an inch
COLORS = ["#1b6ca8", "#c8553d", "#3b7a57", "#8e5ea2", "#6b6b6b"]


def available():
    return importlib.util.find_spec("matplotlib") is not None


def pyplot():
    os.environ.setdefault("MPLCONFIGDIR", os.path.join(tempfile.gettempdir(), "conebook_matplotlib"))
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update({"font.size": 8, "axes.grid": True, "grid.alpha": 0.3, "axes.spines.top": False,
                         "axes.spines.right": False, "figure.constrained_layout.use": True, "legend.frameon": False})
    return plt


def save(plt, figure, file):
    figure.savefig(file, dpi=DPI, metadata={"Software": None})
    plt.close(figure)


def plain_ticks(axis, at=None):
    """1, 2, 5, 10, ... or the values given, without powers of ten."""
    from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter
    axis.set_major_locator(FixedLocator(at) if at else LogLocator(subs=(1.0, 2.0, 5.0)))
    axis.set_major_formatter(FuncFormatter(lambda v, _: f"{v:g}"))
    axis.set_minor_formatter(NullFormatter())


def short(setting, most=34):
    return setting if len(setting) <= most else setting[:most - 1] + "…"


def draw_pareto(plt, report, file):
    """Time against error on every core scene, the front drawn through, and the path tracer's points."""
    columns = 2 if len(report.core) > 1 else 1
    lines = (len(report.core) + columns - 1) // columns
    figure, axes = plt.subplots(lines, columns, figsize=(WIDTH, 3.6 * lines), squeeze=False)
    for axis in list(axes.flat)[len(report.core):]:
        axis.set_visible(False)
    for axis, scene in zip(axes.flat, report.core):
        rows = [r for r in report.rows if r["scene"] == scene]
        points = [(r["ms_steady"], error(r)) for r in rows]
        front = pareto_front(points)
        axis.scatter(*zip(*points), s=12, color=COLORS[4], alpha=0.6, label="settings")
        axis.plot(*zip(*(points[i] for i in front)), "-o", color=COLORS[0], markersize=5, label="Pareto front")
        base = report.row(scene)
        axis.plot(base["ms_steady"], error(base), "s", color=COLORS[1], markersize=7, label="baseline (defaults)")
        for shares, color, name in ((False, COLORS[2], "path tracer"), (True, COLORS[3], "path tracer that shares")):
            traced = sorted((t["ms_total"], error(t)) for t in report.traced
                            if t["scene"] == scene and t["size"] == base["size"] and t["share"] == shares)
            if traced:
                axis.plot(*zip(*traced), "x--", color=color, label=name)
        for n, i in enumerate(front):
            if n % max(1, len(front) // 4) == 0 or n == len(front) - 1:
                axis.annotate(short(rows[i]["setting"]), points[i], fontsize=5.5, xytext=(3, 4), textcoords="offset points")
        axis.set(title=scene, xscale="log", yscale="log", xlabel="ms a frame", ylabel="SMAPE, all light")
        plain_ticks(axis.xaxis)
        plain_ticks(axis.yaxis)
    axes.flat[0].legend(fontsize=7)
    save(plt, figure, file)


def draw_voxels(plt, report, file):
    """Error of the indirect diffuse light over the number of voxels along a side, with fitted exponents."""
    figure, axes = plt.subplots(1, 2, figsize=(WIDTH, 3.4))
    for axis, measure, name in zip(axes, ("smape", "nrmse"), ("SMAPE", "NRMSE")):
        for color, scene in zip(COLORS, report.scenes):
            points = [(float(r["parameters"]["voxels"]), error(r, "indirect_diffuse", measure))
                      for r in report.sweep(scene, "voxels") if error(r, "indirect_diffuse", measure) is not None]
            fit = fit_power(points)
            slope = f": N^{fit[0]:.2f}" if fit else ""
            axis.plot(*zip(*points), "-o", color=color, markersize=4, label=f"{scene}{slope}")
        axis.set(xscale="log", yscale="log", xlabel="voxels along the longest side, N", ylabel=f"{name}, indirect diffuse light")
        plain_ticks(axis.xaxis, sorted({float(r["parameters"]["voxels"]) for s in report.scenes for r in report.sweep(s, "voxels")}))
        plain_ticks(axis.yaxis)
        axis.legend(fontsize=6.5)
    save(plt, figure, file)


def draw_sweep(plt, report, name, file, part, xlabel):
    """One parameter on every core scene: time and error, both over the same scene's baseline."""
    figure, axes = plt.subplots(1, 2, figsize=(WIDTH, 3.2))
    order = report.data["sweep_order"].get(name, [])
    for color, scene in zip(COLORS, report.core):
        base = error(report.row(scene), part)
        rows = [r for r in report.sweep(scene, name) if error(r, part) is not None]
        if not base or not rows:
            continue
        places = [order.index(r["sweep_values"][name]) for r in rows]
        axes[0].plot(places, [r["relative_time"] for r in rows], "-o", color=color, markersize=4, label=scene)
        axes[1].plot(places, [error(r, part) / base for r in rows], "-o", color=color, markersize=4, label=scene)
    axes[0].set(xlabel=xlabel, ylabel="time of a frame over the baseline's", ylim=(0, None))
    axes[1].set(xlabel=xlabel, ylabel="SMAPE over the baseline's, " + part.replace("final", "all light").replace("_", " "), ylim=(0, None))
    for axis in axes:
        axis.set_xticks(range(len(order)), order)
    axes[1].legend(fontsize=6.5)
    save(plt, figure, file)


def draw_ladder(plt, ladder, file):
    """The signed means of the ladder's steps, stacked: what each adds to or takes from the light, in % of R1.

    `ladder`: {scene: {"steps": [[name, signed % of R1's mean], ...], "total": %}}.
    """
    steps = list(dict.fromkeys(name for climbed in ladder.values() for name, _ in climbed["steps"]))
    figure, axis = plt.subplots(figsize=(WIDTH, 0.6 * len(ladder) + 1.4))
    for y, climbed in enumerate(ladder.values()):
        ends = {1: 0.0, -1: 0.0}
        for name, share in climbed["steps"]:
            side = 1 if share >= 0 else -1
            axis.barh(y, share, left=ends[side], color=COLORS[steps.index(name) % len(COLORS)],
                      label=name if y == 0 else None)
            ends[side] += share
        axis.plot(climbed["total"], y, "D", color="black", markersize=4, label="sum" if y == 0 else None)
    axis.set_yticks(range(len(ladder)), list(ladder))
    axis.axvline(0, color="black", linewidth=0.8)
    axis.set_xlabel("signed error of each step, % of the mean of the path tracer with as many bounces (R1)")
    axis.legend(fontsize=6.5, ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))
    save(plt, figure, file)


def draw_heat_maps(bench, plan, scenes, file):
    """Picture, path tracer, and where they differ, a row for every scene: made by compare and sheet, without matplotlib."""
    cells = []
    for scene in scenes:
        bench.render(scene, plan.base, 1, count=False)
        reference = bench.reference(scene)
        kept = bench.pictures / f"{scene}_baseline.exr"
        bench.part_picture(scene, "final").replace(kept)
        heat = bench.pictures / f"{scene}_heat.png"
        bench.heat_map(kept, reference, heat)
        cells += [kept, f"{reference['stem']}.exr", heat]
    bench.run("sheet", "--columns", 6 if len(scenes) > 1 else 3, "--width", 156, *cells, "--output", file)


def draw(report, bench, plan, folder):
    plt = pyplot()
    draw_pareto(plt, report, folder / "14_pareto.png")
    if any(len(report.sweep(s, "voxels")) > 1 for s in report.scenes):
        draw_voxels(plt, report, folder / "14_voxels.png")
    for name, part, label in [("cones", "indirect_diffuse", "cones"), ("gather_scale", "indirect_diffuse", "gather scale"),
                              ("links", "final", "links of a face"), ("aperture", "indirect_diffuse", "aperture, degrees"),
                              ("start_offset", "indirect_diffuse", "start offset, voxels"), ("bounces", "final", "bounces")]:
        if any(len(report.sweep(s, name)) > 1 for s in report.core):
            draw_sweep(plt, report, name, folder / f"14_{name}.png", part, label)
    if report.data["ladder"]:
        draw_ladder(plt, report.data["ladder"], folder / "14_ladder.png")
    draw_heat_maps(bench, plan, report.core, folder / "14_heat_maps.png")
