#!/usr/bin/env python3
"""Decodes a .vsplit stream as proto/STREAM_FORMAT.md says and prints what it reads.

Written from that document alone, with its names, as plainly as possible; it is slow. The base mesh
inside the stream is a Draco mesh, which the vsplit tool decodes: --vsplit BIN; without it only header and
index are shown. --check compares every level with what the tool makes of it. --trace prints every byte,
decision, vertex and triangle; the document's worked stream is shown that way.
"""
import argparse
import pathlib
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from stream_base import SmallBase  # noqa: E402
from stream_index import BASE, BATCH, FIRST_OPTIONAL, STITCH, Stream, show_bytes  # noqa: E402
from stream_models import BitStreams, Refusal, crc32c  # noqa: E402
from stream_splits import Mesh, Splits  # noqa: E402


def read_obj(path):
    lines = [line.split() for line in open(path, encoding="ascii")]
    points = [tuple(map(float, line[1:])) for line in lines if line[0] == "v"]
    return points, [tuple(int(i) - 1 for i in line[1:]) for line in lines if line[0] == "f"]


class Decoder:
    """Decodes chunk after chunk."""

    def __init__(self, stream, options):
        self.stream, self.options, self.level, self.open = stream, options, -1, False
        self.splits = self.stitches = None

    def tool_mesh(self, level):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "level.obj"
            subprocess.run(
                [self.options.vsplit, "decode", self.options.stream, "--level", str(level), "-o",
                 str(path)], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            return read_obj(path)

    def decode(self, row):
        contents = self.stream.contents(row)
        print(f"    chunk at {row.offset}: kind {row.kind}, {row.bytes} bytes")
        if self.options.trace:
            self.show_contents(row, contents)
        if row.kind == BASE:
            self.decode_base(row, contents)
        elif row.kind == BATCH:
            self.decode_batch(row, BitStreams(contents, self.options.trace))
        elif (row.kind, row.codec) == (STITCH, 0):
            self.decode_stitches(BitStreams(contents, self.options.trace))
        if row.kind < FIRST_OPTIONAL and row.ends_level:
            self.level += 1
            print(f"    level {self.level}: {row.vertices} vertices, {row.faces} faces, "
                  f"shift {self.splits.mesh.shift}")
            self.show_mesh()

    def show_contents(self, row, contents):
        draco = (row.kind, row.codec) == (BASE, 0)
        show_bytes(contents, "Draco mesh" if draco else "bit streams")
        show_bytes(self.stream.data[row.offset:row.offset + row.bytes][-4:], "checksum")

    def show_mesh(self):
        if self.options.trace:
            mesh = self.splits.mesh
            for vertex, position in enumerate(mesh.positions):
                print(f"    vertex {vertex}: {position}")
            for slot, triangle in enumerate(mesh.triangles()):
                print(f"    triangle {slot}: {triangle}")

    def decode_base(self, row, contents):
        shift = row.shift
        if row.codec == 1:
            extent = [size >> shift for size in self.stream.extent]
            base = SmallBase(contents, row.vertices, row.faces, extent, self.options.trace)
            positions, triangles = base.positions, base.triangles
        else:
            points, triangles = self.tool_mesh(0)
            positions = [self.stream.grid_index(point, shift) for point in points]
        self.splits = Splits(Mesh(positions, triangles, self.stream.bits, shift))

    def decode_batch(self, row, bits):
        splits, batches = self.splits, 1
        if not self.open:
            splits.start_level(bits, row.shift)
        if not self.open or splits.d > 0:
            self.open = True
            if splits.refine(bits):
                bits.finish()
                return
            batches = bits.raw(3, "batches less one") + 1
            splits.start_batch()
        for _ in range(batches - 1):
            count = bits.raw(12, "splits")
            if count > row.vertices - len(splits.mesh.positions):
                raise Refusal("bad-chunk", "splits")
            splits.part(bits, count)
            splits.end_batch()
            splits.start_batch()
        splits.part(bits, row.vertices - len(splits.mesh.positions))
        bits.finish()
        if len(splits.mesh.faces) != row.faces:
            raise Refusal("bad-chunk", "faces")
        self.open = not row.ends_level
        if row.ends_level:
            splits.end_batch()

    def decode_stitches(self, bits):
        positions = self.splits.mesh.positions
        order = sorted(range(len(positions)), key=lambda v: (positions[v], v))
        self.stitches, model, begin = list(range(len(order))), [32768, 0], 0
        while begin < len(order):
            end = begin + 1
            while end < len(order) and positions[order[end]] == positions[order[begin]]:
                end += 1
            if end - begin > 1:
                self.decode_group(bits, model, order[begin:end])
            begin = end
        bits.finish()

    def decode_group(self, bits, model, group):
        if bits.adaptive(model, "all one"):
            for vertex in group:
                self.stitches[vertex] = group[0]
            return
        unique = [group[0]]
        for vertex in group[1:]:
            choice = bits.raw(len(unique).bit_length(), "one with")
            if choice < len(unique):
                self.stitches[vertex] = unique[choice]
            else:
                unique.append(vertex)

    def check_level(self, level):
        """Compares the mesh with the tool's."""
        mesh = self.splits.mesh
        points, triangles = self.tool_mesh(level)
        place = list(range(len(mesh.positions)))
        if self.stitches is not None:
            kept = [v for v in place if self.stitches[v] == v]
            place = [kept.index(self.stitches[v]) for v in place]
        shown = [self.stream.grid_index(point, mesh.shift) for point in points]
        mine = {place[v]: position for v, position in enumerate(mesh.positions)}
        same = all(mine[v] == position for v, position in enumerate(shown))
        expected = [tuple(place[v] for v in triangle) for triangle in mesh.triangles()]
        if not same or len(shown) != len(mine) or triangles != expected:
            sys.exit(f"level {level} differs from the tool's")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("stream")
    parser.add_argument("--vsplit", help="the vsplit tool")
    parser.add_argument("--check", action="store_true", help="compare every level with the tool's")
    parser.add_argument("--trace", action="store_true", help="print every decision")
    options = parser.parse_args()
    try:
        stream = Stream(pathlib.Path(options.stream).read_bytes(), options.trace)
        checksums = b"".join(
            stream.data[row.offset + row.bytes - 4:row.offset + row.bytes] for row in stream.rows)
        if crc32c(checksums) != stream.content_checksum:
            raise Refusal("bad-checksum", "content checksum")
        decoder = Decoder(stream, options)
        last = max(i for i, row in enumerate(stream.rows) if row.kind < FIRST_OPTIONAL)
        for i, row in enumerate(stream.rows if options.vsplit else []):
            decoder.decode(row)
            more = i >= last and i + 1 < len(stream.rows)
            if options.check and row.ends_level and not more:
                decoder.check_level(decoder.level)
    except Refusal as refusal:
        sys.exit(str(refusal))


if __name__ == "__main__":
    main()
