"""The report of scripts/bench --paper: Markdown, CSV and contact sheets."""

import csv

from . import paper_programs as run
from . import paper_text as text
from . import report
from .paper_measure import LEVELS, METHODS, RULES, STREAM_METRICS
from .programs import ROOT, Run

NUMERALS = ["I", "II", "III", "IV"]
PAPER_TABLES = ["curvature", "normal"]


def table(heads, rows):
    lines = [f"| {' | '.join(heads)} |", "|" + "|".join([" --- "] + [" ---: "] * (len(heads) - 1)) + "|"]
    return "\n".join(lines + [f"| {' | '.join(map(str, row))} |" for row in rows])


def stream_table(rows):
    """One of the paper's tables: the original and three levels of one model by one metric."""
    heads = ["level", "vertices", "faces", "grid display, frames/s", "stream up to here, bytes",
             "plain arrays, bytes", "rms, %", "Hausdorff, %", "normal error, °"]
    ordered = sorted(rows, key=lambda row: -row["vertices"])
    names = ["original (quantised)"] + [f"level {i}" for i in range(1, len(ordered))]
    return table(heads, [
        [name, row["vertices"], row["faces"], f"{row['frames_per_second']:.0f}", row["stream_bytes"],
         row["plain_bytes"], f"{row['rms']:.4f}", f"{row['max']:.3f}", f"{row['normals']:.2f}"]
        for name, row in zip(names, ordered)])


def beside_table(rows):
    """All metrics of one model at each level."""
    heads = ["metric"] + [f"{share} %: {what}" for share in LEVELS
                          for what in ("bytes", "rms", "Hausdorff", "normals")]
    lines = []
    for metric, name in STREAM_METRICS.items():
        levels = sorted((row for row in rows if row["metric"] == metric),
                        key=lambda row: -row["vertices"])[1:]
        cells = [(row["stream_bytes"], f"{row['rms']:.3f}", f"{row['max']:.2f}",
                  f"{row['normals']:.1f}") for row in levels]
        lines.append([name] + [cell for row in cells for cell in row])
    return table(heads, lines)


def method_table(rows):
    """All methods for one model at each share of the faces."""
    heads = ["method"] + [f"{share} %: {what}" for share in LEVELS
                          for what in ("faces", "rms", "Hausdorff", "normals")]
    found = {(row["method"], row["share"]): row for row in rows}
    lines = []
    for method, name in METHODS.items():
        cells = []
        for share in LEVELS:
            row = found.get((method, share))
            cells += [row["faces"], f"{row['rms']:.3f}", f"{row['max']:.2f}",
                      f"{row['normals']:.1f}"] if row else ["-"] * 4
        if cells != ["-"] * len(cells):
            lines.append([name] + cells)
    return table(heads, lines)


def rule_table(rows):
    """rms of the rules over several models."""
    rules = [rule for rule in RULES if any(row["method"] == rule for row in rows)]
    found = {(row["model"], row["share"], row["method"]): row for row in rows}
    keys = list(dict.fromkeys((row["model"], row["share"]) for row in rows))
    heads = ["model, faces"] + [METHODS[rule] for rule in rules] + ["curvature ÷ without"]
    lines = []
    for model, share in keys:
        values = [found[model, share, rule]["rms"] for rule in rules]
        ratio = values[0] / values[1] if values[1] > 1e-3 else None
        lines.append([f"{model}, {share} %"] + [f"{value:.4f}" for value in values] +
                     [f"{ratio:.2f}" if ratio else "-"])
    return table(heads, lines)


def region_table(rows):
    heads = ["model, vertices", "vertices inside: plain", "kept", "rms inside, %: plain", "kept",
             "rms outside, %: plain", "kept", "stream up to here, bytes: plain", "kept"]
    found = {(row["model"], row["vertices"], row["kept"]): row for row in rows}
    keys = list(dict.fromkeys((row["model"], row["vertices"]) for row in rows))
    lines = []
    for model, vertices in keys:
        pair = [found.get((model, vertices, kept)) for kept in (False, True)]
        if all(pair):
            cells = [[row["vertices_inside"] for row in pair],
                     [f"{row['inside']:.4f}" for row in pair],
                     [f"{row['outside']:.4f}" for row in pair],
                     [row["stream_bytes"] for row in pair]]
            lines.append([f"{model}, {vertices}"] + [cell for part in cells for cell in part])
    return table(heads, lines)


def contact_sheet(folder, name, columns, entries):
    """Puts (picture, caption) pairs on one sheet; the pictures are no longer needed then."""
    Run(ROOT / "scripts/contact-sheet", "--columns", columns, folder / name,
        *(f"{picture}={caption}" for picture, caption in entries)).good()
    return name


def draw_streams(folder, scratch, model, rows, wireframe):
    """The counterpart of the paper's Figure 2: one row a metric, the original and three levels."""
    metrics = [metric for metric in STREAM_METRICS if metric != "qem"]
    chosen = [row for metric in metrics for row in rows if row["metric"] == metric]
    name = f"{model.name}-{'grid' if wireframe else 'shaded'}.png"
    pictures = run.pictures(model.path, [row["mesh"] for row in chosen], scratch / name, wireframe)
    entries = [(picture, f"{row['metric']}, {row['faces']} faces, {row['stream_bytes'] / 1000:.1f} kB")
               for picture, row in zip(pictures, chosen)]
    return contact_sheet(folder, f"paper-{name}", len(LEVELS) + 1, entries)


def draw_methods(folder, scratch, model, rows):
    """All methods at the coarsest share."""
    chosen = [row for row in rows if row["share"] == LEVELS[-1]]
    pictures = run.pictures(model.path, [row["mesh"] for row in chosen], scratch / model.name, True)
    entries = [(picture, f"{row['method']}, {row['faces']} faces, rms {row['rms']:.2f} %")
               for picture, row in zip(pictures, chosen)]
    return contact_sheet(folder, f"paper-{model.name}-methods.png", 4, entries)


def write_csv(path, rows):
    if rows:
        heads = [key for key in rows[0] if key != "mesh"]
        with path.open("w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, heads, extrasaction="ignore", lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)


def head(results):
    judge = results["judge"]
    lines = [
        "# The paper, reproduced", "",
        "Counterpart of the tables and the figure of Wang and Yang, \"3D Models Simplification Algorithm "
        "for Mobile Devices\", made by `scripts/bench --paper` on the paper's two models, the cow "
        f"(2904 vertices, 5804 faces) and the bones (2154, 4204), on {report.machine()}. We have read "
        "the paper's rule, not its program: what it orders by and how hard it keeps feature points is "
        "our reading.", "",
        f"Distances are symmetric, in percent of the bounding box's diagonal, by {judge.name}; the "
        "normal error is the mean angle to the normal at the closest point.",
    ]
    if judge.disagreements:
        lines[-1] += (f" vsplit's own distance code gave an rms within "
                      f"{100 * max(judge.disagreements):.1f} % of the judge's on all "
                      f"{len(judge.disagreements)} meshes.")
    lines.append(
        f"Frame rates are of the grid display (all edges over the shaded surface) of the client's own "
        f"OpenGL ES renderer at {run.SCREEN[0]} × {run.SCREEN[1]} pixels, drawn in software on one core: "
        "one over the median processor time of a frame.")
    return lines


def stream_part(results):
    lines = ["", "## Tables I to IV: the original and three simplified levels", "",
             "The levels are prefixes of one stream a table. Down to 45 % of the vertices the default "
             "metric, and the one without curvature, choose collapses that code well before cheap ones; "
             "coarse levels have coarse positions. Both are in the figures here, and in none of the "
             "tables further down. A level takes many vertices at once, no two of them neighbours, which "
             "spreads collapses over the model and so hides much of what a bad order does."]
    numerals = iter(NUMERALS)
    for model in results["models"]:
        for metric in PAPER_TABLES:
            rows = [row for row in results["streams"]
                    if row["model"] == model.name and row["metric"] == metric]
            lines += ["", f"### Table {next(numerals)}: {model.name}, {STREAM_METRICS[metric]}", "",
                      stream_table(rows)]
    lines += ["", text.frame_rates(results["streams"]) + " " + text.streams(results["streams"])]
    for model in results["models"]:
        rows = [row for row in results["streams"] if row["model"] == model.name]
        lines += ["", f"### {model.name}: the other metrics beside them", "", beside_table(rows)]
    return lines


def figure_part(results):
    lines = ["", "## Figure 2: what the levels look like", ""]
    for model in results["models"]:
        lines += [f"![{model.name} as a grid, original and three levels by four metrics]"
                  f"(paper-{model.name}-grid.png)", "",
                  f"![{model.name}, shaded](paper-{model.name}-shaded.png)", ""]
    return lines[:-1]


def rule_part(results):
    rows = results["rules"]
    return [
        "", "## Where curvature helps, and where it does not", "",
        "Same collapses, same checks, exact positions; only the price differs. " + text.verdict(rows),
        "", "* Curvature as a factor, over the same quadrics without it: " +
        text.comparison(rows, "vsplit-curvature", "vsplit-quadrics"),
        "* Curvature as a factor, over the normal metric: " +
        text.comparison(rows, "vsplit-curvature", "vsplit-normal"),
        "* Curvature as the order (the paper's rule), over quadrics without it: " +
        text.comparison(rows, "vsplit-paper", "vsplit-quadrics"),
        "", rule_table(rows),
    ]


def method_part(results):
    lines = ["", "## The classic methods at equal faces", "",
             "Every method starts from the same repaired mesh and is asked for so many percent of its "
             "faces. Clusterings leave what their cells happen to leave, at most that. Rows that begin "
             "with \"vsplit\" are the encoder's own collapses with exact positions. What folds vertices "
             "into neighbours gives a subset of the original vertices, which a stream can refine without "
             "moving them; what finds the best place does not.", "",
             "The rms over that of vsplit's default, geometric means, the best first: " +
             text.ranking(results["methods"], METHODS) + "."]
    for model in results["models"]:
        rows = [row for row in results["methods"] if row["model"] == model.name]
        lines += ["", f"### {model.name}", "", method_table(rows), "",
                  f"![{model.name} by all methods at {LEVELS[-1]} % of the faces]"
                  f"(paper-{model.name}-methods.png)"]
    return lines


def region_part(results):
    return ["", "## Regions that the publisher marks", "",
            "`vsplit encode --keep-region` with a ball around one end of the model that holds a tenth of "
            "its vertices (the classic methods have no such thing; the paper has its feature points). " +
            text.regions(results["regions"]), "", region_table(results["regions"])]


def write(folder, scratch, results):
    """Writes paper.md, paper-*.csv and paper-*.png into a folder."""
    for model in results["models"]:
        streams = [row for row in results["streams"] if row["model"] == model.name]
        for wireframe in (True, False):
            draw_streams(folder, scratch, model, streams, wireframe)
        draw_methods(folder, scratch, model,
                     [row for row in results["methods"] if row["model"] == model.name])
    for name in ("streams", "methods", "rules", "regions"):
        write_csv(folder / f"paper-{name}.csv", results[name])
    lines = [*head(results), *stream_part(results), *figure_part(results), *rule_part(results),
             *method_part(results), *region_part(results)]
    (folder / "paper.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
