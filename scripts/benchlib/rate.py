"""Bytes, and what the first bytes of a stream show."""

from . import peers, programs
from .judge import CURVE_SAMPLES, SAMPLES
from .programs import Failed, Run

RATES = [0.5, 1, 2, 4]
CURVE_RATES = [0.25, 0.35, 0.7, 1.4, 2.8, 5.6, 8, 12, 16]


def encode(original, folder):
    """Encodes and verifies a mesh: its record, to which the other measurements add."""
    stream = folder / (original.stem + ".vsplit")
    report = Run(programs.VSPLIT, "encode", original, "-o", stream, "--threads", 1,
                 "--json", "-").json()
    Run(programs.VSPLIT, "verify", stream, "--against", original).good()
    uncut = Run(programs.VSPLIT, "encode", original, "-o", folder / f"{original.stem}-uncut.vsplit",
                "--uncut", "--json", "-").json()
    draco = Run(programs.DECODE_SPEED, stream, "--rounds", 0).json()[0]
    inspected = Run(programs.VSPLIT, "inspect", stream, "--json", "-").json()
    if draco["vertices"] != report["vertices"]:
        raise Failed(f"{original}: Draco was given another mesh")
    mesh, coded = folder / f"{original.stem}-whole.ply", folder / f"{original.stem}.drc"
    Run(programs.VSPLIT, "decode", stream, "-o", mesh).good()
    Run("draco_encoder", "-i", mesh, "-o", coded, "-cl", 10, "-qp", 12).good()
    return {
        "name": original.stem, "original": original, "stream": stream,
        "vertices": report["vertices"], "faces": report["faces"],
        "bytes": report["bytes"], "draco_bytes": draco["draco_bytes"],
        "draco_encoder_bytes": coded.stat().st_size,
        "header_bytes": report["header_bytes"], "uncut_bytes": uncut["bytes"],
        "first_image_bytes": report["levels"][0]["cumulative_bytes"],
        "chunks": inspected["chunks"],
    }


def shown_by_prefix(record, budget, samples, judge, folder):
    """What a client that has the first `budget` bytes shows: the stream is really cut there, and
    decoded. Without a complete base mesh "rms" and "max" are None."""
    name = f"{record['name']}-{budget}-{samples}"
    cut, shown = folder / f"{name}.vsplit", folder / f"{name}.ply"
    cut.write_bytes(record["stream"].read_bytes()[:budget])
    run = Run(programs.VSPLIT, "decode", cut, "-o", shown, "--json", "-")
    cut.unlink()
    row = {"budget": budget, "bytes": None, "vertices": 0, "faces": 0, "rms": None, "max": None}
    if run.status == 0:
        decoded = run.json()
        row.update(bytes=decoded["bytes_used"], vertices=decoded["vertices"], faces=decoded["faces"])
        row.update(judge.distance(record["original"], shown, samples))
        shown.unlink()
    return row


def prefix_budgets(record, with_curve):
    """(rate or None, bytes, samples) of the prefixes to look at: the four rates, every chunk's end."""
    budgets = [(rate, int(rate * record["vertices"] / 8), SAMPLES) for rate in RATES]
    if with_curve:
        budgets += [(None, chunk["offset"] + chunk["bytes"], CURVE_SAMPLES)
                    for chunk in record["chunks"] if chunk["kind"] != "stitch"]
    return budgets


def measure(originals, folder, judge, cache, with_curve, pool):
    """The records of all models, with their prefixes and their peers' files; programs run through
    `pool`, so that none of its threads is idle before the last one."""
    records = list(pool.map(lambda original: encode(original, folder), originals))
    searches = [(RATES, (2, 2), SAMPLES)]
    searches += [(CURVE_RATES, (1, 0), CURVE_SAMPLES)] * with_curve
    for record in records:
        record["prefixes"] = [
            (rate, pool.submit(shown_by_prefix, record, budget, samples, judge, folder))
            for rate, budget, samples in prefix_budgets(record, with_curve)]
        record["peers"] = {
            peer: [pool.submit(peers.peer_files, peer, record["original"], rates, keep, judge, cache,
                               samples) for rates, keep, samples in searches]
            for peer in peers.PEERS}
    for record in records:
        collect(record)
        programs.note(f"{record['name']}: {record['bytes']} bytes, Draco {record['draco_bytes']}")
    return records


def collect(record):
    """Waits for what measure() has started for a model."""
    record["prefixes"] = [{"rate": rate, **shown.result()} for rate, shown in record["prefixes"]]
    for peer, found in record["peers"].items():
        results = [future.result() for future in found]
        if any(result["vertices"] != record["vertices"] for result in results):
            raise Failed(f"{record['original']}: {peer} was given another mesh")
        # The first search is the one that counts; curves go through the best file of every rate.
        record["peers"][peer] = [
            {**file, "counts": result is results[0],
             "drawn": file is min(row["files"], key=lambda other: other["rms"])}
            for result in results for row in result["rates"] for file in row["files"]]
