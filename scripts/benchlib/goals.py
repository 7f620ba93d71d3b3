"""The goals of the codec and what was measured for each: the rows of the report's first table."""

from .rate import RATES
from .tables import geometric_mean, point, ratios, verdict


def row(figure, measured, text, goal, stretch=None, larger_is_better=False, unit=""):
    """One row; `text`: the measurement in words, `goal`, `stretch`: numbers."""
    sign = ">=" if larger_is_better else "<="

    def wanted(value):
        return "" if value is None else f"{sign} {value:g}{unit}"

    return {
        "figure": figure, "goal": wanted(goal), "stretch": wanted(stretch), "measured": text,
        "value": measured, "verdict": verdict(measured, goal, stretch, larger_is_better),
    }


def size_rows(models):
    """Bytes of the whole stream against Draco's."""
    if not models:
        return
    by_ratio = {model["name"]: model["bytes"] / model["draco_bytes"] for model in models}
    mean = geometric_mean(by_ratio.values())
    name = max(by_ratio, key=by_ratio.get)
    yield row("total bytes / Draco, geometric mean", mean, f"{mean:.3f}", 1.10, 0.95)
    yield row("total bytes / Draco, worst", by_ratio[name], f"{by_ratio[name]:.3f} ({name})",
              1.45, 1.10)


def all_points(models, peer):
    return [point(model, rate, peer) for model in models for rate in RATES]


def mean_row(title, points, figure, goal, stretch=None, rival="file"):
    values, left_out = ratios(points, figure, rival)
    mean = geometric_mean(values)
    text = "-" if mean is None else f"{mean:.3f} ({len(values)} points, {len(left_out)} left out)"
    return row(title, mean, text, goal, stretch)


def distance_rows(models):
    """What prefixes show against single levels of detail of the same bytes."""
    meshopt = all_points(models, "meshopt")
    yield mean_row("rms / best meshopt LOD, geometric mean at 0.5, 1, 2, 4 bpv", meshopt, "rms",
                   0.75, 0.60)
    yield mean_row("rms / best Lindstrom-Turk LOD, the same", all_points(models, "lindstrom-turk"),
                   "rms", 1.4, 1.0)
    yield mean_row("Hausdorff / that meshopt LOD, the same", meshopt, "max", 1.0)
    yield mean_row("Hausdorff / the meshopt LOD with the least Hausdorff distance", meshopt, "max",
                   1.0, rival="least_max")
