#!/usr/bin/env python3
"""A decoder of the stream format written from proto/STREAM_FORMAT.md alone, as a proof that the
document says everything and as a description that runs. It is slow and trusts the document's limits.

Prints for every level what tests/golden/NAME.txt has, or compares it with such a file. A base chunk in
Draco's format needs the program draco_decoder; without it the exit status is 77, as CTest's skipped."""

import argparse
import pathlib
import re
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

from attributes import Attributes
from base import Missing, SmallBase, decode_draco
from batches import Batches, Models
from bits import AdaptiveBit, BitStreams, Refusal, crc32c, trace_bytes
from growth import Growth
from header import (
    ATTRIBUTES, BASE, BATCH, DRACO_BASE, FIRST_OPTIONAL, GROWTH, PARTS, RESIDUE, SMALL_BASE, STITCH, Header,
)
from mesh import Mesh

PROTO = pathlib.Path(__file__).resolve().parents[2] / "proto"
SKIPPED = 77


def packed_model():
    return bytes(map(int, re.findall(r"\d+", (PROTO / "initial_model.inc").read_text())))


def checksum(rows):
    return crc32c(b"".join(struct.pack(f"<{len(row)}I", *row) for row in rows))


def stitch(streams, positions):
    """The vertex with which each vertex is one ("Stitch chunk")."""
    one = list(range(len(positions)))
    groups = {}
    for v in sorted(range(len(positions)), key=lambda v: (positions[v], v)):
        groups.setdefault(tuple(positions[v]), []).append(v)
    together = AdaptiveBit()
    for group in groups.values():
        if len(group) < 2:
            continue
        if streams.adaptive(together, "all are one"):
            for v in group:
                one[v] = group[0]
            continue
        own = group[:1]
        for v in group[1:]:
            n = streams.raw(len(own).bit_length(), "one with")
            if n < len(own):
                one[v] = own[n]
            else:
                own.append(v)
    streams.finish()
    return one


class Decoder:
    """Decodes a whole stream; show(level, mesh, shift) is called when a level is complete,
    show_attributes(attributes) when its attributes are."""

    def __init__(self, data, show, trace=None, show_attributes=lambda attributes: None):
        self.trace = trace
        self.show = show
        self.show_attributes = show_attributes
        self.level = 0
        self.mesh = self.batches = self.growth = None
        self.one = self.attributes = None
        self.header = Header(data, trace)
        at = self.header.length
        for row in self.header.rows:
            if row.size > len(data) - at:
                raise Refusal("truncated")
            chunk = data[at:at + row.size]
            if row.size < 4 or crc32c(chunk) != RESIDUE:
                raise Refusal("bad-checksum")
            self._trace_chunk(row, at, chunk)
            at += row.size
            self._decode(row, chunk[:-4])
        if at != len(data):
            raise Refusal("trailing-bytes")
        self._require_settled()

    def _require_settled(self):
        if self.attributes and not self.attributes.settled():
            raise Refusal("bad-chunk")

    def _decode(self, row, contents):
        if row.kind < FIRST_OPTIONAL:
            self._require_settled()
        if row.kind == BASE:
            self._base(row, contents)
        elif row.kind == BATCH:
            self.batches.decode(self._streams(contents), row)
        elif row.kind == PARTS:
            self._parts(row, contents)
        elif row.kind == GROWTH:
            if self.growth is None:
                self.growth = Growth(self.mesh, self.batches.shift, self.header.bits, row.grown)
            self.growth.decode(self._streams(contents), row)
            if row.ends_level:
                self.mesh = self.growth
        elif row.kind == STITCH and row.codec == 0:
            if row.shift or not self._last_level_is_complete():
                raise Refusal("bad-chunk")
            self.one = stitch(self._streams(contents), self.mesh.positions)
        elif row.kind == ATTRIBUTES and row.codec <= 2:
            self._attributes(row, contents)
        if row.kind < FIRST_OPTIONAL:
            self.within_level = not row.ends_level
        if row.ends_level:
            self.show(self.level, self.mesh, row.shift)
            self.level += 1

    def _attributes(self, row, contents):
        if self.within_level:
            raise Refusal("bad-chunk")
        if self.attributes is None:
            last = self.header.rows[-1]
            counts = self.header.wedges or 0, last.vertices
            self.attributes = Attributes(self.header.attributes, counts)
        complete = self.attributes.decode(
            self._streams(contents), row.codec, self.level, self._all_levels_are_complete(),
            self.mesh, self.mesh is self.growth
        )
        if complete:
            self.show_attributes(self.attributes)

    def _all_levels_are_complete(self):
        return self.level == sum(row.ends_level for row in self.header.rows)

    def _last_level_is_complete(self):
        return self._all_levels_are_complete() and self.one is None

    def _base(self, row, contents):
        extent = [edge >> row.shift for edge in self.header.extent]
        if row.codec == SMALL_BASE:
            base = SmallBase(self._streams(contents), row.vertices, row.faces, extent)
            positions, triangles = base.positions, base.triangles()
        else:
            positions, triangles = decode_draco(contents)
        if len(positions) != row.vertices or len(triangles) != row.faces:
            raise Refusal("bad-chunk")
        self.mesh = Mesh(positions, triangles)
        self.mesh.check_coordinates(((1 << self.header.bits) - 1) >> row.shift)
        self.batches = Batches(self.mesh, Models(packed_model()), self.header.bits, row.shift)

    def _parts(self, row, contents):
        vertices = row.vertices - len(self.mesh.positions)
        extent = [edge >> row.shift for edge in self.header.extent]
        parts = SmallBase(
            self._streams(contents), vertices, row.faces - self.mesh.faces(), extent, parts=True
        )
        self.mesh.add_parts(parts.positions, parts.triangles())
        self.mesh.check_coordinates(((1 << self.header.bits) - 1) >> row.shift)

    def _trace_chunk(self, row, at, chunk):
        if self.trace:
            self.trace(f"chunk at {at}: kind {row.kind}, {row.size} bytes")
            draco = row.kind == BASE and row.codec == DRACO_BASE
            trace_bytes(self.trace, chunk[:-4], "Draco mesh" if draco else "bit streams")
            trace_bytes(self.trace, chunk[-4:], "checksum")

    def _streams(self, contents):
        return BitStreams(contents, "bad-chunk", self.trace)


def show_level(level, mesh, shift):
    """The lines with which a trace shows a level."""
    positions, triangles = mesh.positions, mesh.triangles()
    counts = f"{len(positions)} vertices, {len(triangles)} faces"
    lines = [f"level {level}: {counts}, shift {shift}"]
    for name, rows in (("vertex", positions), ("triangle", triangles)):
        lines += [f"{name} {i}: ({', '.join(map(str, row))})" for i, row in enumerate(rows)]
    return lines


def describe_attributes(attributes):
    """The line of a summary that tells of attributes."""
    sums = [checksum([attributes.level.vertices]), checksum(attributes.level.wedge_triangles())]
    sums.append(checksum([attributes.groups]) if attributes.group_count > 1 else None)
    for values in attributes.values:
        rows = [[number & 0xFFFFFFFF for number in value] for value in values]
        sums.append(checksum(rows) if rows else None)
    shown = " ".join("-" if number is None else f"{number:08x}" for number in sums)
    return f"attributes {len(attributes.level.vertices)} {shown}"


def write_obj(path, positions, triangles):
    with open(path, "w", encoding="ascii") as file:
        file.writelines("v {} {} {}\n".format(*position) for position in positions)
        file.writelines("f {} {} {}\n".format(*(v + 1 for v in t)) for t in triangles)


def decode(data, options):
    """The lines of the summary."""
    lines = ["level vertices faces shift positions triangles"]

    def show(level, mesh, shift):
        positions, triangles = mesh.positions, mesh.triangles()
        sums = f"{checksum(positions):08x} {checksum(triangles):08x}"
        lines.append(f"{level} {len(positions)} {len(triangles)} {shift} {sums}")
        if options.obj and options.level in (None, level):
            write_obj(options.obj, positions, triangles)
        if options.trace:
            print("\n".join(show_level(level, mesh, shift)))

    def show_attributes(attributes):
        lines.append(describe_attributes(attributes))
        if options.trace:
            print(lines[-1])

    decoder = Decoder(data, show, print if options.trace else None, show_attributes)
    if decoder.one is not None:
        lines.append(f"stitches {checksum([decoder.one]):08x}")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("stream", type=pathlib.Path)
    parser.add_argument("--expect", type=pathlib.Path, help="a summary to compare with")
    parser.add_argument("--trace", action="store_true", help="print every decision")
    parser.add_argument("--obj", help="write a level here, in indices of its grid")
    parser.add_argument("--level", type=int, help="the level to write, else the last one")
    options = parser.parse_args()
    try:
        lines = decode(options.stream.read_bytes(), options)
    except Refusal as error:
        sys.exit(f"{options.stream}: {error}")
    except Missing as error:
        print(f"{options.stream}: {error}", file=sys.stderr)
        sys.exit(SKIPPED)
    if options.expect is None:
        print("\n".join(lines))
    elif lines != options.expect.read_text(encoding="ascii").splitlines():
        sys.exit("\n".join([f"{options.stream} differs from {options.expect}:", *lines]))


if __name__ == "__main__":
    main()
