"""Plots, each as PNG and SVG."""

import math

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  (the backend has to be chosen first)

from . import peers
from .speed import FEWEST_VERTICES
from .tables import envelope, geometric_mean

COLOURS = {"vsplit": "#c1272d", "meshopt": "#2a6f97", "lindstrom-turk": "#6a994e", "draco": "#8d99ae"}
LABELS = {"vsplit": "vsplit, prefix of one file", **{
    peer: f"{name}, one file a point" for peer, name in peers.PEERS.items()}}

matplotlib.rcParams.update({
    "font.size": 9, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True,
    "axes.axisbelow": True,
    "grid.alpha": 0.3, "figure.constrained_layout.use": True, "savefig.dpi": 150,
    "svg.hashsalt": "vsplit", "svg.fonttype": "none",
})


def save(figure, folder, name):
    """Writes a figure in both formats, without a date in it."""
    figure.savefig(folder / f"{name}.png")
    figure.savefig(folder / f"{name}.svg", metadata={"Date": None})
    pyplot.close(figure)
    return name


def curves(model):
    """By coder the (bits per vertex, rms) that it reaches; peers as their lower envelope."""
    prefixes = [row for row in model["prefixes"] if row["rms"] is not None]
    series = {"vsplit": envelope(prefixes)}
    series.update({peer: envelope([file for file in files if file["drawn"]])
                   for peer, files in model["peers"].items()})
    return {
        coder: [(8 * row["bytes"] / model["vertices"], row["rms"]) for row in rows]
        for coder, rows in series.items()
    }


def draw_curves(axes, model):
    for coder, points in curves(model).items():
        if points and coder == "vsplit":
            # A prefix shows what its last complete chunk made: hence the steps.
            axes.step(*zip(*points), where="post", color=COLOURS[coder], label=LABELS[coder],
                      linewidth=1.6)
        elif points:
            # Peers have a file for nearly every rate; the points are those that were made.
            axes.plot(*zip(*points), color=COLOURS[coder], label=LABELS[coder], linewidth=1,
                      marker="o", markersize=2.5)
    axes.axvline(8 * model["draco_bytes"] / model["vertices"], color=COLOURS["draco"], linewidth=1,
                 linestyle="--", label="Draco -cl 10 -qp 12, whole mesh")
    axes.set(xscale="log", yscale="log", title=f"{model['name']} ({model['vertices']:,} vertices)")
    axes.set_xticks([0.25, 0.5, 1, 2, 4, 8, 16], ["¼", "½", "1", "2", "4", "8", "16"])
    axes.set_xticks([], minor=True)
    axes.set_xlim(0.2, 32)


def rate_distortion(folder, models):
    """One picture with a panel for each model, and one file for each model."""
    columns = min(4, len(models))
    rows = math.ceil(len(models) / columns)
    figure, panels = pyplot.subplots(rows, columns, figsize=(3.6 * columns, 3 * rows + 0.6),
                                     squeeze=False)
    for axes, model in zip(panels.flat, models):
        draw_curves(axes, model)
    for axes in list(panels.flat)[len(models):]:
        axes.axis("off")
    figure.supxlabel("bits per vertex of the whole mesh")
    figure.supylabel("rms distance, % of the diagonal")
    legend_columns = 4 if columns == 4 else 2
    room = (0.35 + 0.6 / legend_columns) / figure.get_figheight()  # for the legend above
    figure.get_layout_engine().set(rect=(0, 0, 1, 1 - room))
    figure.legend(*panels.flat[0].get_legend_handles_labels(), loc="upper center",
                  ncols=legend_columns)
    names = [save(figure, folder, "rate-distortion")]
    for model in models:
        figure, axes = pyplot.subplots(figsize=(6, 4.2))
        draw_curves(axes, model)
        axes.set(xlabel="bits per vertex of the whole mesh", ylabel="rms distance, % of the diagonal")
        axes.legend()
        names.append(save(figure, folder, f"rate-distortion-{model['name']}"))
    return names


def bars(folder, name, values, label, marks):
    """A bar for each model and one for the geometric mean; `marks`: lines at goals, by label."""
    values = {**values, "geometric mean": geometric_mean(values.values())}
    figure, axes = pyplot.subplots(figsize=(max(0.42 * len(values) + 2, 6), 3.6))
    colours = [COLOURS["vsplit"] if key != "geometric mean" else "#5c1215" for key in values]
    shown = axes.bar(list(values), list(values.values()), color=colours, width=0.7)
    axes.bar_label(shown, fmt="%.2f", fontsize=7, padding=1)
    for (text, height), style in zip(marks.items(), ("-", "--", ":")):
        axes.axhline(height, color="#333333", linewidth=1, linestyle=style, label=text)
    axes.set(ylabel=label)
    axes.grid(axis="x", visible=False)
    axes.tick_params(axis="x", rotation=60)
    pyplot.setp(axes.get_xticklabels(), ha="right", rotation_mode="anchor")
    axes.legend(loc="upper left", ncols=len(marks))
    axes.set_ylim(0, 1.22 * max([*values.values(), *marks.values()]))
    return save(figure, folder, name)


def draw(folder, results):
    """All plots for which there are measurements. Result: their names without extension."""
    models = results["models"]
    if not models:
        return []
    with_curves = any(row["rate"] is None for model in models for row in model["prefixes"])
    names = rate_distortion(folder, models) if with_curves else []
    names.append(bars(folder, "total-bytes",
                      {model["name"]: model["bytes"] / model["draco_bytes"] for model in models},
                      "total bytes / Draco's",
                      {"Draco": 1.0, "goal for the mean": 1.1, "goal for the worst": 1.45}))
    timed = {model["name"]: model["decode"]["ratio"] for model in models
             if "decode" in model and model["vertices"] >= FEWEST_VERTICES}
    if timed:
        names.append(bars(folder, "decode-time", timed, "decode time / Draco's",
                          {"Draco": 1.0, "goal": 2.0}))
    return names
