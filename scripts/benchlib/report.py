"""The report: report.md and the CSV files."""

import csv
import os
import pathlib

from . import peers
from .rate import RATES
from .tables import geometric_mean, point, ratios

VERDICTS = {"stretch": "**stretch**", "reached": "reached", "short": "**short**",
            "not measured": "not measured"}


def number(value, digits=3):
    return "-" if value is None else f"{value:.{digits}f}"


def table(head, rows, align=None):
    """A Markdown table; numbers to the right unless `align` says otherwise."""
    align = align or [":--"] + ["--:"] * (len(head) - 1)
    lines = [head, align, *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)


def goal_table(rows):
    return table(
        ["figure", "goal", "stretch", "measured", ""],
        [[row["figure"], row["goal"], row["stretch"], row["measured"], VERDICTS[row["verdict"]]]
         for row in rows],
        [":--", ":--", ":--", ":--", ":--"],
    )


def size_table(models):
    rows = [
        [model["name"], model["vertices"], model["faces"], model["bytes"],
         number(8 * model["bytes"] / model["vertices"], 2), model["draco_bytes"],
         number(8 * model["draco_bytes"] / model["vertices"], 2),
         number(model["bytes"] / model["draco_bytes"]), model["first_image_bytes"]]
        for model in models
    ]
    mean = geometric_mean(model["bytes"] / model["draco_bytes"] for model in models)
    rows.append(["geometric mean", "", "", "", "", "", "", number(mean), ""])
    return table(["model", "vertices", "faces", "vsplit, bytes", "bpv", "Draco, bytes", "bpv",
                  "ratio", "first image, bytes"], rows)


def point_cell(p, figure):
    """prefix / best file = ratio, of one point."""
    rival = p["file"]
    mine = p["prefix"][figure] if p["prefix"] else None
    theirs = rival[figure] if rival else None
    ratio = mine / theirs if mine and theirs else None
    return f"{number(mine, 4)} / {number(theirs, 4)} = {number(ratio, 2)}"


def distance_table(models, peer, figure):
    rows = []
    for model in models:
        points = [point(model, rate, peer) for rate in RATES]
        mean = geometric_mean(ratios(points, figure)[0])
        rows.append([model["name"], *(point_cell(p, figure) for p in points), number(mean)])
    columns = [[point(model, rate, peer) for model in models] for rate in RATES]
    means = [geometric_mean(ratios(column, figure)[0]) for column in columns]
    total = geometric_mean(ratios(sum(columns, []), figure)[0])
    rows.append(["geometric mean", *(number(mean) for mean in means), number(total)])
    return table(["model", *(f"{rate:g} bpv" for rate in RATES), "mean"], rows)


def left_out_list(models):
    """A line for every point at which somebody has no picture."""
    lines = []
    for model in models:
        for rate in RATES:
            first = [point(model, rate, peer) for peer in peers.PEERS]
            missing = [] if first[0]["prefix"] else [
                f"vsplit (header and base are {model['first_image_bytes']} bytes)"]
            missing += [peers.PEERS[p["peer"]] for p in first if not p["file"]]
            if missing:
                lines.append(f"* {model['name']} at {rate:g} bpv, {first[0]['budget']} bytes: "
                             f"nothing by {', '.join(missing)}")
    return "\n".join(lines) or "None."


SUMMARY_MODELS = ["dragon-100k", "homer", "horse", "rocker-arm", "skull", "stanford-bunny"]


def summary_table(models):
    """The README's table: what a reader wants to know first, one row a model."""
    shown = [model for model in models if model["name"] in SUMMARY_MODELS] or models
    rows = []
    for model in shown:
        rms = [next(row["rms"] for row in model["prefixes"] if row["rate"] == rate)
               for rate in (1, 2, 4)]
        decode, encode = model.get("decode"), model.get("encode")
        rows.append([
            model["name"], model["vertices"], model["first_image_bytes"],
            " / ".join(number(value) for value in rms),
            number(8 * model["bytes"] / model["vertices"], 1),
            number(8 * model["draco_bytes"] / model["vertices"], 1),
            number(decode and model["vertices"] / decode["seconds"]["vsplit"] / 1e6, 2),
            number(encode and model["vertices"] / encode["seconds"] / 1e3, 0)])
    return table(["model", "vertices", "first image, bytes", "rms at 1 / 2 / 4 bpv, %", "total, bpv",
                  "Draco, bpv", "decode, M vertices/s", "encode, k vertices/s"], sorted(rows))


def write_csv(path, head, rows):
    with open(path, "w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(head)
        writer.writerows(rows)


def write_rate_csv(folder, models):
    write_csv(folder / "sizes.csv", ["model", "vertices", "faces", "vsplit_bytes", "draco_bytes",
                                     "draco_encoder_bytes", "first_image_bytes"],
              [[model["name"], model["vertices"], model["faces"], model["bytes"],
                model["draco_bytes"], model["draco_encoder_bytes"], model["first_image_bytes"]]
               for model in models])
    head = ["model", "coder", "rate", "bytes", "vertices", "faces", "bits", "rms_percent",
            "max_percent"]
    rows = []
    for model in models:
        for prefix in model["prefixes"]:
            rows.append([model["name"], "vsplit", prefix["rate"], prefix["bytes"],
                         prefix["vertices"], prefix["faces"], "", prefix["rms"], prefix["max"]])
        for peer, files in model["peers"].items():
            rows += [[model["name"], peer, "", file["bytes"], file["vertices"], file["faces"],
                      file["bits"], file["rms"], file["max"]] for file in files]
    write_csv(folder / "distances.csv", head, rows)


def machine():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return f"{line.split(':', 1)[1].strip()}, {os.cpu_count()} cores"
    return f"{os.uname().machine}, {os.cpu_count()} cores"
