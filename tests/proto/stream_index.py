"""Header and index, proto/STREAM_FORMAT.md, "Header" and "Index"."""
import struct

from stream_arithmetic import clamp, l3
from stream_models import BitStreams, Refusal, crc32c

MAGIC, VERSION, RESIDUE, ZERO_ERROR = 0x54505356, (0, 2), 0x48674BC7, 320
BASE, BATCH, STITCH, FIRST_OPTIONAL = 0, 1, 64, 64
MAX_CHUNKS, MAX_VERTICES, MAX_FACES, MAX_BYTES = 2**20, 2**28, 2**29 - 2, 2**28


def show_bytes(data, text):
    for begin in range(0, max(1, len(data)), 16):
        print(f"    {data[begin:begin + 16].hex(' '):<26}  {text}".rstrip())
        text = ""


class Reader:
    """Reads the fields of the header and prints each with its bytes."""

    def __init__(self, data):
        self.data, self.position = data, 0

    def show(self, begin, text):
        show_bytes(self.data[begin:self.position], text)

    def take(self, form, name, explain=None):
        begin, size = self.position, struct.calcsize("<" + form)
        if begin + size > len(self.data):
            raise Refusal("truncated", name)
        self.position += size
        value = struct.unpack("<" + form, self.data[begin:self.position])[0]
        form = {"f": ".9g", "d": ".17g", "I": "#x"}.get(form, "")
        self.show(begin, f"{name}: " + (explain(value) if explain else f"{value:{form}}"))
        return value

    def varint(self, name):
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
        self.show(begin, f"{name}: {value}")
        return value


def require(holds, name):
    if not holds:
        raise Refusal("bad-header", name)


class IndexInteger:
    """An integer model as an index begins with it."""

    def __init__(self, nonzero, x):
        self.nonzero = [nonzero, 5]
        self.sign = [[32768, 5], [32768, 5], [2048, 5]]
        self.prefix = [
            [52000 if e < x - 1 else 32768 if e < x else 16384, 5] for e in range(24)]
        self.mantissa = [[[32768, 24] for _ in range(3)] for _ in range(24)]


class Cost:
    """What splits have cost so far."""

    def __init__(self):
        self.bits, self.splits = 320, 16

    def of(self, splits):
        return splits * self.bits // self.splits

    def share(self, splits, chunks, refinement):
        share = (self.of(splits) + refinement) // chunks
        return min(max(share - refinement, 0) * self.splits // self.bits, splits)

    def length(self, splits, refinement):
        return min((self.of(splits) + refinement + 7) // 8 + 6, MAX_BYTES)

    def observe(self, splits, length, refinement):
        if splits == 0:
            return
        self.bits += max(8 * length - refinement - 48, 2 * splits)
        self.splits += splits
        while self.splits >= 256:
            self.bits, self.splits = self.bits // 2, self.splits // 2


class Row:
    """One row of the index."""

    def __init__(self, kind, codec):
        self.kind, self.codec = kind, codec


class Index:
    """The rows."""

    def __init__(self, bits, position_bits):
        self.bits, self.position_bits, self.rows, self.cost = bits, position_bits, [], Cost()
        self.other_kind, self.has_boundary = [2048, 4], [8192, 2]
        self.model = {
            name: IndexInteger(nonzero, x) for name, nonzero, x in (
                ("chunks of the level", 28000, 0), ("splits of the level", 60000, 4),
                ("drop of the shift", 20000, 0), ("splits", 2000, 0),
                ("boundary splits", 56000, 2), ("bytes", 40000, 1), ("RMS error", 44000, 1),
                ("maximum error", 56000, 2))}
        self.kind, self.chunks_left, self.level_chunks = (BATCH, 0), 0, 1
        self.boundary = (1, 4)
        count = self.number("chunks")
        require(1 <= count <= MAX_CHUNKS, "chunks")
        self.base()
        while len(self.rows) < count:
            if bits.exhausted():
                raise Refusal("bad-header", "index")
            self.row()
        require(self.chunks_left == 0, "last level")

    def number(self, name):
        width = self.bits.raw(5, name + ", digits")
        return width if width < 2 else 2 ** (width - 1) + self.bits.raw(width - 1, name)

    def first_error(self, name):
        code = self.bits.raw(6, name)
        return code if code < 63 else self.bits.raw(9, name)

    def near(self, name, expected, fineness, most):
        raw = max(0, expected.bit_length() - fineness)
        steps = (expected >> raw) + self.bits.integer(self.model[name], 0, name)
        value = steps * 2**raw + self.bits.raw(raw, name + " low bits")
        require(0 <= value <= most, name)
        return value

    def add(self, row):
        self.bits.show(
            f"row {len(self.rows)}: kind {row.kind}, {row.bytes} bytes, {self.vertices} vertices, "
            f"{self.faces} faces, shift {self.shift}" + (
                ", level complete" if row.kind < FIRST_OPTIONAL and self.chunks_left == 0 else ""))
        row.vertices, row.faces, row.shift = self.vertices, self.faces, self.shift
        row.ends_level = self.chunks_left == 0
        self.rows.append(row)

    def base(self):
        raw = self.bits.raw
        row = Row(BASE, raw(2, "codec"))
        if row.codec > 1:
            raise Refusal("unknown-required-chunk", "base codec")
        self.vertices = self.number("base vertices")
        closed = raw(1, "as many faces as a closed mesh")
        self.faces = 2 * self.vertices - 4 if closed else self.number("base faces")
        row.bytes, self.shift = self.number("base bytes"), raw(5, "base shift")
        self.codes = [self.first_error("RMS error code"), self.first_error("maximum error code")]
        require(self.shift < self.position_bits, "base shift")
        require(3 <= self.vertices <= MAX_VERTICES, "base vertices")
        require(1 <= self.faces <= MAX_FACES, "base faces")
        require(max(self.codes) <= ZERO_ERROR, "error")
        self.level_start, self.level_splits = self.vertices, self.vertices // 2
        self.add(row)

    def row(self):
        if self.bits.adaptive(self.other_kind, "other kind"):
            self.kind = self.bits.raw(8, "kind"), self.bits.raw(8, "codec")
        row = Row(*self.kind)
        if row.kind >= FIRST_OPTIONAL:
            row.bytes = self.number("bytes")
        elif self.kind == (BATCH, 0):
            self.batch(row)
        elif row.kind == BASE:
            raise Refusal("bad-header", "second base")
        else:
            raise Refusal("unknown-required-chunk", f"kind {row.kind} codec {row.codec}")
        self.add(row)

    def batch(self, row):
        if self.chunks_left == 0:
            self.level()
        refined = min(self.unrefined, 2**18 // (3 * self.drop)) if self.unrefined else 0
        self.unrefined -= refined
        refinement = (9 if self.shift + self.drop >= 2 else 6) * refined * self.drop // 2
        splits = boundary = 0
        if self.unrefined > 0:
            require(self.chunks_left > 1, "chunks of the level")
        else:
            splits, boundary = self.splits(refinement)
        row.bytes = self.near("bytes", self.cost.length(splits, refinement), 4, MAX_BYTES)
        self.cost.observe(splits, row.bytes, refinement)
        self.vertices += splits
        self.faces += 2 * splits - boundary
        require(self.faces <= MAX_FACES, "faces")
        self.splits_left -= splits
        self.chunks_left -= 1
        if self.chunks_left == 0:
            self.errors()

    def splits(self, refinement):
        splits = self.splits_left if self.chunks_left == 1 else self.near(
            "splits", self.cost.share(self.splits_left, self.chunks_left, refinement), 16,
            self.splits_left)
        if not self.bits.adaptive(self.has_boundary, "boundary splits"):
            return splits, 0
        expected = min(splits * self.boundary[0] // self.boundary[1], splits)
        boundary = self.near("boundary splits", expected, 3, splits)
        self.boundary = (boundary, max(1, splits))
        return splits, boundary

    def level(self):
        self.level_chunks += self.bits.integer(
            self.model["chunks of the level"], 0, "chunks of the level")
        require(1 <= self.level_chunks <= MAX_CHUNKS, "chunks of the level")
        most = MAX_VERTICES - self.vertices
        expected = min(self.level_splits * self.vertices // self.level_start, most)
        self.level_splits = self.near("splits of the level", expected, 16, most)
        self.drop = self.bits.integer(self.model["drop of the shift"], 2, "drop of the shift")
        require(0 <= self.drop <= self.shift, "drop of the shift")
        self.cost.bits += self.cost.splits * 3 * max(self.drop - 2, 0)
        self.shift -= self.drop
        self.unrefined = self.vertices if self.drop > 0 else 0
        self.level_start = self.vertices
        self.chunks_left, self.splits_left = self.level_chunks, self.level_splits

    def errors(self):
        before, maximum = self.codes
        expected = before + l3(self.vertices) - l3(self.level_start)
        rms = self.error("RMS error", expected, 1 if self.drop else 0)
        self.codes = [rms, self.error("maximum error", maximum + rms - before, 0)]

    def error(self, name, expected, context):
        expected = clamp(expected, 0, ZERO_ERROR)
        code = expected + self.bits.integer(self.model[name], context, name)
        require(0 <= code <= ZERO_ERROR, name)
        share = 0.0 if code == ZERO_ERROR else 2.0 ** (-code / 8)
        self.bits.show(f"{name} code {code}, {share * 100:.3f} % of the diagonal")
        return code


class Stream:
    """Header, index and chunks of a file."""

    def __init__(self, data, verbose):
        self.data = data
        self.read_header(Reader(data[:9]), verbose)

    def read_header(self, reader, verbose):
        if reader.take("I", "magic") != MAGIC:
            raise Refusal("bad-magic", "magic")
        version = reader.take("B", "version", lambda v: f"{v >> 4}.{v & 15}")
        if (version >> 4, version & 15) != VERSION:
            raise Refusal("unsupported-version", "version")
        end = reader.varint("header bytes")
        require(end >= 9, "header bytes")
        if len(self.data) < end:
            raise Refusal("truncated", "header")
        if crc32c(self.data[:end]) != RESIDUE:
            raise Refusal("bad-checksum", "header")
        reader.data = self.data[:end - 4]
        grid = reader.take("B", "position bits and flags")
        self.bits, form = grid & 0x5F, "f" if grid & 0x80 else "d"
        require(8 <= self.bits <= 20, "position bits")
        self.origin = [reader.take(form, f"origin {axis}") for axis in "xyz"]
        self.cell = reader.take(form, "cell")
        self.content_checksum = reader.take("I", "content checksum")
        for _ in range(reader.varint("attributes") if grid & 0x20 else 0):
            reader.position += reader.varint("attribute length")
        show_bytes(reader.data[reader.position:], "extent and index")
        show_bytes(self.data[end - 4:end], "checksum")
        bits = BitStreams(reader.data[reader.position:], verbose, "bad-header")
        full = bits.raw(2, "longest axis")
        self.extent = [
            2**self.bits - 1 if i == full else bits.raw(self.bits, f"extent {axis}")
            for i, axis in enumerate("xyz")]
        self.rows = Index(bits, self.bits).rows
        bits.finish()
        for row in self.rows:
            row.offset = end
            end += row.bytes

    def contents(self, row):
        chunk = self.data[row.offset:row.offset + row.bytes]
        if len(chunk) < row.bytes:
            raise Refusal("truncated", "chunk")
        if row.bytes < 4 or crc32c(chunk) != RESIDUE:
            raise Refusal("bad-checksum", "chunk")
        return chunk[:-4]

    def grid_index(self, point, shift):
        """The grid index that a shown point stands for."""
        return tuple(
            round(((p - o) / self.cell - (2**shift - 1) * 0.5) / 2**shift)
            for p, o in zip(point, self.origin))
