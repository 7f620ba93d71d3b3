"""Attributes chunks: "Attributes chunk" of proto/STREAM_FORMAT.md."""

import math
import struct

from arithmetic import clamp, l1, single
from bits import AdaptiveBit, IntegerModel, Refusal
from mesh import next_corner, prev_corner
from planes import Expected, Plane, add64, dot64, unit_or
from wedges import Level, WedgeDecoder, WedgeModels, decode_groups

VALUES, NORMALS, LATE_BITS = 0, 1, 2
TEX_COORD, NORMAL, COLOR = 0, 1, 2
MAX_GROUPS = 65536
CONTEXTS = 24
MOST_TWINS = 64


def _initial(c, x):
    mean = 2.0 ** ((c - 4) / 2)
    return math.floor(65536 * clamp(math.exp(-x / mean), 0.01, 0.99) + 0.5)


INITIAL_RESIDUALS = [
    [_initial(c, 0.5), *(_initial(c, 2.0 ** e) for e in range(24))] for c in range(CONTEXTS)
]


def initial_residuals():
    """The table of the document, as bytes."""
    return struct.pack("<600H", *(p for row in INITIAL_RESIDUALS for p in row))


def residual_model():
    def make(row):
        def bit(name, i):
            if name == "nonzero":
                return AdaptiveBit(row[0], 4)
            return AdaptiveBit(row[1 + i], 4) if name == "prefix" else AdaptiveBit()

        return bit

    return [IntegerModel(make(row)) for row in INITIAL_RESIDUALS]


def middle(number, lacks):
    return number if lacks == 0 else (number >> lacks << lacks) + (1 << (lacks - 1))


def refine(streams, number, before, now, name):
    """A number that lacked `before` bits and now lacks `now`."""
    more = before - now
    return middle(((number >> before << more) + streams.raw(more, name)) << now, now)


class Order:
    """Corners of wedges, and which wedge comes next ("Order of wedges")."""

    def __init__(self, level, known):
        count = len(level.vertices)
        self.level = level
        self.corners = [[] for _ in range(count)]
        for c, wedge in enumerate(level.wedges):
            if wedge is not None:
                self.corners[wedge].append(c)
        self.known = [w < known for w in range(count)]
        self.priority = [0] * count
        self.stacks = [{} for _ in range(32)]
        for w in range(count - 1, known - 1, -1):
            total = 0
            for a, b in self._beside(w):
                a, b = int(self.known[a]), int(self.known[b])
                total += a + b + 2 * a * b
            self.priority[w] = min(31, total)
            self.stacks[self.priority[w]][w] = True

    def _beside(self, w):
        wedges = self.level.wedges
        return [(wedges[next_corner(c)], wedges[prev_corner(c)]) for c in self.corners[w]]

    def around(self, w):
        return [x for pair in self._beside(w) for x in pair]

    def take(self):
        return next(stack for stack in reversed(self.stacks) if stack).popitem()[0]

    def know(self, w):
        self.known[w] = True
        for a, b in self._beside(w):
            self._raise(a, 3 if self.known[b] else 1)
            self._raise(b, 3 if self.known[a] else 1)

    def _raise(self, w, n):
        priority = min(31, self.priority[w] + n)
        if not self.known[w] and priority != self.priority[w]:
            del self.stacks[self.priority[w]][w]
            self.priority[w] = priority
            self.stacks[priority][w] = True


class Values:
    """The values of a level's new wedges."""

    def __init__(self, attributes, level, known, values, models, lacks):
        self.lacks = lacks
        self.attributes = attributes
        self.order = Order(level, known)
        self.level = level
        self.values = values
        self.models = models
        self.left = len(level.vertices) - known
        self.sizes = {}
        self.of_vertex = {}
        for w, v in enumerate(level.vertices):
            self.of_vertex.setdefault(v, []).append(w)
        for a, info in enumerate(attributes):
            if info.kind != NORMAL:
                self.values[a] += [None] * self.left

    def decode(self, streams):
        w = self.order.take()
        plane = Plane(self.level, self.order, w)
        own = self.of_vertex[self.level.vertices[w]][:MOST_TWINS]
        twin = next((x for x in own if self.order.known[x]), None)
        for a, info in enumerate(self.attributes):
            if info.kind == NORMAL:
                continue
            same, _ = self.models[a]
            if twin is not None and streams.adaptive(same, f"wedge {w} same value"):
                self.values[a][w] = self.values[a][twin]
            else:
                self.values[a][w] = self._numbers(streams, a, w, plane, twin)
        self.order.know(w)
        self.left -= 1

    def _numbers(self, streams, a, w, plane, twin):
        info = self.attributes[a]
        numbers = []
        before = None
        for k in range(info.numbers):
            low, high = info.number_range(k)
            lacks = self.lacks[a]
            if plane.size:
                expected = plane.expect(self.values[a], k)
            elif twin is not None:
                expected = Expected(float(self.values[a][twin][k]))
            else:
                expected = Expected(float((low + high) // 2))
            low, high = low >> lacks, high >> lacks
            likely = (expected.value - float(middle(0, lacks))) / float(1 << lacks)
            likely = clamp(likely, float(low), float(high))
            r = math.floor(likely + 0.5)
            rest = likely - r
            sign = 2 if rest < -0.171875 else 0 if rest > 0.171875 else 1
            size = self._size(a, k, w, plane, expected)
            before = size if before is None else before
            context = clamp(l1(single((0.75 * size + 0.25 * before) + 0.25)) + 4, 0, 23)
            model = self.models[a][1][k][context]
            residual = streams.integer(model, sign, f"wedge {w} attribute {a} number {k}")
            number = r + residual
            if not low <= number <= high:
                raise Refusal("bad-chunk")
            before = float(abs(residual))
            self.sizes[a, w, k] = before
            numbers.append(middle(number << lacks, lacks))
        return tuple(numbers)

    def _size(self, a, k, w, plane, expected):
        n = plane.size
        step = float(1 << self.lacks[a])
        if n == 0:
            return float(1 << self.attributes[a].bits) / step
        total = count = 0.0
        for x in self.order.around(w):
            size = self.sizes.get((a, x, k))
            if size is not None:
                total, count = total + size, count + 1.0
        steep = math.sqrt(expected.slope_squared * plane.reach_squared()) / step
        error = math.sqrt(expected.error_squared) / step
        size = 0.2 * steep
        if count > 0:
            seen = total / count
            size = (2.0 * seen + error) / 3.0 if n > 3 else seen
        elif n > 3:
            size = error
        if n < 3:
            size = max(size, 0.1 * steep + 0.5)
        return max(size, 4.0) if n == 1 else size


def sign_of(x):
    return -1 if x < 0 else 1


def unfold(point, axis, sign, half):
    u, v = point[(axis + 1) % 3], point[(axis + 2) % 3]
    return (u, v) if sign * point[axis] >= 0 else _fold_over(u, v, half)


def _fold_over(u, v, half):
    return sign_of(u) * (half - abs(v)), sign_of(v) * (half - abs(u))


def fold(u, v, axis, sign, half):
    rest = half - abs(u) - abs(v)
    if rest < 0:
        u, v = _fold_over(u, v, half)
    point = [0, 0, 0]
    point[(axis + 1) % 3], point[(axis + 2) % 3], point[axis] = u, v, sign * rest
    return tuple(point)


def octahedron_point(d, half):
    total = (abs(d[0]) + abs(d[1])) + abs(d[2])
    if not total > 0:
        return 0, 0, half
    scale = half / total
    x, y = math.floor(d[0] * scale + 0.5), math.floor(d[1] * scale + 0.5)
    rest = half - abs(x) - abs(y)
    if rest < 0:
        x, rest = x - sign_of(x), rest + 1
    return x, y, -rest if d[2] < 0 else rest


class Normals:
    """The normals of one attribute of the complete mesh."""

    def __init__(self, info, level, streams):
        self.half = (1 << (info.bits - 1)) - 1
        self.level = level
        self.order = Order(level, 0)
        self.left = len(level.vertices)
        self.values = [None] * self.left
        self.deviations = [None] * self.left
        self.sizes = [0.0] * self.left
        self.models = [residual_model(), residual_model()]
        self.weighting = streams.raw(2, "weighting")
        self.corrected = streams.raw(3, "corrected")

    def _derived(self, w):
        total = (0.0, 0.0, 0.0)
        for c in self.order.corners[w]:
            n, a, b = self.level.face_normal(c)
            squares = dot64(a, a) * dot64(b, b)
            divisor = (1.0, math.sqrt(dot64(n, n)), squares, math.sqrt(squares))[self.weighting]
            if divisor > 0:
                total = add64(total, tuple(x / divisor for x in n))
        return unit_or(total, (0.0, 0.0, 0.0))

    def _around(self, w):
        deviation, sizes, count = (0.0, 0.0, 0.0), 0.0, 0.0
        for x in self.order.around(w):
            if self.order.known[x]:
                deviation = add64(deviation, self.deviations[x])
                sizes, count = sizes + self.sizes[x], count + 1.0
        share = self.corrected / (8.0 * count) if count > 0 else 0.0
        return tuple(x * share for x in deviation), sizes / count if count > 0 else 2.0

    def decode(self, streams):
        w, half = self.order.take(), self.half
        derived = self._derived(w)
        deviation, size = self._around(w)
        expected = octahedron_point(add64(derived, deviation), half)
        axis = 1 if abs(expected[1]) > abs(expected[2]) else 2
        axis = 0 if abs(expected[0]) > abs(expected[axis]) else axis
        side = axis, sign_of(expected[axis])
        at = list(unfold(expected, *side, half))
        before, total = size, 0.0
        for k in range(2):
            context = clamp(l1(single((0.5 * size + 0.5 * before) + 0.125)) + 6, 0, 23)
            residual = streams.integer(self.models[k][context], 1, f"wedge {w} normal {k}")
            at[k] += residual
            if abs(at[k]) > half:
                raise Refusal("bad-chunk")
            before = float(abs(residual))
            total = total + before
        normal = fold(*at, *side, half)
        self.values[w] = tuple(x + half for x in unfold(normal, 2, 1, half))
        self.sizes[w] = single(0.5 * total)
        exact = tuple(map(float, normal))
        length = math.sqrt(dot64(exact, exact))
        self.deviations[w] = tuple(single(exact[k] / length - derived[k]) for k in range(3))
        self.order.know(w)
        self.left -= 1


class Attributes:
    """What lasts from chunk to chunk. counts: wedges and vertices of the whole stream."""

    def __init__(self, attributes, counts):
        self.attributes = attributes
        self.counts = counts
        self.level = self.level_number = None
        self.groups = []
        self.group_count = None
        self.values = [[] for _ in attributes]
        self.wedge_models = WedgeModels()
        self.models = [
            (AdaptiveBit(), [residual_model() for _ in range(0 if info.kind == NORMAL else info.numbers)])
            for info in attributes
        ]
        self.coding = self.normals = None
        self.next_normals = 0
        self.lacks = [None] * len(attributes)
        self.completed = 0

    def settled(self):
        return self.coding is None and self.normals is None and self.completed == 0

    def decode(self, streams, codec, number, last, mesh, replaced):
        """Decodes a chunk behind level `number`; whether attributes are complete then."""
        if codec == VALUES:
            self._values(streams, number, mesh, replaced)
        else:
            if not last or self.coding is not None or self.level_number != number:
                raise Refusal("bad-chunk")
            self._normals(streams) if codec == NORMALS else self._late_bits(streams)
        streams.finish()
        return self.settled()

    @staticmethod
    def _count(streams, name):
        return streams.raw(streams.raw(5, f"{name}, digits"), name)

    def _values(self, streams, number, mesh, replaced):
        if self.coding is None:
            if self.level_number == number:
                raise Refusal("bad-chunk")
            self._begin(streams, number, mesh, replaced)
        n = self._count(streams, "values")
        if n > self.coding.left:
            raise Refusal("bad-chunk")
        for _ in range(n):
            self.coding.decode(streams)
        if self.coding.left == 0:
            self.coding = None

    def _begin(self, streams, number, mesh, replaced):
        if self.group_count is None:
            self.group_count = self._count(streams, "groups") + 1
            if self.group_count > MAX_GROUPS:
                raise Refusal("bad-chunk")
        before, self.level_number = self.level, number
        self.level = level = Level(mesh.triangles(), [tuple(p) for p in mesh.positions])
        level.replaced = replaced
        known = len(before.vertices) if before else 0
        wedges, vertices = self.counts
        most = wedges - (vertices - len(level.positions))
        WedgeDecoder(streams, self.wedge_models, level, before, self.values, most)
        if self.group_count > 1:
            kept = [] if replaced else self.groups
            self.groups = decode_groups(streams, self.wedge_models, level, kept, self.group_count)
        self._precision(streams)
        self.coding = Values(self.attributes, level, known, self.values, self.models, self.lacks)

    def _precision(self, streams):
        for a, info in enumerate(self.attributes):
            before = self.lacks[a]
            if info.kind != TEX_COORD:
                self.lacks[a] = 0
            elif before is None:
                self.lacks[a] = streams.raw(4, f"attribute {a} lacks")
                if self.lacks[a] >= info.bits:
                    raise Refusal("bad-chunk")
            elif before > 0:
                self.lacks[a] = now = streams.raw(4, f"attribute {a} lacks")
                if now > before:
                    raise Refusal("bad-chunk")
                self.values[a] = [
                    tuple(refine(streams, x, before, now, f"wedge {w} more bits") for x in value)
                    for w, value in enumerate(self.values[a])
                ]

    def _late_bits(self, streams):
        n = self._count(streams, "completed")
        count = len(self.level.vertices) if any(self.lacks) else 0
        if n > count - self.completed:
            raise Refusal("bad-chunk")
        for w in range(self.completed, self.completed + n):
            for a, lacks in enumerate(self.lacks):
                if lacks > 0:
                    self.values[a][w] = tuple(
                        refine(streams, x, lacks, 0, f"wedge {w} last bits")
                        for x in self.values[a][w]
                    )
        self.completed += n
        if self.completed == len(self.level.vertices):
            self.lacks = [0] * len(self.lacks)
            self.completed = 0

    def _normals(self, streams):
        n = self._count(streams, "normals")
        if self.normals is None:
            while (
                self.next_normals < len(self.attributes)
                and self.attributes[self.next_normals].kind != NORMAL
            ):
                self.next_normals += 1
            if self.next_normals == len(self.attributes):
                raise Refusal("bad-chunk")
            self.normals = Normals(self.attributes[self.next_normals], self.level, streams)
        if n > self.normals.left:
            raise Refusal("bad-chunk")
        for _ in range(n):
            self.normals.decode(streams)
        if self.normals.left == 0:
            self.values[self.next_normals] = self.normals.values
            self.normals = None
            self.next_normals += 1
