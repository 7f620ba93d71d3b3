"""What is computed from measurements: means, choices, verdicts. No files, no programs; tested by
tests/bench/tables_test.py."""

import math


def geometric_mean(values):
    """The geometric mean; None of nothing."""
    values = list(values)
    if not values:
        return None
    return math.exp(sum(math.log(value) for value in values) / len(values))


def best_file(files, budget, figure):
    """The file of at most `budget` bytes with the least `figure`; None when none fits."""
    fitting = [file for file in files if file["bytes"] <= budget]
    return min(fitting, key=lambda file: (file[figure], file["bytes"]), default=None)


def envelope(files, figure="rms"):
    """The files that no smaller or equal one betters: rising bytes, falling figure."""
    front = []
    for file in sorted(files, key=lambda file: (file["bytes"], file[figure])):
        if not front or file[figure] < front[-1][figure]:
            front.append(file)
    return front


def point(model, rate, peer):
    """What vsplit's prefix and the peer's best files show in the bytes of `rate` bits a vertex."""
    budget = int(rate * model["vertices"] / 8)
    files = [file for file in model["peers"][peer] if file["counts"]]
    shown = next((prefix for prefix in model["prefixes"] if prefix["rate"] == rate), None)
    return {
        "model": model["name"], "rate": rate, "peer": peer, "budget": budget,
        "prefix": shown if shown and shown["rms"] is not None else None,
        "file": best_file(files, budget, "rms"),
        "least_max": best_file(files, budget, "max"),
    }


def ratios(points, figure, rival="file"):
    """Prefix / rival of the points where both show something, and the points left out."""
    both = [p for p in points if p["prefix"] and p[rival]]
    left_out = [p for p in points if not (p["prefix"] and p[rival])]
    return [p["prefix"][figure] / p[rival][figure] for p in both], left_out


def verdict(measured, goal, stretch=None, larger_is_better=False):
    """"stretch", "reached" or "short"; "not measured" of nothing."""
    if measured is None:
        return "not measured"
    sign = -1 if larger_is_better else 1
    if stretch is not None and sign * measured <= sign * stretch:
        return "stretch"
    return "reached" if sign * measured <= sign * goal else "short"


def growth(rows, figure):
    """How much more `figure` a vertex the larger meshes need than the first (smallest) one: the
    largest ratio; None with fewer than two rows."""
    per_vertex = [row[figure] / row["vertices"] for row in rows]
    if len(per_vertex) < 2:
        return None
    return max(value / per_vertex[0] for value in per_vertex[1:])


def median(values):
    """The middle value (the upper of two); None of nothing."""
    values = sorted(values)
    return values[len(values) // 2] if values else None
