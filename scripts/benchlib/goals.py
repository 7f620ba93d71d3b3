"""The goals of the codec and what was measured for each: the rows of the report's first table."""

from .rate import RATES
from .speed import FEWEST_VERTICES
from .tables import geometric_mean, growth, point, ratios, verdict


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


def decode_rows(models):
    """Time and memory of decoding; meshes of enough vertices."""
    timed = [model for model in models if "decode" in model and model["vertices"] >= FEWEST_VERTICES]
    if not timed:
        return
    by_ratio = {model["name"]: model["decode"]["ratio"] for model in timed}
    name = max(by_ratio, key=by_ratio.get)
    mean = geometric_mean(by_ratio.values())
    yield row("decode and apply / Draco's decode time, worst", by_ratio[name],
              f"{by_ratio[name]:.2f} ({name}; geometric mean {mean:.2f})", 2.0, 1.0)
    heap = {model["name"]: heap_per_vertex(model) for model in timed}
    name = max(heap, key=heap.get)
    yield row("decoder heap peak a vertex, largest", heap[name], f"{heap[name]:.0f} B ({name})",
              100, 64, unit=" B")


def heap_per_vertex(model, codec="vsplit"):
    return model["decode"]["heap_peak_bytes"][codec] / model["vertices"]


def encode_rows(models):
    """Time and memory of encoding, one thread."""
    timed = {model["name"]: model["encode"] for model in models
             if "encode" in model and model["vertices"] >= FEWEST_VERTICES}
    if not timed:
        return
    speed = {name: cost["vertices"] / cost["seconds"] / 1000 for name, cost in timed.items()}
    name = min(speed, key=speed.get)
    mean = geometric_mean(speed.values())
    yield row("encode, thousand vertices a second and core, slowest", speed[name],
              f"{speed[name]:.1f} k ({name}; geometric mean {mean:.1f} k)", 60, 150, True, " k")
    memory = {name: cost["memory"] / cost["vertices"] for name, cost in timed.items()}
    name = max(memory, key=memory.get)
    yield row("encoder's peak memory a vertex, largest", memory[name],
              f"{memory[name]:.0f} B ({name})", 500, unit=" B")


def growth_rows(measured):
    """How costs grow with the mesh, and what a second thread brings."""
    if not measured:
        return
    for figure, title in (("seconds", "time"), ("memory", "memory")):
        rises = {family: growth(rows, figure) for family, rows in measured["families"].items()}
        known = {family: rise for family, rise in rises.items() if rise is not None}
        family = max(known, key=known.get)
        text = ", ".join(f"{rise:.2f} ({name})" for name, rise in known.items())
        yield row(f"encoding {title} a vertex, larger / smallest mesh of a kind", known[family], text,
                  1.2)
    threads = measured["threads"]
    yield row("encoding, one thread's time / two threads' time", threads["speedup"],
              f"{threads['speedup']:.2f} ({threads['name']}, {threads['cores']} cores)", 1.6,
              larger_is_better=True)


def chunk_rows(models, measured):
    """The largest chunk, and what cutting levels into chunks costs."""
    streams = list(models)
    if measured:
        streams += [stream for rows in measured["families"].values() for stream in rows]
    if not streams:
        return
    largest = {stream["name"]: max(chunk["bytes"] for chunk in stream["chunks"])
               for stream in streams}
    name = max(largest, key=largest.get)
    yield row("largest chunk", largest[name], f"{largest[name]} B ({name})", 65536, unit=" B")
    cost = {model["name"]: cutting_cost(model) for model in models}
    if cost:
        name = max(cost, key=cost.get)
        mean = sum(cost.values()) / len(cost)
        yield row("cost of cutting levels into chunks, largest", cost[name],
                  f"{cost[name]:.2f} % ({name}; mean {mean:.2f} %)", 0.5, unit=" %")


def cutting_cost(model):
    """By how many percent the cuts within levels make the stream larger."""
    return 100 * (model["bytes"] / model["uncut_bytes"] - 1)


def all_rows(results):
    """Every row, in the order of the report."""
    models, measured = results["models"], results.get("growth")
    for rows in (size_rows(models), distance_rows(models), decode_rows(models), encode_rows(models),
                 growth_rows(measured), chunk_rows(models, measured)):
        yield from rows
