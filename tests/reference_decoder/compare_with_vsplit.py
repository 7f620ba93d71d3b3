#!/usr/bin/env python3
"""Encodes a model with vsplit and checks that the decoder written from the document reads the index
that `vsplit inspect` prints, and shows at every level what `vsplit decode` writes.
usage: compare_with_vsplit.py VSPLIT MODEL [options of vsplit encode]..."""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from base import Missing
from bits import Refusal
from decode import SKIPPED, Decoder
from header import ATTRIBUTES, STITCH


def read_off(path):
    """OFF holds the shape alone: vertices and triangles as they are numbered."""
    words = path.read_text(encoding="ascii").split()
    vertex_count, face_count = int(words[1]), int(words[2])
    numbers = words[4:]
    vertices = [[float(x) for x in numbers[3 * v:3 * v + 3]] for v in range(vertex_count)]
    faces = numbers[3 * vertex_count:]
    return vertices, [tuple(int(x) for x in faces[4 * f + 1:4 * f + 4]) for f in range(face_count)]


def shown(header, positions, shift):
    """Coordinates of a level ("Showing a level")."""
    middle = (2 ** shift - 1) * 0.5
    return [
        [header.origin[axis] + ((x << shift) + middle) * header.cell for axis, x in enumerate(position)]
        for position in positions
    ]


def stitched(positions, triangles, one):
    """Replaces every vertex by the one it is one with and drops those no longer used."""
    used = sorted(set(one))
    number = {v: i for i, v in enumerate(used)}
    return [positions[v] for v in used], [tuple(number[one[v]] for v in t) for t in triangles]


def check_level(vsplit, stream, level, expected, cell):
    path = stream.with_suffix(".off")
    subprocess.run(
        [vsplit, "decode", stream, "--level", str(level), "-o", path], check=True, capture_output=True
    )
    vertices, triangles = read_off(path)
    if triangles != expected[1] or len(vertices) != len(expected[0]):
        sys.exit(f"level {level}: other triangles")
    for v, (a, b) in enumerate(zip(vertices, expected[0])):
        if max(abs(x - y) for x, y in zip(a, b)) > cell / 16:
            sys.exit(f"level {level}: vertex {v} is at {a}, not at {b}")


def percent(code):
    return 0 if code == 320 else 100 * 2 ** (-code / 8)


def check_index(vsplit, stream, header):
    printed = json.loads(subprocess.run(
        [vsplit, "inspect", stream, "--json", "-"], check=True, capture_output=True
    ).stdout)
    bytes_so_far, rows = header.length, []
    for row in header.rows:
        bytes_so_far += row.size
        if row.ends_level:
            rows.append((row, bytes_so_far))
        elif row.kind in (STITCH, ATTRIBUTES) and rows and rows[-1][0].vertices == row.vertices:
            rows[-1] = rows[-1][0], bytes_so_far
    if len(rows) != len(printed["levels"]):
        sys.exit("the index has another number of levels")
    for (row, end), level in zip(rows, printed["levels"]):
        counts = level["vertices"], level["faces"], level["cumulative_bytes"]
        if (row.vertices, row.faces, end) != counts:
            sys.exit(f"level {level['level']} of the index differs: {row}")
        for code, printed_error in zip(row.errors, (level["rms_percent"], level["max_percent"])):
            if not math.isclose(percent(code), printed_error, rel_tol=1e-9, abs_tol=1e-12):
                sys.exit(f"level {level['level']} has another error: {row}")


def compare(vsplit, model, options, folder):
    stream = folder / "model.vsplit"
    subprocess.run([vsplit, "encode", model, "-o", stream, "--quiet", *options], check=True)
    levels = []

    def keep(_, mesh, shift):
        levels.append(([list(position) for position in mesh.positions], mesh.triangles(), shift))

    decoder = Decoder(stream.read_bytes(), keep)
    check_index(vsplit, stream, decoder.header)
    for level, (positions, triangles, shift) in enumerate(levels):
        expected = shown(decoder.header, positions, shift), triangles
        if decoder.one is not None and level + 1 == len(levels):
            expected = stitched(*expected, decoder.one)
        check_level(vsplit, stream, level, expected, decoder.header.cell)
    print(f"{len(levels)} levels, {stream.stat().st_size} bytes, kinds "
          f"{sorted({(row.kind, row.codec) for row in decoder.header.rows})}")


def main():
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    vsplit, model, *options = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        try:
            compare(vsplit, model, options, pathlib.Path(folder))
        except Refusal as error:
            sys.exit(f"{model}: {error}")
        except Missing as error:
            print(error, file=sys.stderr)
            sys.exit(SKIPPED)


if __name__ == "__main__":
    main()
