"""Peers: the best single level of detail that fits into so many bytes, by another simplifier and
Draco. Its results never change, so they are kept in a cache."""

import pathlib
import tempfile

from . import programs
from .cache import content_hash
from .judge import SAMPLES, sampling
from .programs import Run

PEERS = {"meshopt": "meshopt_simplify + Draco", "lindstrom-turk": "CGAL Lindstrom-Turk + Draco"}
# To be raised when tests/bench/bench_lod finds other files than before: forgets what is cached.
VERSION = 1


def peer_files(peer, original, rates, keep, judge, cache, samples=SAMPLES):
    """By rate the files that come into question, judged: a list of {"bytes", "bits", "vertices",
    "faces", "rms", "max"}; empty where nothing fits. `keep`: how many the search keeps by each
    distance, for the judge to choose from (rms, Hausdorff)."""
    key = content_hash("peer", VERSION, judge.version, peer, original, rates, *keep,
                       *sampling(samples))
    return cache.get(key, lambda: search(peer, original, rates, keep, judge, samples))


def search(peer, original, rates, keep, judge, samples):
    programs.note(f"looking for the best {PEERS[peer]} of {original.stem} (not in the cache)")
    with tempfile.TemporaryDirectory(prefix="vsplit-bench-") as folder:
        listed = ",".join(str(rate) for rate in rates)
        found = Run(programs.BENCH_LOD, peer, original, folder, "--rates", listed,
                    "--keep-by-rms", keep[0], "--keep-by-max", keep[1]).json()
        for row in found["rates"]:
            for file in row["files"]:
                shown = pathlib.Path(folder) / file.pop("file")
                file.update(judge.measure(original, shown, samples))
        return found
