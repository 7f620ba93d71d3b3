"""The last level grown over the coarse mesh: "Growth chunks" of proto/STREAM_FORMAT.md."""

from arithmetic import (
    AXES, add, axes_of, clamp, cross, digits, divide, dot, l0, l1, scale, single, squared_distance,
    subtract,
)
from batches import coordinate
from bits import IntegerModel, Refusal, adaptive_bits
from border import Border
from mesh import face_of, next_corner, prev_corner

ZERO = (0.0, 0.0, 0.0)
RATE = 6000


def integer_models(*sizes):
    if not sizes:
        return IntegerModel()
    return [integer_models(*sizes[1:]) for _ in range(sizes[0])]


class PlacingModels:
    def __init__(self):
        self.coarse_nearest, self.coarse_residual = [0] * 32, [0] * 512
        self.coarse_second = [0] * 1024
        self.candidate, self.moved, self.below = adaptive_bits(8), adaptive_bits(8), adaptive_bits(2)
        self.low = [adaptive_bits(16) for _ in range(4)]
        self.beyond = integer_models(8)
        self.choice = [[[adaptive_bits(4) for _ in range(16)] for _ in range(4)] for _ in range(3)]
        self.first, self.second = integer_models(4, 16), integer_models(4, 16)
        self.last = integer_models(4, 16)


class Sight:
    """What is known around a vertex that is to be placed: vertices seen and guesses."""

    def __init__(self, growth, corner):
        mesh = growth.grown.mesh
        self.seen = []
        self.guesses = []
        corners = []                                        # for every face its corner if it gave a guess
        for c in mesh.around(corner):
            corners.append(None)
            a, b = mesh.edge(c)
            pa, pb = growth.position(a), growth.position(b)
            if pa:
                self.seen.append(a)
            if pb and mesh.opposite[next_corner(c)] < 0:
                self.seen.append(b)
            across = mesh.opposite[c]
            if pa and pb and across >= 0 and len(self.guesses) < 4:
                beyond = growth.position(mesh.vertex[across])
                if beyond:
                    self.guesses.append(subtract(add(pa, pb), beyond))
                    corners[-1] = c
        if self.seen:
            self._expect([growth.position(v) for v in self.seen])
            self._bend(growth, corners)
            self.t, self.n = (
                sum(growth.sizes[growth.number[v]][i] for v in self.seen) // len(self.seen)
                for i in range(2)
            )

    def _expect(self, positions):
        of = self.guesses or positions
        total = ZERO
        for position in of:
            total = add(total, position)
        self.expected = scale(total, divide(1.0, float(len(of))))

    def _bend(self, growth, corners):
        if growth.curved_share == 0 or len(self.guesses) < 2:
            return
        guess = iter(self.guesses)
        gave = [(c, next(guess)) if c is not None else None for c in corners]
        for first, second in zip(gave, gave[1:] + gave[:1]):
            curved = first and second and self._curved(growth, *first, *second)
            if curved:
                share = single(growth.curved_share * 0.125)
                self.expected = add(self.expected, scale(subtract(curved, self.expected), share))
                return

    @staticmethod
    def _curved(growth, c, g, d, h):
        mesh = growth.grown.mesh
        m = mesh.vertex[prev_corner(c)]
        if mesh.vertex[next_corner(d)] != m or growth.grown.grown_faces[m] != 6:
            return None
        o = mesh.opposite[prev_corner(mesh.opposite[c])]
        across = growth.position(mesh.vertex[o]) if o >= 0 else None
        if not across:
            return None
        middle = growth.position(m)
        return subtract(subtract(add(add(g, h), across), middle), middle)


class Growth:
    """Decodes the growth chunks; afterwards positions and triangles are those of the level.

    Numbers of vertices are those of the complete mesh, except where "grown" is said."""

    def __init__(self, coarse, shift, bits, size):
        self.coarse = coarse
        self.shift = shift
        self.most = (1 << bits) - 1
        self.vertices, self.faces = size
        self.grown = Border(*size)
        self.models = PlacingModels()
        self.positions = [None] * len(coarse.positions)
        self.half = ((1 << shift) - 1) * 0.5
        self.sizes = [(0, 0)] * len(coarse.positions)
        self.hints = [0] * len(coarse.positions)
        self.last_face = {v: face_of(c) for c, v in enumerate(coarse.vertex) if v >= 0}
        self.number = {}                                             # by grown vertex
        self.known = {}                                              # by grown vertex
        self.likely, self.possible = [], []
        self.surface_share = self.curved_share = 0
        self.streams = None

    def decode(self, streams, row):
        self.streams = streams
        if row.starts_level:
            self.surface_share = streams.raw(3, "surface share")
            self.curved_share = streams.raw(4, "curved share")
            require(self.curved_share <= 8)
        more, n = self._count("faces"), self._count("vertices")
        mesh = self.grown.mesh
        target = mesh.faces() + more
        require(target <= self.faces)
        while mesh.faces() < target:
            streams.refuse_exhausted()
            self.grown.grow(streams)
        complete = target == self.faces
        require(not complete or len(self.grown.grown_faces) == self.vertices)
        require(complete or n == 0)
        for _ in range(n):
            streams.refuse_exhausted()
            self._place_next()
        streams.finish()
        done = complete and len(self.number) == self.vertices
        require(row.ends_level == (done and all(self.positions)))

    def _count(self, name):
        return self.streams.raw(self.streams.raw(5, f"{name}, digits"), name)

    def triangles(self):
        vertex = self.grown.mesh.vertex
        return [
            tuple(self.number[v] for v in vertex[i:i + 3]) for i in range(0, len(vertex), 4)
        ]

    # ---- Order of placing

    def position(self, v):
        """Position of a grown vertex, None until it is placed."""
        number = self.number.get(v)
        return None if number is None else tuple(map(float, self.positions[number]))

    def _pop(self, stack):
        vertex = self.grown.mesh.vertex
        while stack:
            c = stack.pop()
            if vertex[c] not in self.number:
                return c
        return None

    def _next_corner(self):
        c = self._pop(self.likely)
        if c is None:
            c = self._pop(self.possible)
        if c is not None:
            return c
        vertex = self.grown.mesh.vertex
        for first in self.grown.components:
            for c in range(first, first + 3):
                if vertex[c] not in self.number:
                    return c
        raise Refusal("bad-chunk")

    def _push(self, stack, c):
        vertex = self.grown.mesh.vertex
        limit = self.vertices // 4 + 4096
        if len(stack) >= limit:
            stack[:] = [corner for corner in stack if vertex[corner] not in self.number]
            require(len(stack) <= limit // 2)
        stack.append(c)

    def _place_next(self):
        corner = self._next_corner()
        mesh = self.grown.mesh
        self.number[mesh.vertex[corner]] = self._place(corner)
        for c in mesh.around(corner):
            unplaced = [
                d for d in (next_corner(c), prev_corner(c)) if mesh.vertex[d] not in self.number
            ]
            if len(unplaced) != 1:
                continue
            v = mesh.vertex[unplaced[0]]
            if self.known.get(v, 0) < 2:
                self.known[v] = self.known.get(v, 0) + 1
                self._push(self.likely if self.known[v] == 2 else self.possible, unplaced[0])

    # ---- The coarse mesh

    def coarse_place(self, v):
        """Where a coarse vertex is: its position when it was met, before the centre of its cell."""
        if self.positions[v]:
            return tuple(map(float, self.positions[v]))
        return tuple(single((x << self.shift) + self.half) for x in self.coarse.positions[v])

    def corner_places(self, face):
        return [self.coarse_place(v) for v in self.coarse.vertex[4 * face:4 * face + 3]]

    def area(self, face):
        a0, a1, a2 = self.corner_places(face)
        return cross(subtract(a1, a0), subtract(a2, a0))

    def walk(self, face, p):
        for _ in range(12):
            leave = self._way_out(face, p)
            if leave is None or self.coarse.opposite[4 * face + leave] < 0:
                return face
            face = face_of(self.coarse.opposite[4 * face + leave])
        return face

    def _way_out(self, face, p):
        places, area = self.corner_places(face), self.area(face)
        leave, most = None, 0.0
        for k in range(3):
            begin = places[(k + 1) % 3]
            edge = subtract(places[(k + 2) % 3], begin)
            side = dot(cross(edge, subtract(p, begin)), area)
            if side < 0:
                distance = divide(single(side * side), single(dot(edge, edge) + 1))
                if distance > most:
                    leave, most = k, distance
        return leave

    def candidates(self, face, expected):
        """Pairs (squared distance, vertex), nearest first."""
        coarse = self.coarse
        across = [coarse.opposite[4 * face + k] for k in range(3)]
        near = coarse.vertex[4 * face:4 * face + 3] + [coarse.vertex[o] for o in across if o >= 0]
        unmet = [v for v in dict.fromkeys(near) if not self.positions[v]]
        pairs = [(squared_distance(self.coarse_place(v), expected), v) for v in unmet]
        return sorted(pairs, key=lambda pair: pair[0])

    # ---- One vertex

    def _place(self, corner):
        sight = Sight(self, corner)
        if not sight.seen:
            number = self._raw_coarse()
            self._complete(number, self.coarse_place(number))
            return number
        last_seen = self.number[sight.seen[-1]]
        hint = self.walk(self.hints[last_seen], sight.expected)
        candidates = self.candidates(hint, sight.expected)
        if self._is_coarse(candidates, sight, tuple(map(float, self.positions[last_seen]))):
            number = self._coarse(candidates)
            self._complete(number, sight.expected)
            self.sizes[number] = sight.t, sight.n
            return number
        require(len(self.positions) < self.vertices)
        position, sizes = self._residual(sight, hint)
        require(all(0 <= x <= self.most for x in position))
        self.positions.append(position)
        self.sizes.append(sizes)
        self.hints.append(hint)
        return len(self.positions) - 1

    def _raw_coarse(self):
        v = len(self.coarse.positions)
        number = self.streams.raw(digits(v - 1), "coarse vertex")
        require(number < v and not self.positions[number])
        return number

    def _is_coarse(self, candidates, sight, last_position):
        reach = single(squared_distance(last_position, sight.expected) + 1)
        d = [31, 31]
        for i, (distance, _) in enumerate(candidates[:2]):
            d[i] = clamp(l1(divide(single(distance + 0.25), reach)) + 22, 0, 30)
        models = self.models
        return self.streams.logistic(RATE, [
            (models.coarse_nearest, d[0]),
            (models.coarse_residual, 16 * d[0] + min(15, sight.t)),
            (models.coarse_second, 32 * d[0] + d[1]),
        ], "coarse")

    def _coarse(self, candidates):
        for (_, v), model in zip(candidates, self.models.candidate):
            if self.streams.adaptive(model, "candidate"):
                return v
        return self._raw_coarse()

    def _complete(self, number, expected):
        cell = self.coarse.positions[number]
        position = list(cell)
        if self.shift:
            position = [self._full(cell[axis], expected[axis], AXES[axis]) for axis in range(3)]
        require(all(0 <= x <= self.most for x in position))
        self.positions[number] = position
        self.hints[number] = self.last_face[number]

    def _full(self, index, e, name):
        streams, models, s = self.streams, self.models, self.shift
        low = index << s
        if streams.adaptive(models.moved[min(7, s)], f"{name} moved"):
            beyond = models.beyond[min(7, s)]
            if streams.adaptive(models.below[1 if e < low else 0], f"{name} below"):
                return low - 1 - streams.integer(beyond, 1, f"{name} beyond")
            return low + (1 << s) + streams.integer(beyond, 1, f"{name} beyond")
        x = low
        for bit in reversed(range(s)):
            half = 1 << bit
            middle = single(single(float(x + half)) - 0.5)
            o = single(single(e - middle) * divide(4.0, float(half)))
            context = int(single(clamp(o, -8.0, 7.0) + 8))
            x += half * streams.adaptive(models.low[min(3, bit)][context], f"{name} low")
        return x

    def _choose(self, sight):
        """Kind of the prediction and the expected position."""
        guesses, expected = sight.guesses, sight.expected
        if len(guesses) < 2:
            return len(guesses), expected
        spread = max(squared_distance(guess, expected) for guess in guesses)
        if spread < 0.5:
            return 2, expected
        size = clamp(l0(single(spread + 1)), 0, 15)
        model = self.models.choice[len(guesses) - 2][min(3, sight.t // 3)][size]
        if not self.streams.adaptive(model[0], "one guess"):
            return 2, expected
        i = 1
        while i < len(guesses) and not self.streams.adaptive(model[i], f"guess {i}"):
            i += 1
        return 3, guesses[i - 1]

    def _residual(self, sight, hint):
        streams, models = self.streams, self.models
        kind, expected = self._choose(sight)
        area = self.area(hint)
        first, second, last = axes_of(area)
        position = [0, 0, 0]
        t, n = sight.t, sight.n
        model = models.first[kind][min(15, t)]
        position[first] = coordinate(streams, model, expected[first], AXES[first])
        a = single(position[first] - expected[first])
        model = models.second[kind][min(15, (t + size_of(a) + 1) // 2)]
        position[second] = coordinate(streams, model, expected[second], AXES[second])
        b = single(position[second] - expected[second])
        y = expected[last]
        if area[last] != 0:
            height = dot(subtract(self.corner_places(hint)[0], expected), area)
            height = single(height * single(self.surface_share * 0.125))
            tilt = single(single(area[first] * a) + single(area[second] * b))
            y = single(y + divide(single(height - tilt), area[last]))
        off = single(abs(a) + abs(b))
        model = models.last[kind][min(15, (2 * n + size_of(single(0.5 * off)) + 1) // 3)]
        position[last] = coordinate(streams, model, y, AXES[last])
        t = (t + 2 * size_of(off) + 2) // 3
        n = (n + 2 * size_of(single(position[last] - y)) + 2) // 3
        return position, (t, n)


def size_of(r):
    """S of "Placing a vertex"."""
    return clamp(l1(single(abs(r) + 1)), 0, 30)


def require(condition):
    if not condition:
        raise Refusal("bad-chunk")
