"""What attributes cost: bytes that each adds to a vsplit stream and to a Draco file of the same mesh."""

import pathlib
import tempfile

from . import programs, report
from .goals import row
from .programs import Run
from .tables import geometric_mean

MODELS = ["spot", "duck", "textured-knot", "african-head", "bunny10k-textured", "damaged-helmet",
          "fuze", "gargo", "swirl-color", "airplane-color", "horse"]
# The attribute, its name in the report, the goal for vsplit / Draco.
KINDS = [("tex_coord", "texture coordinates", 0.75), ("normal", "normals", 0.9),
         ("color", "colours", 1.0)]
WHOLE_GOAL = 1.0
BITS = [("--uv-bits", 10), ("--normal-bits", 8), ("--color-bits", 8)]
# Images and what binds them to the surface have no counterpart in a Draco file.
NOT_COUNTED = ("texture", "appearance")
WITHOUT_IMAGES = ["--drop", "materials"]


def wanted_bits():
    """The options that give vsplit the same bits as Draco, as far as it has them."""
    known = Run(programs.VSPLIT, "encode", "--help").good().output
    return [part for option, bits in BITS if option in known for part in (option, bits)]


def stream_bytes(mesh, folder, bits):
    """Bytes of a mesh's stream without images and materials."""
    stream = pathlib.Path(folder) / "attributes.vsplit"
    Run(programs.VSPLIT, "encode", mesh, "-o", stream, *bits).good()
    chunks = Run(programs.VSPLIT, "inspect", stream, "--json", "-").json()["chunks"]
    left_out = sum(chunk["bytes"] for chunk in chunks if chunk["kind"] in NOT_COUNTED)
    return stream.stat().st_size - left_out


def measure_model(original, bits):
    """The record of one model: "all", "beside" images and "added" by attribute, vsplit and Draco."""
    programs.note(f"{original.stem}: bytes of attributes")
    with tempfile.TemporaryDirectory(prefix="vsplit-bench-") as folder:
        draco = Run(programs.BENCH_ATTRIBUTES, original, folder).json()
        files = {path.stem: path for path in pathlib.Path(folder).iterdir()}
        positions = stream_bytes(files["positions"], folder, bits)
        added = {kind: {"vsplit": stream_bytes(files[kind], folder, bits) - positions,
                        "draco": bytes_of}
                 for kind, bytes_of in draco["added"].items()}
        alone = stream_bytes(original, folder, [*bits, *WITHOUT_IMAGES])
        beside = stream_bytes(original, folder, bits)
        return {"name": original.stem, "vertices": draco["vertices"], "added": added,
                "all": {"vsplit": alone, "draco": draco["all"]},
                "beside": {"vsplit": beside, "draco": draco["all"]}}


def measure(originals, _cache, _folder):
    """The records of all models. Coding takes no time worth a cache."""
    bits = wanted_bits()
    return [measure_model(original, bits) for original in originals]


def ratio(pair):
    """vsplit / Draco; None where vsplit coded nothing."""
    return pair["vsplit"] / pair["draco"] if pair and pair["vsplit"] > 0 else None


def goal_rows(records):
    """Rows for the table of goals."""
    if not records:
        return
    for kind, title, goal in KINDS:
        values = [ratio(record["added"].get(kind)) for record in records if kind in record["added"]]
        known = [value for value in values if value]
        mean = geometric_mean(known)
        text = "-" if mean is None else f"{mean:.3f} ({len(known)} of {len(values)} models)"
        yield row(f"{title}, bytes added / Draco's, geometric mean", mean, text, goal)
    complete = [record for record in records if all(map(ratio, record["added"].values()))]
    for whole, title in (("all", "whole file without images"),
                         ("beside", "what files with images have beside them")):
        mean = geometric_mean(ratio(record[whole]) for record in complete)
        text = "-" if mean is None else f"{mean:.3f} ({len(complete)} of {len(records)} models)"
        yield row(f"{title} / Draco's, geometric mean", mean, text, WHOLE_GOAL)


def cell(pair):
    return f"{pair['vsplit']} / {pair['draco']} = {report.number(ratio(pair))}" if pair else ""


def section(records):
    rows = [[record["name"], record["vertices"],
             *(cell(record["added"].get(kind)) for kind, _, _ in KINDS), cell(record["all"]),
             cell(record["beside"])]
            for record in records]
    head = ["model", "vertices", *(title for _, title, _ in KINDS), "whole file",
            "beside images"]
    return ["", "## What lies on the surface", "",
            "Bytes that an attribute alone adds to the stream, and to the Draco file (cl 10) of the same "
            "repaired mesh; the whole file with all of them, encoded without images, and what a file with "
            "images has beside them, where the shape is refined to the end so that images come between. "
            "Positions 12, texture coordinates 10, normals 8 + 8 bits, colours 8.", "", report.table(head, rows)]


def write_csv(folder, records):
    rows = [[record["name"], kind, pair["vsplit"], pair["draco"]] for record in records
            for kind, pair in [*record["added"].items(), ("all", record["all"]),
                               ("beside", record["beside"])]]
    report.write_csv(folder / "attributes.csv", ["model", "attribute", "vsplit_bytes",
                                                 "draco_bytes"], rows)
