"""Times and memory. Everything here runs alone, one program after the other."""

import os

from . import programs
from .models import find_model
from .programs import Run
from .tables import median

FEWEST_VERTICES = 20_000  # goals for time and memory are about larger meshes than that
DECODE_ROUNDS = 15
ENCODE_ROUNDS = 3
GENERATED_TRIANGLES = [34_000, 543_000, 4_000_000]
TETRAHEDRON = """OFF
4 4 0
0 0 0
1 0 0
0 1 0
0 0 1
3 0 2 1
3 0 1 3
3 1 2 3
3 2 0 3
"""


def decoding(models):
    """Adds to every model what decoding takes, beside Draco's, by turns in one process."""
    for model in models:
        programs.note(f"decoding {model['name']}")
        model["decode"] = Run(programs.DECODE_SPEED, model["stream"],
                              "--rounds", DECODE_ROUNDS).json()[0]


def encode_once(path, stream, threads=1):
    """A finished encode. Its own report says how much memory it took: what the system says of a child
    process includes what this one had before."""
    run = Run(programs.VSPLIT, "encode", path, "-o", stream, "--threads", threads, "--json", "-")
    run.peak_bytes = run.json()["peak_memory_bytes"]
    return run


def empty_run(folder):
    """Peak memory of encoding next to nothing."""
    path = folder / "tetrahedron.off"
    path.write_text(TETRAHEDRON, encoding="utf-8")
    return encode_once(path, folder / "tetrahedron.vsplit").peak_bytes


def encode_cost(path, vertices, folder, empty_bytes, rounds=ENCODE_ROUNDS):
    """Processor seconds of the whole program (median of rounds), and its peak memory without that of
    an empty run; one thread."""
    stream = folder / f"timed-{path.stem}.vsplit"
    runs = [encode_once(path, stream) for _ in range(rounds)]
    return {
        "name": path.stem, "vertices": vertices, "stream": stream,
        "seconds": median(run.cpu_seconds for run in runs),
        "memory": max(run.peak_bytes for run in runs) - empty_bytes,
    }


def encoding(models, folder):
    """Adds to every model what encoding takes."""
    empty = empty_run(folder)
    for model in models:
        programs.note(f"encoding {model['name']}")
        model["encode"] = encode_cost(model["original"], model["vertices"], folder, empty)


def two_threads(path, folder):
    """Wall seconds with one thread and with two, by turns, and the median of their ratios."""
    stream = folder / "threads.vsplit"
    pairs = [[encode_once(path, stream, threads).wall_seconds for threads in (1, 2)]
             for _ in range(ENCODE_ROUNDS)]
    return {"name": path.stem, "seconds": pairs, "cores": os.cpu_count(),
            "speedup": median(one / two for one, two in pairs)}


def grown_meshes(models_folder, folder):
    """The meshes of rising size: hand-34k and hand-543k, and a generated one of three sizes."""
    hands = [find_model(models_folder, name) for name in ("hand-34k", "hand-543k")]
    yield "hand", [path for path in hands if path]
    generated = []
    for triangles in GENERATED_TRIANGLES:
        path = folder / f"generated-{triangles // 1000}k.ply"
        Run(programs.MAKE_BIG_MESH, path, triangles).good()
        generated.append(path)
    yield "generated", generated


def growth(models_folder, folder):
    """By family what encoding takes as the mesh grows; the largest hand's gain by a second thread; the
    streams' largest chunks."""
    empty = empty_run(folder)
    result = {"families": {}, "threads": None}
    for family, paths in grown_meshes(models_folder, folder):
        rows = result["families"][family] = []
        for path in paths:
            programs.note(f"encoding {path.stem}")
            # Enough rounds to be sure of small ones; large ones tell by themselves.
            rounds = ENCODE_ROUNDS if path.stat().st_size < 5_000_000 else 1
            row = encode_cost(path, None, folder, empty, rounds)
            inspected = Run(programs.VSPLIT, "inspect", row["stream"], "--json", "-").json()
            row.update(vertices=inspected["vertices"], faces=inspected["faces"],
                       bytes=inspected["bytes"], chunks=inspected["chunks"])
            rows.append(row)
    candidates = [path for path in [find_model(models_folder, "hand-543k")] if path]
    path = (candidates or [folder / f"generated-{GENERATED_TRIANGLES[1] // 1000}k.ply"])[0]
    programs.note(f"encoding {path.stem} with one thread and with two")
    result["threads"] = two_threads(path, folder)
    return result
