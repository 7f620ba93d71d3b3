"""Base chunks of codec 1, proto/STREAM_FORMAT.md, "Base chunk"."""
from stream_arithmetic import clamp
from stream_models import BitStreams, Refusal

OPEN, BOUNDARY = -1, -2


class Coordinate:
    """The integer model of one axis."""

    def __init__(self, extent):
        x = extent.bit_length() - 2
        self.nonzero = [60000, 8]
        self.sign = [[20000, 8], [32768, 8], [45536, 8]]
        self.prefix = [
            [48000 if e < x - 1 else 32768 if e < x + 1 else 8000, 8] for e in range(24)]
        self.mantissa = [[[32768, 24] for _ in range(3)] for _ in range(24)]


def next_edge(h):
    return h - 2 if h % 3 == 2 else h + 1


def previous_edge(h):
    return h + 2 if h % 3 == 0 else h - 1


def require(holds):
    if not holds:
        raise Refusal("bad-chunk", "base")


class SmallBase:
    """Decodes a base mesh: positions and triangles."""

    def __init__(self, contents, vertices, faces, extent, trace):
        require(vertices <= 4096 and faces <= 3 * vertices)
        self.bits, self.vertices, self.extent = BitStreams(contents, trace), vertices, extent
        self.models = [Coordinate(size) for size in extent]
        self.new = [[32768, 4] for _ in range(4)]
        self.first = [[p, 4] for p in (32768, 58000, 40000, 40000)]
        self.last, self.boundary = [16384, 4], [2048, 4]
        self.positions, self.triangles, self.twin, self.edges, gates = [], [], [], {}, []
        self.gates = gates
        while len(self.triangles) < faces:
            if not gates:
                self.component()
            else:
                gate = gates.pop()
                if self.twin[gate] == OPEN:
                    self.cross(gate)
        require(len(self.positions) == vertices)
        self.bits.finish()

    def start(self, h):
        return self.triangles[h // 3][h % 3]

    def end(self, h):
        return self.start(next_edge(h))

    def component(self):
        require(self.vertices - len(self.positions) >= 3)
        expected, corners = [size // 2 for size in self.extent], []
        for _ in range(3):
            corners.append(self.vertex(expected))
            expected = self.positions[-1]
        self.triangle(*corners)

    def cross(self, gate):
        a, b = self.start(gate), self.end(gate)
        list_ = self.candidates(gate)
        context = min(len(list_), 3)
        more = len(self.positions) < self.vertices
        if more and self.bits.adaptive(self.new[context], f"edge {a}-{b} new vertex"):
            c = self.start(previous_edge(gate))
            expected = [
                clamp(3 * (x + y) - 2 * z >> 2, 0, size) for x, y, z, size in zip(
                    self.positions[a], self.positions[b], self.positions[c], self.extent)]
            self.triangle(b, a, self.vertex(expected))
        elif self.bits.adaptive(self.boundary, f"edge {a}-{b} boundary"):
            self.twin[gate] = BOUNDARY
        else:
            known = self.known(list_, context)
            require(known < len(self.positions) and known not in (a, b))
            self.triangle(b, a, known)

    def candidates(self, gate):
        found, h = [], gate
        while True:
            h = next_edge(h)
            while self.twin[h] >= 0:
                h = next_edge(self.twin[h])
            if self.twin[h] == BOUNDARY:
                break
            if h == gate or self.end(h) == self.start(gate):
                return found
            found.append(self.end(h))
        h = gate
        while True:
            h = previous_edge(h)
            while self.twin[h] >= 0:
                h = previous_edge(self.twin[h])
            if self.twin[h] == BOUNDARY or self.start(h) == self.end(gate):
                return found
            found.append(self.start(h))

    def known(self, list_, context):
        if list_ and self.bits.adaptive(self.first[context], "first of the border"):
            return list_[0]
        if len(list_) > 1 and self.bits.adaptive(self.last, "last of the border"):
            return list_[-1]
        if len(list_) > 2:
            between = len(list_) - 2
            index = self.bits.raw(between.bit_length(), "place on the border")
            if index < between:
                return list_[index + 1]
        return self.bits.raw((len(self.positions) - 1).bit_length(), "vertex")

    def vertex(self, expected):
        position = []
        for axis, model, x, size in zip("xyz", self.models, expected, self.extent):
            context = 0 if 3 * x < size else 2 if 3 * x > 2 * size else 1
            name = f"vertex {len(self.positions)} {axis}"
            position.append(x + self.bits.integer(model, context, name))
        self.positions.append(tuple(position))
        return len(self.positions) - 1

    def triangle(self, *corners):
        begin = 3 * len(self.triangles)
        self.triangles.append(corners)
        for h in range(begin, begin + 3):
            edge = self.start(h), self.end(h)
            require(edge not in self.edges)
            self.edges[edge] = h
            other = self.edges.get((edge[1], edge[0]), OPEN)
            self.twin.append(other)
            if other != OPEN:
                require(self.twin[other] == OPEN)
                self.twin[other] = h
        self.gates += range(begin, begin + 3)
