"""Bytes, and what the first bytes of a stream show."""

import pathlib

from . import peers, programs
from .programs import Failed, Run

RATES = [0.5, 1, 2, 4]
CURVE_RATES = [0.25, 0.35, 0.7, 1.4, 2.8, 5.6, 8, 11]


def encode(original, folder):
    """Encodes and verifies a mesh: its record, to which the other measurements add."""
    stream = folder / (original.stem + ".vsplit")
    report = Run(programs.VSPLIT, "encode", original, "-o", stream, "--threads", 1,
                 "--json", "-").json()
    Run(programs.VSPLIT, "verify", stream, "--against", original).good()
    draco = Run(programs.DECODE_SPEED, stream, "--rounds", 0).json()[0]
    inspected = Run(programs.VSPLIT, "inspect", stream, "--json", "-").json()
    if draco["vertices"] != report["vertices"]:
        raise Failed(f"{original}: Draco was given another mesh")
    return {
        "name": original.stem, "original": original, "stream": stream,
        "vertices": report["vertices"], "faces": report["faces"],
        "bytes": report["bytes"], "draco_bytes": draco["draco_bytes"],
        "header_bytes": report["header_bytes"],
        "first_image_bytes": report["levels"][0]["cumulative_bytes"],
        "chunks": inspected["chunks"],
    }


def shown_by_prefix(record, budget, judge, folder):
    """What a client that has the first `budget` bytes shows: the stream is really cut there, and
    decoded. Without a complete base mesh "rms" and "max" are None."""
    name = f"{record['name']}-{budget}"
    cut, shown = folder / f"{name}.vsplit", folder / f"{name}.ply"
    cut.write_bytes(record["stream"].read_bytes()[:budget])
    run = Run(programs.VSPLIT, "decode", cut, "-o", shown, "--json", "-")
    cut.unlink()
    row = {"budget": budget, "bytes": None, "vertices": 0, "faces": 0, "rms": None, "max": None}
    if run.status == 0:
        decoded = run.json()
        row.update(bytes=decoded["bytes_used"], vertices=decoded["vertices"], faces=decoded["faces"])
        row.update(judge.distance(record["original"], shown))
        shown.unlink()
    return row


def prefix_budgets(record, with_curve):
    """(rate or None, bytes) of the prefixes to look at: the four rates, and every chunk's end."""
    budgets = [(rate, int(rate * record["vertices"] / 8)) for rate in RATES]
    if with_curve:
        budgets += [(None, chunk["offset"] + chunk["bytes"]) for chunk in record["chunks"]
                    if chunk["kind"] != "stitch"]
    return budgets


def measure(original, folder, judge, cache, with_curve, pool):
    """The record of a model, with its prefixes and its peers' files. Runs programs through `pool`."""
    record = encode(original, folder)
    budgets = prefix_budgets(record, with_curve)
    shown = pool.map(lambda row: {
        "rate": row[0], **shown_by_prefix(record, row[1], judge, folder)}, budgets)
    searches = [(peer, rates, keep) for peer in peers.PEERS
                for rates, keep in [(RATES, 2)] + [(CURVE_RATES, 1)] * with_curve]
    found = pool.map(lambda row: (row[0], peers.peer_files(
        row[0], pathlib.Path(original), row[1], row[2], judge, cache)), searches)
    record["prefixes"] = list(shown)
    record["peers"] = {peer: [] for peer in peers.PEERS}
    for peer, result in found:
        if result["vertices"] != record["vertices"]:
            raise Failed(f"{original}: {peer} was given another mesh")
        record["peers"][peer] += [file for row in result["rates"] for file in row["files"]]
    programs.note(f"{record['name']}: {record['bytes']} bytes, Draco {record['draco_bytes']}")
    return record
