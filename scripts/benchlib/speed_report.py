"""The report's sections about time, memory and chunks."""

from . import report
from .goals import cutting_cost, heap_per_vertex
from .report import number, table


def decode_section(models):
    timed = [model for model in models if "decode" in model]
    if not timed:
        return []
    rows = [
        [model["name"], model["vertices"], number(1e3 * model["decode"]["seconds"]["vsplit"], 2),
         number(1e3 * model["decode"]["seconds"]["draco"], 2), number(model["decode"]["ratio"], 2),
         number(model["faces"] / model["decode"]["seconds"]["vsplit"] / 1e6, 2),
         number(heap_per_vertex(model), 0), number(heap_per_vertex(model, "draco"), 0)]
        for model in timed
    ]
    return [
        "", "## Decoding", "",
        "The whole stream and Draco's file of the same mesh, from memory, by turns in one process: "
        f"medians of {timed[0]['decode']['rounds']} rounds of processor time, and the median of the "
        "rounds' ratios. vsplit's time includes applying every split. Heap: the most that the decoder "
        "had in use at once, the decoded mesh included (neither is copied out). Meshes of fewer than "
        "20,000 vertices are shown but do not count for the goals.", "",
        table(["model", "vertices", "vsplit, ms", "Draco, ms", "ratio", "vsplit, M triangles/s",
               "vsplit heap, B/vertex", "Draco heap, B/vertex"], rows),
    ]


def encode_section(models):
    timed = [(model, model["encode"]) for model in models if "encode" in model]
    if not timed:
        return []
    rows = [[model["name"], cost["vertices"], number(cost["seconds"], 2),
             number(cost["vertices"] / cost["seconds"] / 1000, 1),
             number(cost["memory"] / cost["vertices"], 0)] for model, cost in timed]
    return [
        "", "## Encoding", "",
        "The whole program, from reading the mesh to writing the stream, one thread: processor time "
        "(median of three rounds), and the most resident memory less that of encoding a tetrahedron. "
        "Meshes of fewer than 20,000 vertices do not count for the goals.", "",
        table(["model", "vertices", "seconds", "k vertices/s", "peak memory, B/vertex"], rows),
    ]


def growth_section(measured):
    if not measured:
        return []
    rows = []
    for family, meshes in measured["families"].items():
        for cost in meshes:
            rows.append([cost["name"], family, cost["vertices"], cost["faces"],
                         number(cost["seconds"], 2),
                         number(1e6 * cost["seconds"] / cost["vertices"], 2),
                         number(cost["memory"] / cost["vertices"], 0), len(cost["chunks"]),
                         max(chunk["bytes"] for chunk in cost["chunks"])])
    threads = measured["threads"]
    pairs = "; ".join(f"{one:.2f} s and {two:.2f} s" for one, two in threads["seconds"])
    return [
        "", "## Growth", "",
        "The same figures as meshes grow: hand-34k and hand-543k, and a bumpy irregular torus "
        "(tests/bench/make_big_mesh.cpp) of three sizes. Each is compared with the smallest of its "
        "kind, as kinds differ in what a vertex costs.", "",
        table(["mesh", "kind", "vertices", "triangles", "seconds", "µs/vertex",
               "peak memory, B/vertex", "chunks", "largest chunk, B"], rows, [":--", ":--"] + ["--:"] * 7),
        "", f"Wall time of {threads['name']} with one thread and with two, by turns: {pairs}.",
    ]


def chunk_section(models):
    rows = []
    for model in models:
        cuts = sum(not chunk["ends_level"] for chunk in model["chunks"])
        rows.append([model["name"], len(model["chunks"]), cuts,
                     max(chunk["bytes"] for chunk in model["chunks"]),
                     number(cutting_cost(model), 2)])
    return [
        "", "## Chunks", "",
        "Levels are cut into chunks, so that every chunk is a step that can be shown. The cost is that "
        "of the cuts within levels, against the stream that `vsplit encode --uncut` makes.", "",
        table(["model", "chunks", "cuts within levels", "largest, bytes", "cost of cuts, %"], rows),
    ]


def sections(results):
    models = results["models"]
    return [
        *decode_section(models),
        *encode_section(models),
        *growth_section(results.get("growth")),
        *chunk_section(models),
    ]


def write_csv(folder, results):
    """speed.csv and growth.csv, as far as they were measured."""
    rows = [[model["name"], model["vertices"], *timing(model)] for model in results["models"]
            if "decode" in model or "encode" in model]
    if rows:
        report.write_csv(folder / "speed.csv", [
            "model", "vertices", "decode_seconds", "draco_decode_seconds", "decode_ratio",
            "heap_bytes", "draco_heap_bytes", "encode_seconds", "encode_memory_bytes"], rows)
    if results.get("growth"):
        report.write_csv(
            folder / "growth.csv", ["kind", "mesh", "vertices", "faces", "seconds", "memory_bytes"],
            [[family, cost["name"], cost["vertices"], cost["faces"], cost["seconds"], cost["memory"]]
             for family, costs in results["growth"]["families"].items() for cost in costs])


def timing(model):
    decode, encode = model.get("decode"), model.get("encode")
    cells = [""] * 5 if not decode else [
        decode["seconds"]["vsplit"], decode["seconds"]["draco"], decode["ratio"],
        decode["heap_peak_bytes"]["vsplit"], decode["heap_peak_bytes"]["draco"]]
    return cells + (["", ""] if not encode else [encode["seconds"], encode["memory"]])
