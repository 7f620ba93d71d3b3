#!/usr/bin/env python3
"""Decodes a .vsplit stream as proto/STREAM_FORMAT.md says and prints what it reads.

Written from that document alone, with its names, as plainly as possible; it is slow. The base mesh
inside the stream is a Draco mesh, which the vsplit tool decodes: --vsplit BIN; without it only header and
index are shown. --check compares every level with what the tool makes of it. --trace prints every byte,
decision, vertex and triangle; the document's worked stream is shown that way.
"""
import argparse
import pathlib
import struct
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
sys.path.insert(0, str(pathlib.Path(__file__).parent))
from stream_models import BitStreams, Refusal, crc32c  # noqa: E402
from stream_splits import Mesh, Splits  # noqa: E402

MAGIC, HEADER_BYTES, ZERO_ERROR = 0x54505356, 16, 1280
BASE, BATCH, STITCH, FIRST_OPTIONAL = 0, 1, 64, 64


def show_bytes(data, text):
    for begin in range(0, max(1, len(data)), 16):
        print(f"    {data[begin:begin + 16].hex(' '):<26}  {text}".rstrip())
        text = ""


class Reader:
    """Reads the fields of the header and prints each with its bytes."""

    def __init__(self, data, position, verbose):
        self.data, self.position, self.verbose = data, position, verbose

    def show(self, begin, text):
        if self.verbose:
            show_bytes(self.data[begin:self.position], text)

    def take(self, form, name):
        begin, size = self.position, struct.calcsize("<" + form)
        if begin + size > len(self.data):
            raise Refusal("truncated", name)
        self.position += size
        value = struct.unpack("<" + form, self.data[begin:self.position])[0]
        form = {"f": ".9g", "d": ".17g", "I": "#x"}.get(form, "") if name != "header bytes" else ""
        self.show(begin, f"{name}: {value:{form}}")
        return value

    def varint(self, name, explain=str):
        begin, value = self.position, 0
        for shift in range(0, 70, 7):
            if self.position >= len(self.data):
                raise Refusal("truncated", name)
            byte = self.data[self.position]
            self.position += 1
            value |= (byte & 127) << shift
            if byte < 128:
                break
        if byte >= 128 or value >> 64:
            raise Refusal("bad-header", name)
        self.show(begin, f"{name}: {explain(value)}")
        return value


def unzigzag(value):
    return value // 2 if value % 2 == 0 else -(value + 1) // 2


class Row:
    """One row of the index."""

    def __init__(self, kind, codec, offset):
        self.kind, self.codec, self.offset, self.ends_level = kind, codec, offset, True


class Stream:
    """Header, index and chunks of a file."""

    def __init__(self, data, verbose):
        self.data, self.verbose = data, verbose
        if len(data) < HEADER_BYTES:
            raise Refusal("truncated", "fixed header")
        self.read_header(Reader(data, 0, verbose))

    def read_header(self, reader):
        if reader.take("I", "magic") != MAGIC:
            raise Refusal("bad-magic", "magic")
        if (reader.take("B", "major version"), reader.take("B", "minor version")) != (0, 1):
            raise Refusal("unsupported-version", "version")
        if reader.take("H", "flags") != 0:
            raise Refusal("bad-header", "flags")
        end = reader.take("I", "header bytes")
        if len(self.data) < end:
            raise Refusal("truncated", "header")
        if reader.take("I", "checksum") != crc32c(self.data[16:end], crc32c(self.data[:12])):
            raise Refusal("bad-checksum", "header")
        reader.data = self.data[:end]
        bits = reader.take("B", "position bits and flag")
        self.bits, form = bits & 0x7F, "f" if bits & 0x80 else "d"
        self.origin = [reader.take(form, f"origin {axis}") for axis in "xyz"]
        self.cell = reader.take(form, "cell")
        self.extent = [reader.varint(f"extent {axis}") for axis in "xyz"]
        self.vertices, self.faces = reader.varint("vertices"), reader.varint("faces")
        self.content_checksum = reader.take("I", "content checksum")
        for _ in range(reader.varint("attributes")):
            reader.position += reader.varint("attribute length")
        self.read_index(reader, end)
        if reader.position != end:
            raise Refusal("bad-header", "bytes behind the index")

    def read_index(self, reader, offset):
        count, self.rows = reader.varint("chunks"), []
        self.codes, self.now = [0, 0], [0, 0]
        while len(self.rows) < count:
            run = reader.varint("chunks of the run")
            kind, codec = reader.take("B", "kind"), reader.take("B", "codec")
            for _ in range(run):
                row = Row(kind, codec, offset)
                self.read_row(reader, row)
                offset += row.bytes
                self.rows.append(row)
        if self.now != [self.vertices, self.faces]:
            raise Refusal("bad-header", "counts")

    def read_row(self, reader, row):
        def explain(v):
            return f"{v >> 2}" + (", continues" if v & 1 else "") + (", boundary" if v & 2 else "")

        length = reader.varint("chunk bytes", explain)
        row.bytes = length >> 2
        if row.kind >= FIRST_OPTIONAL:
            return
        if row.kind > BATCH or row.codec != 0:
            raise Refusal("unknown-required-chunk", f"kind {row.kind} codec {row.codec}")
        if row.kind == BASE:
            self.now = [reader.varint("base vertices"), reader.varint("base faces")]
        else:
            splits = reader.varint("splits")
            boundary = reader.varint("boundary splits") if length & 2 else 0
            self.now = [self.now[0] + splits, self.now[1] + 2 * splits - boundary]
        row.ends_level = length & 1 == 0
        if row.ends_level:
            for i, name in enumerate(("RMS", "maximum")):
                self.codes[i] += unzigzag(reader.varint(f"{name} error code", self.explain_code(i)))
        row.vertices, row.faces = self.now

    def explain_code(self, which):
        def explain(value):
            code = self.codes[which] + unzigzag(value)
            share = 0.0 if code == ZERO_ERROR else 2.0 ** (-code / 32)
            return f"{code}, {share * 100:.4f} % of the diagonal"
        return explain

    def contents(self, row):
        chunk = self.data[row.offset:row.offset + row.bytes]
        if len(chunk) < row.bytes:
            raise Refusal("truncated", "chunk")
        if row.bytes < 4 or crc32c(chunk) != 0x48674BC7:
            raise Refusal("bad-checksum", "chunk")
        return chunk[:-4]

    def grid_index(self, point, shift):
        """The grid index that a shown point stands for."""
        return tuple(
            round(((p - o) / self.cell - (2**shift - 1) * 0.5) / 2**shift)
            for p, o in zip(point, self.origin))


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
            self.decode_base(contents[0])
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
        if row.kind == BASE:
            show_bytes(contents[:1], f"shift: {contents[0]}")
            show_bytes(contents[1:], "Draco mesh")
        else:
            bits = BitStreams(contents, False)
            end = len(contents) - bits.modelled_bytes
            begin = end - len(bits.raw_bytes)
            show_bytes(contents[:begin], f"raw bytes: {len(bits.raw_bytes)}")
            show_bytes(contents[begin:end], "raw bits")
            show_bytes(contents[end:], "modelled bits")
        show_bytes(self.stream.data[row.offset:row.offset + row.bytes][-4:], "checksum")

    def show_mesh(self):
        if self.options.trace:
            mesh = self.splits.mesh
            for vertex, position in enumerate(mesh.positions):
                print(f"    vertex {vertex}: {position}")
            for slot, triangle in enumerate(mesh.triangles()):
                print(f"    triangle {slot}: {triangle}")

    def decode_base(self, shift):
        points, triangles = self.tool_mesh(0)
        positions = [self.stream.grid_index(point, shift) for point in points]
        self.splits = Splits(Mesh(positions, triangles, self.stream.bits, shift))

    def decode_batch(self, row, bits):
        splits, batches = self.splits, 1
        if not self.open:
            splits.start_level(bits)
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
        stream = Stream(pathlib.Path(options.stream).read_bytes(), True)
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
