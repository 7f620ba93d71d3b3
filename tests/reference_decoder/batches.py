"""Batch chunks: "Batch chunk", "Connectivity" and "Positions" of proto/STREAM_FORMAT.md."""

from dataclasses import dataclass

from arithmetic import (
    AXES, add, axes_of, clamp, divide, dot, from_bits, int32, l1, l3, scale, single, subtract,
)
from bits import AdaptiveBit, IntegerModel, Refusal, crc32c, log_sum, squash
from header import REFINEMENT_BITS
from mesh import FREE, MANY, REFUSED, TAKEN, face_of, next_corner, prev_corner
from prediction import predict

TABLES = {
    "split_best_edge": 128, "split_second_edge": 32, "split_edge_valence": 192, "split_shape": 32,
    "split_valences": 256, "split_size": 32, "kept_valence": 16, "kept_longer_edge": 64,
    "kept_shorter_edge": 64, "kept_far_edge": 32, "kept_beyond": 256, "grow_start": 64,
    "grow_edge": 128, "grow_cut_valence": 32, "grow_kept_valence": 128, "grow_beyond": 40,
    "grow_length": 64, "grow_centre": 512, "boundary": 16,
}
PACKED_CRC = 0xC0ED69CC
# 0.17, 0.02, 0.3
SURE, LEAN, STEP = map(from_bits, (0x3E2E147B, 0x3CA3D70A, 0x3E99999A))


def coordinate(streams, model, y, name):
    """A coordinate expected at y ("Positions")."""
    if streams.trace:
        streams.trace(f"expected {name} {y:.9g}")
    r = single(y + 0.5) // 1
    rest = single(y - r)
    context = 0 if rest < -SURE else 2 if rest > SURE else 1
    return int(r) + streams.integer(model, context, name)


@dataclass
class Split:
    wedge: list
    seed: int
    boundary: str


class Models:
    """Weights and models as they are behind the base chunk ("Initial state")."""

    def __init__(self, packed):
        if crc32c(packed) != PACKED_CRC:
            raise ValueError("initial_model.inc is not the one of the document")
        self.weights = {}
        at = 0
        for name, entries in TABLES.items():
            values = packed[at:at + entries]
            self.weights[name] = [(b - 256 if b > 127 else b) * 2048 for b in values]
            at += entries
        rest = iter(packed[at:])

        def make(_, __):
            b = next(rest)
            return AdaptiveBit(256 * b + 128, 24) if b else AdaptiveBit()

        self.tangential = [[IntegerModel(make) for _ in range(32)] for _ in range(2)]
        self.along_normal = [IntegerModel(make) for _ in range(48)]
        self.further = [[AdaptiveBit(8192, 8) for _ in range(16)] for _ in range(3)]
        self.prediction = [26, 6, 3, 11, 16]


def bucket(r):
    return clamp(((r + 52) * 13) >> 6, 0, 27)


class Wedge:
    """The wedge while its ends grow ("Does the wedge go on?")."""

    def __init__(self, mesh, kept_corner):
        self.corners = [kept_corner]
        self.kept = mesh.vertex[kept_corner]
        self.origin = tuple(map(float, mesh.positions[self.kept]))
        a, b = mesh.edge(kept_corner)
        self.sum = add(self.vector(mesh, a), self.vector(mesh, b))

    def vector(self, mesh, v):
        return subtract(tuple(map(float, mesh.positions[v])), self.origin)


class Batches:
    """Decodes batch chunks into the mesh."""

    def __init__(self, mesh, models, bits, shift):
        self.mesh = mesh
        self.models = models
        self.bits = bits
        self.shift = shift
        self.drop = 0
        self.moving = 0
        self.refined = 0                                             # vertices of full precision
        self.lacking = 0                                             # end of those that lack it
        self.number = 0
        self.streams = None

    def decode(self, streams, row):
        self.streams = streams
        left = row.splits
        batches = 1
        if row.starts_level:
            self.start_level(row.shift)
        if row.starts_level or self.refined < self.lacking:
            self.refine()
            if self.refined < self.lacking:
                streams.finish()
                return
            batches = streams.raw(3, "batches less one") + 1
            self.start_batch()
        while batches > 1:
            n = streams.raw(12, "splits of the batch")
            if n > left:
                raise Refusal("bad-chunk")
            self.part(n, row)
            left -= n
            self.mesh.end_batch()
            self.start_batch()
            batches -= 1
        self.part(left, row)
        streams.finish()
        if row.ends_level:
            self.mesh.end_batch()
        if len(self.mesh.positions) != row.vertices or self.mesh.faces() != row.faces:
            raise Refusal("bad-chunk")

    def start_level(self, shift):
        d = self.drop = self.shift - shift
        self.shift = shift
        if d == 0:
            return
        self.moving = self.streams.raw(1, "moving")
        for position in self.mesh.positions:
            position[:] = [(x << d) + (1 << (d - 1)) for x in position]
        self.refined, self.lacking = 0, len(self.mesh.positions)

    def refine(self):
        """Brings the next vertices to full precision."""
        d, streams = self.drop, self.streams
        end = self.lacking if d == 0 else min(self.lacking, self.refined + REFINEMENT_BITS // (3 * d))
        for v in range(self.refined, end):
            position = self.mesh.positions[v]
            left = 0
            for axis in range(3):
                name = f"vertex {v} {AXES[axis]}"
                if self.moving:
                    step, further = self._step(d, left, name)
                    left += further
                else:
                    step = streams.raw(d, name)
                position[axis] += step - (1 << (d - 1))
            streams.refuse_exhausted()
        self.refined = end
        self.mesh.check_coordinates(self.most())

    def _step(self, d, left, name):
        streams = self.streams
        upper = streams.raw(1, f"{name} upper")
        cells = 0
        while cells < 16 and streams.adaptive(self.models.further[left][cells], f"{name} further"):
            cells += 1
        half = cells + 1 if upper else -cells
        return (half << (d - 1)) + streams.raw(d - 1, name), cells > 0

    def most(self):
        return ((1 << self.bits) - 1) >> self.shift

    def start_batch(self):
        mesh = self.mesh
        self.number += 1
        self.split_rate = max(650, 4000 // self.number)
        self.wedge_rate = max(1100, 7000 // self.number)
        self.cursor = 0
        mesh.begin_batch()
        for f in range(mesh.faces()):
            mesh.state[f] = FREE
            corners = [tuple(map(float, mesh.positions[v])) for v in mesh.vertex[4 * f:4 * f + 3]]
            for k in range(3):
                d = subtract(corners[(k + 2) % 3], corners[(k + 1) % 3])
                mesh.logs[4 * f + k] = min(255, l3(single(dot(d, d) + 1)))

    def part(self, n, row):
        mesh, streams = self.mesh, self.streams
        splits = []
        while len(splits) < n:
            if self.cursor == mesh.batch_faces:
                raise Refusal("bad-chunk")
            streams.refuse_exhausted()
            if mesh.state[self.cursor] == FREE:
                split = self.ask(self.cursor)
                if split:
                    splits.append(split)
            self.cursor += 1
        if streams.raw(1, "new weights"):
            weights = [streams.raw(8, f"weight {i}") for i in range(5)]
            self.models.prediction = [w - 256 if w > 127 else w for w in weights]
        placed = [self.place(split) for split in splits]
        mesh.positions += placed
        for split in splits:
            mesh.apply(split.wedge, split.seed, split.boundary != "right", split.boundary != "left")
        if mesh.faces() > row.faces:
            raise Refusal("bad-chunk")

    # ---- Connectivity

    def total(self, f):
        return sum(self.mesh.logs[4 * f:4 * f + 3])

    def r(self, c):
        o = self.mesh.opposite[c]
        return 6 * self.mesh.logs[c] - self.total(face_of(c)) - self.total(face_of(o))

    def is_free(self, c):
        """Whether there is a corner and its face is free."""
        return c >= 0 and self.mesh.state[face_of(c)] == FREE

    def q(self, c):
        o = self.mesh.opposite[c]
        return bucket(self.r(c)) + 1 if self.is_free(o) else 0

    def logistic(self, rate, name, **entries):
        weights = self.models.weights
        return self.streams.logistic(rate, [(weights[t], i) for t, i in entries.items()], name)

    def ask(self, f):
        """Asks whether a split covers the face; gives the split or None."""
        mesh = self.mesh
        total = self.total(f)
        across = [mesh.opposite[4 * f + k] for k in range(3)]
        around = [total if o < 0 else self.total(face_of(o)) for o in across]
        free = [self.is_free(o) for o in across]
        e = mesh.logs[4 * f:4 * f + 3]
        b = [bucket(6 * e[k] - total - around[k]) + 1 if free[k] else 0 for k in range(3)]
        local = ((3 * total + sum(around)) * 57) >> 10
        if not self._is_split(f, e, b, sum(free), local):
            mesh.state[f] = REFUSED
            return None
        kept = 4 * f + self._kept(f, e, b)
        mesh.state[f] = TAKEN
        wedge = Wedge(mesh, kept)
        self._grow(wedge, local, right=False)
        self._grow(wedge, local, right=True)
        boundary = self._boundary(wedge)
        self._count_edges(wedge, boundary)
        return Split(wedge.corners, f, boundary)

    def _is_split(self, f, e, b, free, local):
        mesh = self.mesh
        second, best = sorted(b)[1:]
        j = 2 if b[2] > max(b[0], b[1]) else 1 if b[1] > b[0] else 0
        v = [mesh.valence[vertex] for vertex in mesh.vertex[4 * f:4 * f + 3]]
        ends = min(15, max(v[(j + 1) % 3], v[(j + 2) % 3]))
        total, long = sum(e), max(e)
        return self.logistic(
            self.split_rate, f"face {f} split",
            split_best_edge=free * 32 + best,
            split_second_edge=second,
            split_edge_valence=ends * 12 + ((best * 3) >> 3),
            split_shape=clamp(long - ((total - long) >> 1) + 4, 0, 31),
            split_valences=min(15, min(v)) * 16 + min(15, max(v)),
            split_size=clamp(((total * 85) >> 8) - local + 16, 0, 31),
        )

    def _kept_entries(self, f, e, b, k):
        mesh, weights = self.mesh, self.models.weights
        n, p = (k + 1) % 3, (k + 2) % 3
        longer, shorter = max(b[n], b[p]), min(b[n], b[p])
        w = min(15, mesh.valence[mesh.vertex[4 * f + k]])
        beyond = 0
        if b[p]:
            beyond = self.q(next_corner(mesh.opposite[4 * f + p]))
        if b[n]:
            beyond = max(beyond, self.q(prev_corner(mesh.opposite[4 * f + n])))
        return [
            (weights["kept_valence"], w),
            (weights["kept_longer_edge"], longer + (32 if shorter else 0)),
            (weights["kept_shorter_edge"], shorter + (32 if longer > 14 else 0)),
            (weights["kept_far_edge"], clamp(int((3 * e[k] - sum(e)) / 3) + 16, 0, 31)),
            (weights["kept_beyond"], (beyond >> 1) * 16 + w),
        ]

    def _kept(self, f, e, b):
        entries = [self._kept_entries(f, e, b, k) for k in range(3)]
        scores = [
            clamp(int32(sum(table[i] for table, i in of)) >> 8, -2 ** 20, 2 ** 20) for of in entries
        ]
        q0 = squash(scores[0] - log_sum(scores[1], scores[2]))
        q1 = squash(scores[1] - scores[2])
        if self.streams.bit(q0, f"face {f} kept corner 0"):
            kept = 0
        else:
            kept = 1 if self.streams.bit(q1, f"face {f} kept corner 1") else 2
        share = ((65536 - q0) * q1) >> 16
        for k, p in enumerate((q0, share, 65536 - q0 - share)):
            step = (((65535 if k == kept else 0) - p) * self.wedge_rate) >> 15
            for table, i in entries[k]:
                table[i] = int32(table[i] + step)
        return kept

    def _grow(self, wedge, local, right):
        mesh = self.mesh
        turn, back = (prev_corner, next_corner) if right else (next_corner, prev_corner)
        corners = wedge.corners
        grown = 0
        while len(corners) < min(4, mesh.valence[wedge.kept] - 1):
            end = corners[0] if right else corners[-1]
            crossing = turn(end)
            across = mesh.opposite[crossing]
            if not self.is_free(across):
                return
            entered = turn(across)
            cut = mesh.vertex[back(end)]
            a = wedge.vector(mesh, mesh.vertex[across])
            total = add(wedge.sum, a)
            start = ((2 if right else 0) + (1 if grown else 0)) * 8
            if not self._goes_on(wedge, crossing, turn(entered), cut, a, total, start, local):
                return
            grown += 1
            wedge.sum = total
            mesh.state[face_of(across)] = TAKEN
            corners.insert(0 if right else len(corners), entered)

    def _goes_on(self, wedge, crossing, far, cut, a, total, start, local):
        mesh = self.mesh
        length = len(wedge.corners)
        d = length - 1
        longer = 1 if d else 0
        beyond = mesh.opposite[far]
        next_edge = 30
        if beyond >= 0:
            next_edge = bucket(self.r(far)) + 1 if self.is_free(beyond) else 31
        w = min(15, mesh.valence[wedge.kept] - length + 2)
        c = scale(total, divide(1.0, float(length + 3)))
        off = subtract(a, c)
        near = l3(single(dot(off, off) + 1)) - l3(single(dot(c, c) + 1)) + 32
        return self.logistic(
            self.wedge_rate, "right on" if start >= 16 else "left on",
            grow_start=start + d,
            grow_edge=bucket(self.r(crossing)) + 32 * min(d, 2),
            grow_cut_valence=min(15, mesh.valence[cut]) + 16 * longer,
            grow_kept_valence=w * 8 + d,
            grow_beyond=next_edge,
            grow_length=clamp((mesh.logs[crossing] - local + 24) >> 1, 0, 31) + 32 * longer,
            grow_centre=clamp(near, 0, 63) * 8 + d,
        )

    def _boundary(self, wedge):
        mesh = self.mesh
        right_open = mesh.opposite[prev_corner(wedge.corners[0])] < 0
        left_open = mesh.opposite[next_corner(wedge.corners[-1])] < 0
        if not (right_open or left_open):
            return None
        context = 2 * right_open + left_open + 4 * min(len(wedge.corners) - 1, 2)
        if not self.logistic(self.wedge_rate, "boundary", boundary=context):
            return None
        if right_open and left_open:
            right_open = self.logistic(self.wedge_rate, "boundary right", boundary=12)
        return "right" if right_open else "left"

    def _count_edges(self, wedge, boundary):
        mesh, corners = self.mesh, wedge.corners
        if boundary != "right":
            self._add_valence(mesh.vertex[next_corner(corners[0])], 1)
        if boundary != "left":
            self._add_valence(mesh.vertex[prev_corner(corners[-1])], 1)
        self._add_valence(wedge.kept, (1 if boundary else 2) - len(corners))

    def _add_valence(self, v, n):
        valence = self.mesh.valence
        if valence[v] != MANY:
            valence[v] = clamp(valence[v] + n, 0, MANY)

    # ---- Positions

    def place(self, split):
        models, streams = self.models, self.streams
        frame = predict(self.mesh, split.wedge, split.boundary, models.prediction)
        first, second, last = axes_of(frame.normal)
        tangential = models.tangential[1 if split.boundary else 0]
        flat = tangential[clamp(l1(single(frame.radius + 1)), 0, 31)]
        lean = single(abs(frame.lean) * 0.5)
        lean = single(single(lean + single(LEAN * frame.radius)) + STEP)
        normal, expected = frame.normal, frame.expected
        position = [0, 0, 0]
        position[first] = coordinate(streams, flat, expected[first], AXES[first])
        position[second] = coordinate(streams, flat, expected[second], AXES[second])
        a = single(position[first] - expected[first])
        b = single(position[second] - expected[second])
        tilt = single(single(normal[first] * a) + single(normal[second] * b))
        y = single(expected[last] - divide(tilt, normal[last]))
        model = models.along_normal[clamp(l1(lean) + 5, 0, 47)]
        position[last] = coordinate(streams, model, y, AXES[last])
        if not all(0 <= x <= self.most() for x in position):
            raise Refusal("bad-chunk")
        return position
