"""The base chunk of proto/STREAM_FORMAT.md ("Base chunk"): positions and triangles."""

import os
import shutil
import subprocess
import tempfile

from arithmetic import AXES, clamp, digits
from bits import AdaptiveBit, IntegerModel, Refusal

class Missing(Exception):
    """A program that is not installed."""


OPEN, BOUNDARY = -1, -2
MAX_VERTICES, MAX_FACES = 4096, 3


def _read_ply(data):
    """Points and faces of the binary files that draco_decoder writes."""
    head, body = data.split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in head.split(b"\n") if line.startswith(b"element")]
    properties = [line for line in head.split(b"\n") if line.startswith(b"property")]
    if properties[:3] != [b"property int " + axis for axis in (b"x", b"y", b"z")]:
        raise Refusal("bad-chunk")
    numbers = memoryview(body[:12 * counts[0]]).cast("i")
    positions = [list(numbers[i:i + 3]) for i in range(0, 3 * counts[0], 3)]
    faces = body[12 * counts[0]:]
    triangles = [
        tuple(memoryview(faces[i + 1:i + 13]).cast("i")) for i in range(0, 13 * counts[1], 13)
    ]
    return positions, triangles


def decode_draco(contents):
    """Positions and triangles of a Draco mesh in Draco's order, by Draco's own program."""
    program = shutil.which("draco_decoder")
    if program is None:
        raise Missing("draco_decoder is not installed")
    with tempfile.TemporaryDirectory() as folder:
        source, target = os.path.join(folder, "base.drc"), os.path.join(folder, "base.ply")
        with open(source, "wb") as file:
            file.write(contents)
        done = subprocess.run([program, "-i", source, "-o", target], capture_output=True)
        if done.returncode != 0 or not os.path.exists(target):
            raise Refusal("bad-chunk")
        with open(target, "rb") as file:
            return _read_ply(file.read())


def _coordinate_model(extent):
    x = digits(extent) - 2

    def make(name, i):
        if name == "nonzero":
            return AdaptiveBit(60000, 8)
        if name == "sign":
            return AdaptiveBit((20000, 32768, 45536)[i], 8)
        if name == "prefix":
            return AdaptiveBit(48000 if i < x - 1 else 32768 if i <= x else 8000, 8)
        return AdaptiveBit(32768, 24)

    return IntegerModel(make)


class SmallBase:
    """Codec 1. Half-edge 3 f + k leads from vertex k of triangle f to the next one."""

    def __init__(self, streams, vertices, faces, extent, parts=False):
        require(vertices <= MAX_VERTICES and faces <= MAX_FACES * vertices)
        self.streams = streams
        self.most = vertices
        self.extent = extent
        self.parts = parts
        self.positions = []
        self.begin = []                                              # by half-edge
        self.twin = []
        self.edges = {}
        self.gates = []
        self.new = [AdaptiveBit(32768, 4) for _ in range(4)]
        self.first = [AdaptiveBit(p, 4) for p in (32768, 58000, 40000, 40000)]
        self.last = AdaptiveBit(16384, 4)
        self.boundary = AdaptiveBit(2048, 4)
        self.coordinate = [_coordinate_model(e) for e in extent]
        while len(self.begin) < 3 * faces:
            streams.refuse_exhausted()
            self._grow()
        require(len(self.positions) == vertices)
        streams.finish()

    def triangles(self):
        return [tuple(self.begin[h:h + 3]) for h in range(0, len(self.begin), 3)]

    def _grow(self):
        if self.gates:
            h = self.gates.pop()
            if self.twin[h] == OPEN:
                self._cross(h)
            return
        require(self.most - len(self.positions) >= 3)
        if self.parts and self.positions:
            p = self._vertex(self.positions[-1])
        else:
            p = self._vertex([e // 2 for e in self.extent])
        q = self._vertex(self.positions[p])
        self._triangle(p, q, self._vertex(self.positions[q]))

    def _vertex(self, expected):
        number = len(self.positions)
        position = []
        for x, extent, model, axis in zip(expected, self.extent, self.coordinate, AXES):
            context = 0 if 3 * x < extent else 2 if 3 * x > 2 * extent else 1
            position.append(x + self.streams.integer(model, context, f"vertex {number} {axis}"))
        self.positions.append(position)
        return number

    def _triangle(self, *corners):
        for k in range(3):
            edge = corners[k], corners[(k + 1) % 3]
            require(edge not in self.edges)
            h = len(self.begin)
            twin = self.edges.get(edge[::-1], OPEN)
            self.edges[edge] = h
            self.begin.append(corners[k])
            self.twin.append(twin)
            if twin != OPEN:
                require(self.twin[twin] == OPEN)
                self.twin[twin] = h
            self.gates.append(h)

    def _cross(self, h):
        a, b, c = self.begin[h], self.begin[next_edge(h)], self.begin[previous_edge(h)]
        border = self._border(h)
        n = min(len(border), 3)
        name = f"edge {a}-{b}"
        new = len(self.positions) < self.most
        if new and self.streams.adaptive(self.new[n], f"{name} new vertex"):
            corners = zip(self.positions[a], self.positions[b], self.positions[c], self.extent)
            expected = [clamp((3 * (i + j) - 2 * k) >> 2, 0, e) for i, j, k, e in corners]
            self._triangle(b, a, self._vertex(expected))
        elif self.streams.adaptive(self.boundary, f"{name} boundary"):
            self.twin[h] = BOUNDARY
        else:
            k = self._known(border, n)
            require(k < len(self.positions) and k not in (a, b))
            self._triangle(b, a, k)

    def _known(self, border, n):
        streams = self.streams
        if border and streams.adaptive(self.first[n], "first of the border"):
            return border[0]
        if len(border) >= 2 and streams.adaptive(self.last, "last of the border"):
            return border[-1]
        m = len(border) - 2
        if m > 0:
            i = streams.raw(digits(m), "of the border")
            if i < m:
                return border[i + 1]
        return streams.raw(digits(len(self.positions) - 1), "vertex")

    def _border(self, h):
        """Vertices along the region's border, onwards from edge h, then backwards."""
        a, b = self.begin[h], self.begin[next_edge(h)]
        border = []
        g = h
        while True:
            g = self._turn(g, next_edge)
            to = self.begin[next_edge(g)]
            if self.twin[g] == BOUNDARY:
                break
            if g == h or to == a:
                return border
            border.append(to)
        g = h
        while True:
            g = self._turn(g, previous_edge)
            if self.twin[g] == BOUNDARY or self.begin[g] == b:
                return border
            border.append(self.begin[g])

    def _turn(self, g, step):
        g = step(g)
        while self.twin[g] >= 0:
            g = step(self.twin[g])
        return g


def next_edge(h):
    return h - 2 if h % 3 == 2 else h + 1


def previous_edge(h):
    return h + 2 if h % 3 == 0 else h - 1


def require(condition):
    if not condition:
        raise Refusal("bad-chunk")
