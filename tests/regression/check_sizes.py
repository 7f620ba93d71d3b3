#!/usr/bin/env python3
"""Compares the bytes of every level of known models with tests/regression/sizes.csv.

usage: check_sizes.py VSPLIT [--models DIR] [--update]

Models of the project are always encoded, those of the benchmark set where --models has them. With
--update the list is written anew (models that are missing keep their rows); say in the commit what moved
and why. Exit status: 0 equal, 1 different, 77 equal but some models are missing."""

import argparse
import csv
import json
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SIZES = pathlib.Path(__file__).with_name("sizes.csv")
ASSETS = ["assets/bone.ply", "assets/beast.ply", "assets/bracket.ply", "assets/terrain.ply",
          "assets/pair.ply", "assets/dirty.ply", "assets/vase.obj"]
MODELS = ["cow-2903", "bones", "homer", "lucy-5k", "fandisk", "casting", "three-peaks"]


def sizes_of(vsplit, path):
    """Cumulative bytes by level."""
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            [vsplit, "encode", path, "-o", f"{folder}/out.vsplit", "--json", "-", "--quiet"],
            capture_output=True, text=True, check=True,
        )
    return [level["cumulative_bytes"] for level in json.loads(run.stdout)["levels"]]


def read_known():
    known = {}
    if SIZES.exists():
        with SIZES.open(newline="") as file:
            for row in csv.DictReader(file):
                known.setdefault(row["model"], []).append(int(row["bytes"]))
    return known


def write_known(known):
    with SIZES.open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["model", "level", "bytes"])
        for model in sorted(known):
            writer.writerows([model, level, size] for level, size in enumerate(known[model]))


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("vsplit")
    parser.add_argument("--models", type=pathlib.Path, default=ROOT.parent / "shared/models")
    parser.add_argument("--update", action="store_true")
    arguments = parser.parse_args()
    inputs = {name: ROOT / name for name in ASSETS if (ROOT / name).exists()}
    inputs |= {name: arguments.models / f"{name}.ply" for name in MODELS}
    known = read_known()
    different, missing = [], []
    for name, path in inputs.items():
        if not path.exists():
            missing.append(name)
            continue
        sizes = sizes_of(arguments.vsplit, path)
        if sizes != known.get(name):
            different.append(name)
            before = known.get(name, [0])[-1]
            print(f"{name}: {before} -> {sizes[-1]} bytes, {len(known.get(name, []))} -> "
                  f"{len(sizes)} levels")
        known[name] = sizes
    if missing:
        print("not there: " + ", ".join(missing))
    if arguments.update:
        write_known(known)
        return 0
    if different:
        print("sizes differ; if they should, run this with --update and say so in the commit")
        return 1
    return 77 if missing else 0


if __name__ == "__main__":
    sys.exit(main())
