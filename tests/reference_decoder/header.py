"""Header and index of proto/STREAM_FORMAT.md ("Header", "Index")."""

import math
from dataclasses import dataclass

from arithmetic import AXES, clamp, digits, l3, single
from bits import AdaptiveBit, BitStreams, IntegerModel, Refusal, crc32c, trace_bytes
from fields import Attribute, Entry, HeaderBytes, require

BASE, BATCH, GROWTH, PARTS, STITCH, ATTRIBUTES, FIRST_OPTIONAL = 0, 1, 2, 3, 64, 65, 64
RESIDUE = 0x48674BC7
MAX_VERTICES, MAX_FACES, MAX_CHUNKS, MAX_LEVELS = 268435456, 536870910, 1048576, 1024
MAX_ATTRIBUTES = 16
MAX_CHUNK_BYTES = 2 ** 28
MAX_PARTS_VERTICES, MAX_PARTS_FACES = 4096, 3
REFINEMENT_BITS = 262144
DRACO_BASE, SMALL_BASE = 0, 1
# Probability of nonzero and the size x of the index's integer models.
MODELS = {
    "level chunks": (28000, 0), "level splits": (60000, 4), "drop": (20000, 0), "splits": (2000, 0),
    "boundary": (56000, 2), "bytes": (40000, 1), "RMS": (44000, 1), "maximum": (56000, 2),
}


@dataclass
class Row:
    kind: int
    codec: int = 0
    size: int = 0
    vertices: int = 0
    faces: int = 0
    splits: int = 0
    shift: int = 0
    starts_level: bool = False
    ends_level: bool = False
    errors: tuple = (0, 0)
    grown: tuple = (0, 0)
    tag: int = 0


def header_length(data):
    """Length of header and index, checked as far as nine bytes allow."""
    if data[:4] != b"VSPT"[:len(data)]:
        raise Refusal("bad-magic")
    if len(data) < 9:
        raise Refusal("truncated")
    if data[4] != 5:
        raise Refusal("unsupported-version")
    if all(byte >= 128 for byte in data[5:9]):
        raise Refusal("bad-header")
    length = HeaderBytes(data[5:9]).varint()
    if length < 9:
        raise Refusal("bad-header")
    if length > 16777216:
        raise Refusal("limit-exceeded")
    if length > len(data):
        raise Refusal("truncated")
    return length


class Header:
    """Grid and rows; fields in the order of the document."""

    def __init__(self, data, trace=None):
        self.length = header_length(data)
        data = data[:self.length]
        if crc32c(data) != RESIDUE:
            raise Refusal("bad-checksum")
        fields = HeaderBytes(data[:-4])
        take = self._taker(fields, trace)
        take("magic", lambda: f"0x{fields.unpack('I'):x}")
        take("version", lambda: "{}.{}".format(*divmod(fields.unpack("B"), 16)))
        take("header bytes", fields.varint)
        flags = take("position bits and flags", lambda: fields.unpack("B"))
        self.bits = flags & ~0xA0
        if not 8 <= self.bits <= 20:
            raise Refusal("bad-header")
        real = "f" if flags & 0x80 else "d"
        self.origin = [take(f"origin {axis}", lambda: fields.unpack(real)) for axis in AXES]
        self.cell = take("cell", lambda: fields.unpack(real))
        if not (all(map(math.isfinite, [*self.origin, self.cell])) and self.cell > 0):
            raise Refusal("bad-header")
        take("content checksum", lambda: f"0x{fields.unpack('I'):x}")
        self.wedges, self.attributes = None, []
        if flags & 0x20:
            self.wedges = take("wedges", fields.varint)
            count = take("attributes", fields.varint)
            require(count <= MAX_ATTRIBUTES)
            for i in range(count):
                entry = take(f"attribute {i}", lambda: Entry(fields))
                self.attributes.append(Attribute(entry.data))
        if trace:
            trace_bytes(trace, data[fields.at:-4], "extent and index")
            trace_bytes(trace, data[-4:], "checksum")
        self._read_index(BitStreams(data[fields.at:-4], "bad-header", trace))

    def _taker(self, fields, trace):
        def take(name, read):
            begin = fields.at
            value = read()
            if trace:
                shown = f"{value:.9g}" if isinstance(value, float) else value
                trace_bytes(trace, fields.data[begin:fields.at], f"{name}: {shown}")
            return value

        return take

    def _read_index(self, streams):
        index = Index(streams, self.bits)
        self.extent = index.extent
        edges = [extent * self.cell for extent in self.extent]
        diagonal_squared = sum(edge * edge for edge in edges)
        if not math.isfinite(diagonal_squared):
            raise Refusal("bad-header")
        self.rows = index.rows
        if self.wedges is not None:
            require(index.vertices <= self.wedges <= 3 * index.faces)
        streams.finish()


def _model(nonzero, x):
    def make(name, e):
        if name == "nonzero":
            return AdaptiveBit(nonzero, 5)
        if name == "prefix":
            return AdaptiveBit(52000 if e < x - 1 else 32768 if e == x - 1 else 16384, 5)
        if name == "sign":
            return AdaptiveBit(2048 if e == 2 else 32768, 5)
        return AdaptiveBit(32768, 24)

    return IntegerModel(make)


class Index:
    def __init__(self, streams, bits):
        self.streams = streams
        self.extent = self._extent(bits)
        chunks = self.number("chunks")
        require(1 <= chunks <= MAX_CHUNKS)
        self.other_kind = AdaptiveBit(2048, 4)
        self.has_boundary = AdaptiveBit(8192, 2)
        self.models = {name: _model(*of) for name, of in MODELS.items()}
        self.rows = []
        self._base(bits)
        self.following = {kind: (BATCH, 0) for kind in range(256)}
        self.following[GROWTH] = GROWTH, 0
        self.levels = 1
        self.level_chunks, self.left_chunks = 1, 0
        self.level_splits = self.vertices // 2
        self.start_vertices = self.vertices
        self.left_splits = 0
        self.drop = self.unrefined = 0
        self.old_shift = self.shift
        self.growing = self.parts_start = None
        self.cost, self.seen = 320, 16
        self.boundary = 1, 4
        while len(self.rows) < chunks:
            self._other()
            self._trace_row()
            streams.refuse_exhausted()
        require(self.left_chunks == 0 and self.parts_start is None and self.shift == 0)

    def _extent(self, bits):
        raw = self.streams.raw
        full = raw(2, "longest axis")
        return [
            2 ** bits - 1 if axis == full else raw(bits, f"extent {AXES[axis]}") for axis in range(3)
        ]

    def number(self, name):
        w = self.streams.raw(5, f"{name}, digits")
        require(w <= 29)
        return w if w < 2 else (1 << (w - 1)) + self.streams.raw(w - 1, name)

    def near(self, model, expected, fineness, most, name):
        r = max(0, digits(expected) - fineness)
        value = ((expected >> r) + self.streams.integer(self.models[model], 0, name)) << r
        value += self.streams.raw(r, f"{name} low bits")
        require(0 <= value <= most)
        return value

    def _base(self, bits):
        raw = self.streams.raw
        codec = raw(2, "codec")
        require(codec <= SMALL_BASE, "unknown-required-chunk")
        self.vertices = self.number("base vertices")
        require(3 <= self.vertices <= MAX_VERTICES)
        if raw(1, "as many faces as a closed mesh"):
            self.faces = 2 * self.vertices - 4
        else:
            self.faces = self.number("base faces")
        require(1 <= self.faces <= MAX_FACES)
        size = self.number("base bytes")
        require(size <= MAX_CHUNK_BYTES, "limit-exceeded")
        self.shift = raw(5, "base shift")
        self.errors = self._code("RMS error code"), self._code("maximum error code")
        require(self.shift < bits and max(self.errors) <= 320)
        self._append(Row(BASE, codec, size, ends_level=True))
        self._trace_row()

    def _code(self, name):
        code = self.streams.raw(6, name)
        return code if code < 63 else self.streams.raw(9, name)

    def _append(self, row):
        row.vertices, row.faces, row.shift = self.vertices, self.faces, self.shift
        row.errors = self.errors
        require(row.size <= MAX_CHUNK_BYTES, "limit-exceeded")
        self.rows.append(row)

    def _other(self):
        before = self.rows[-1].kind
        if self.streams.adaptive(self.other_kind, "other kind"):
            self.following[before] = divmod(self.streams.raw(16, "kind and codec"), 256)
        kind, codec = self.following[before]
        if kind >= FIRST_OPTIONAL:
            size = self.number("bytes")
            self._append(Row(kind, codec, size, tag=self.number("tag")))
            return
        require(kind != BASE)
        if kind not in (BATCH, GROWTH, PARTS) or codec != 0:
            raise Refusal("unknown-required-chunk")
        if kind == GROWTH:
            require(self.parts_start is None)
            self._growth()
            return
        require(self.growing is None)
        if kind == PARTS:
            self._parts()
        else:
            require(self.parts_start is None)
            self._batch()

    def _batch(self):
        starts = self.left_chunks == 0
        if starts:
            self._level_start()
        refinement = self._refinement()
        c, s = self.cost, self.seen
        equal = (self.left_splits * c // s + refinement) // self.left_chunks
        share = min(max(equal - refinement, 0) * s // c, self.left_splits)
        self.left_chunks -= 1
        ends = self.left_chunks == 0
        splits = boundary = 0
        if self.unrefined > 0:
            require(not ends)
        else:
            splits, boundary = self._splits(share, ends)
        self.left_splits -= splits
        length = min((splits * c // s + refinement + 7) // 8 + 6, MAX_CHUNK_BYTES)
        size = self.near("bytes", length, 4, MAX_CHUNK_BYTES, "bytes")
        self.vertices += splits
        self.faces += 2 * splits - boundary
        require(self.faces <= MAX_FACES)
        if ends:
            self._error_codes(self.vertices, self.start_vertices, self.drop)
        if splits > 0:
            self.cost += max(8 * size - refinement - 48, 2 * splits)
            self.seen += splits
        while self.seen >= 256:
            self.cost, self.seen = self.cost // 2, self.seen // 2
        self._append(Row(BATCH, 0, size, splits=splits, starts_level=starts, ends_level=ends))

    def _level_start(self):
        """Reads what the first row of a level says of it."""
        self.levels += 1
        require(self.levels <= MAX_LEVELS)
        streams = self.streams
        self.level_chunks += streams.integer(self.models["level chunks"], 0, "chunks of the level")
        require(1 <= self.level_chunks <= MAX_CHUNKS)
        self.left_chunks = self.level_chunks
        most = MAX_VERTICES - self.vertices
        expected = self.level_splits * self.vertices // self.start_vertices
        self.level_splits = self.near(
            "level splits", min(expected, most), 16, most, "splits of the level"
        )
        self.start_vertices = self.vertices
        self.left_splits = self.level_splits
        self.drop = streams.integer(self.models["drop"], 2, "drop of the shift")
        require(0 <= self.drop <= self.shift)
        self.old_shift, self.shift = self.shift, self.shift - self.drop
        self.unrefined = self.vertices if self.drop > 0 else 0
        self.cost += 3 * self.seen * max(self.drop - 2, 0)

    def _refinement(self):
        """Bits for the vertices that the chunk brings to full precision."""
        if self.unrefined == 0:
            return 0
        refined = min(self.unrefined, REFINEMENT_BITS // (3 * self.drop))
        self.unrefined -= refined
        return (9 if self.old_shift >= 2 else 6) * refined * self.drop // 2

    def _splits(self, share, ends):
        """Reads the numbers of splits and of boundary splits."""
        splits = self.left_splits
        if not ends:
            splits = self.near("splits", share, 16, self.left_splits, "splits")
        if not self.streams.adaptive(self.has_boundary, "boundary splits"):
            return splits, 0
        expected = splits * self.boundary[0] // max(1, self.boundary[1])
        boundary = self.near("boundary", min(expected, splits), 3, splits, "boundary splits")
        self.boundary = boundary, splits
        return splits, boundary

    def _error_codes(self, vertices, start, drop):
        rms, maximum = self.errors
        expected = rms + l3(single(vertices)) - l3(single(start))
        new_rms = clamp(expected, 0, 320) + self.streams.integer(
            self.models["RMS"], 1 if drop > 0 else 0, "RMS error"
        )
        self._trace_error("RMS", new_rms)
        expected = maximum + new_rms - rms
        new_maximum = clamp(expected, 0, 320) + self.streams.integer(
            self.models["maximum"], 0, "maximum error"
        )
        self._trace_error("maximum", new_maximum)
        require(0 <= new_rms <= 320 and 0 <= new_maximum <= 320)
        self.errors = new_rms, new_maximum

    def _parts(self):
        require(self.left_chunks == 0)
        if self.parts_start is None:
            self.levels += 1
            require(self.levels <= MAX_LEVELS)
            self.parts_start = self.vertices
        vertices, faces = self.number("vertices"), self.number("faces")
        require(3 <= vertices <= MAX_PARTS_VERTICES and 1 <= faces <= MAX_PARTS_FACES * vertices)
        size = self.number("bytes")
        last = self.streams.raw(1, "last of the level") == 1
        self.vertices += vertices
        self.faces += faces
        require(self.vertices <= MAX_VERTICES and self.faces <= MAX_FACES)
        if last:
            self._error_codes(self.vertices, self.parts_start, 0)
            self.parts_start = None
        self._append(Row(PARTS, 0, size, ends_level=last))

    def _growth(self):
        starts = self.growing is None
        if starts:
            require(self.left_chunks == 0)
            self.levels += 1
            require(self.levels <= MAX_LEVELS)
            self.left_chunks = self.number("chunks of the level")
            require(1 <= self.left_chunks <= MAX_CHUNKS)
            self.growing = self.number("vertices"), self.number("faces")
            require(self.vertices <= self.growing[0] <= MAX_VERTICES)
            require(1 <= self.growing[1] <= MAX_FACES)
            self.start_vertices = self.vertices
            codes_before = self.errors
            self._error_codes(self.growing[0], self.start_vertices, self.drop)
            self.growth_errors, self.errors = self.errors, codes_before
        require(self.left_chunks > 0)
        size = self.number("bytes")
        self.left_chunks -= 1
        ends = self.left_chunks == 0
        if ends:
            (self.vertices, self.faces), self.shift = self.growing, 0
            self.errors = self.growth_errors
        row = Row(GROWTH, 0, size, starts_level=starts, ends_level=ends, grown=self.growing)
        self._append(row)

    def _trace_row(self):
        if not self.streams.trace:
            return
        row = self.rows[-1]
        end = ", level complete" if row.ends_level else ""
        self.streams.trace(
            f"row {len(self.rows) - 1}: kind {row.kind}, {row.size} bytes, {row.vertices} vertices, "
            f"{row.faces} faces, shift {row.shift}{end}"
        )

    def _trace_error(self, name, code):
        if self.streams.trace:
            percent = 100 * 2 ** (-code / 8) if code < 320 else 0
            self.streams.trace(f"{name} error code {code}, {percent:.3f} % of the diagonal")
