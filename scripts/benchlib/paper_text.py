"""What the figures say in words. Every sentence is made from the measured rows, so that it changes when
they do."""

import math

from .tables import geometric_mean

# So many places are named; the table has all of them.
NAMED = 5

# Ratios closer to 1 than this count as equal: near-equal rules scatter by so much when collapses of
# equal price change places.
EQUAL = 0.05


def ratios(rows, figure, method, other):
    """By (model, share) how one method's figure relates to another's; without levels that both of them
    keep almost exactly."""
    found = {(row["model"], row["share"], row["method"]): row[figure] for row in rows}
    pairs = {}
    for (model, share, name), value in found.items():
        beside = found.get((model, share, other))
        if name == method and beside and value and min(value, beside) > 1e-3:
            pairs[model, share] = value / beside
    return pairs


def listed(names):
    names = list(names)
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def places(pairs, wanted):
    """"cow 10 % (0.80)" for the pairs that are wanted, the strongest first."""
    chosen = sorted(((abs(math.log(ratio)), key) for key, ratio in pairs.items() if wanted(ratio)),
                    reverse=True)
    named = [f"{model} {share} % ({pairs[model, share]:.2f})" for _, (model, share) in chosen]
    more = len(named) - NAMED
    return named if more <= 0 else named[:NAMED] + [f"{more} more"]


def count(pairs, wanted):
    return sum(map(wanted, pairs.values()))


def comparison(rows, method, other):
    """One paragraph: a method's rms, Hausdorff and normal error over another's."""
    pairs = {figure: ratios(rows, figure, method, other) for figure in ("rms", "max", "normals")}
    if not pairs["rms"]:
        return "not measured."
    means = {figure: geometric_mean(found.values()) for figure, found in pairs.items()}
    total = len(pairs["rms"])
    text = (f"rms {means['rms']:.2f} times, Hausdorff {means['max']:.2f} times, normal error "
            f"{means['normals']:.2f} times (geometric means of {total} pairs).")
    for word, wanted in (("lower", lambda ratio: ratio < 1.0 - EQUAL),
                         ("higher", lambda ratio: ratio > 1.0 + EQUAL)):
        found = places(pairs["rms"], wanted)
        text += (f" The rms is more than {100 * EQUAL:.0f} % {word} in "
                 f"{count(pairs['rms'], wanted)} of {total}" +
                 (f": {listed(found)}." if found else "."))
    return text


def verdict(rows):
    """Where curvature helps and where it does not."""
    factor = ratios(rows, "rms", "vsplit-curvature", "vsplit-quadrics")
    order = ratios(rows, "rms", "vsplit-paper", "vsplit-quadrics")
    normal = ratios(rows, "rms", "vsplit-curvature", "vsplit-normal")
    if not (factor and order and normal):
        return "Too little was measured for a verdict."
    mean = geometric_mean(factor.values())
    sentences = []
    if abs(mean - 1.0) <= EQUAL:
        sentences.append(
            f"As a factor on quadrics curvature hardly matters for the distance: {mean:.2f} times the "
            "rms of the same quadrics without it.")
    else:
        word = "helps" if mean < 1.0 else "harms"
        sentences.append(f"As a factor on quadrics curvature {word}: {mean:.2f} times the rms of the "
                         "same quadrics without it.")
    by_share = {}
    for (_, share), ratio in factor.items():
        by_share.setdefault(share, []).append(ratio)
    sentences.append("By level: " + listed(
        f"{geometric_mean(by_share[share]):.2f} at {share} % of the faces"
        for share in sorted(by_share, reverse=True)) + ".")
    helped = places(factor, lambda ratio: ratio < 1.0 - EQUAL)
    harmed = places(factor, lambda ratio: ratio > 1.0 + EQUAL)
    if helped:
        sentences.append(f"It helps on {listed(helped)}.")
    if harmed:
        sentences.append(f"It harms on {listed(harmed)}.")
    worst, best = max(order.values()), min(order.values())
    order_mean = geometric_mean(order.values())
    word = "does not work" if order_mean > 2.0 else "costs" if order_mean > 1.0 + EQUAL else "works"
    sentences.append(
        f"As the order itself, which is the paper's rule as we read it, curvature {word}: the rms is "
        f"{order_mean:.1f} times that of quadrics ({best:.1f} to {worst:.1f}).")
    normal_mean = geometric_mean(normal.values())
    word = "below" if normal_mean < 1.0 else "above"
    sentences.append(
        f"Against the normal (\"vector-based\") metric the curvature metric's rms is "
        f"{abs(1.0 - normal_mean) * 100:.0f} % {word}.")
    return " ".join(sentences)


def frame_rates(rows):
    """What levels do to the frame rate, and what the metric does."""
    streams, sizes = {}, {}
    for row in rows:
        streams.setdefault((row["model"], row["metric"]), []).append(row)
        sizes.setdefault((row["model"], row["faces"]), []).append(row["frames_per_second"])
    gains = {}
    for stream in streams.values():
        ordered = sorted(stream, key=lambda row: -row["faces"])
        for level, row in enumerate(ordered[1:], 1):
            gains.setdefault(level, []).append(
                row["frames_per_second"] / ordered[0]["frames_per_second"])
    spread = max(max(rates) / min(rates) - 1.0 for rates in sizes.values())
    text = listed(f"{geometric_mean(values):.1f} times the original's rate at level {level}"
                  for level, values in sorted(gains.items()))
    return (f"Grid display: {text}. The metrics' rates at the same number of faces lie within "
            f"{100 * spread:.0f} % of each other.")


def streams(rows, metric="curvature", other="normal"):
    """What one metric's prefixes take and show over another's, level by level."""
    by_stream = {}
    for row in rows:
        by_stream.setdefault((row["model"], row["metric"]), []).append(row)
    pairs = {}
    for (model, name), stream in by_stream.items():
        beside = by_stream.get((model, other))
        if name != metric or not beside:
            continue
        ordered = [sorted(each, key=lambda row: -row["vertices"]) for each in (stream, beside)]
        for level, (row, peer) in enumerate(zip(*ordered)):
            pairs.setdefault(level, []).append(
                (row["stream_bytes"] / peer["stream_bytes"], row["rms"] / peer["rms"]))
    parts = []
    for level, values in sorted(pairs.items()):
        size, rms = (geometric_mean(each) for each in zip(*values))
        parts.append(f"{size:.2f} times the bytes and {rms:.2f} times the rms "
                     + (f"at level {level}" if level else "as a whole"))
    return f"The {metric} metric's streams over the {other} metric's: {listed(parts)}."


def ranking(rows, names, against="vsplit-curvature"):
    """Every method's rms over vsplit's, the best first."""
    means = {method: geometric_mean(ratios(rows, "rms", method, against).values())
             for method in names if method != against}
    ordered = sorted((mean, method) for method, mean in means.items() if mean)
    return listed(f"{names[method]} {mean:.2f}" for mean, method in ordered) if ordered else "none"


def regions(rows):
    """What keeping a region brings and costs."""
    by_key = {(row["model"], row["vertices"], row["kept"]): row for row in rows}
    inside, outside, vertices, total = [], [], [], []
    for (model, count, kept), row in by_key.items():
        plain = by_key.get((model, count, False))
        if not kept or not plain:
            continue
        if row["vertices"] == max(other["vertices"] for other in rows if other["model"] == model):
            total.append(row["stream_bytes"] / plain["stream_bytes"])
            continue
        inside.append(row["inside"] / plain["inside"])
        outside.append(row["outside"] / plain["outside"])
        vertices.append(row["vertices_inside"] / max(1, plain["vertices_inside"]))
    if not inside or not total:
        return "not measured."
    return (f"At the same number of vertices a level keeps {geometric_mean(vertices):.1f} times as many "
            f"of them inside; the rms is {geometric_mean(inside):.2f} times inside and "
            f"{geometric_mean(outside):.2f} times outside. The whole stream takes "
            f"{geometric_mean(total):.3f} times the bytes, and its last level is the same mesh.")
