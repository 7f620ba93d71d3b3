"""Which corners of a level share a wedge: "Wedges" and "Groups" of proto/STREAM_FORMAT.md."""

import math

from bits import Refusal, adaptive_bits
from mesh import Corners, face_of, next_corner, prev_corner
from planes import cross64, difference, dot64

MOST_COMPARED = 64


class WedgeModels:
    def __init__(self):
        self.has_breaks = adaptive_bits(16)
        self.is_break = adaptive_bits(36)
        self.same = adaptive_bits(18)
        (self.follows,) = adaptive_bits(1)
        self.group = adaptive_bits(3)


class Level(Corners):
    """A level's triangles in the order of slots, and the wedges at their corners."""

    def __init__(self, triangles, positions):
        super().__init__()
        edges = {}
        for triangle in triangles:
            first = self.append_face(*triangle)
            for c in range(first, first + 3):
                edges[self.edge(c)] = c
        for (a, b), c in edges.items():
            self.opposite[c] = edges.get((b, a), -1)
        self.positions = positions
        self.wedges = [None] * len(self.vertex)
        self.vertices = []
        self.first = [-1] * len(positions)
        for c, v in enumerate(self.vertex):
            if v >= 0 and (self.first[v] < 0 or self.opposite[prev_corner(c)] < 0):
                self.first[v] = c

    def wedge(self, c):
        return self.wedges[c]

    def wedge_triangles(self):
        return [self.wedges[c:c + 3] for c in range(0, len(self.wedges), 4)]

    def position(self, c):
        return self.positions[self.vertex[c]]

    def face_normal(self, c):
        """Cross product at a corner, and the two edges."""
        p = difference(self.position(next_corner(c)), self.position(c))
        q = difference(self.position(prev_corner(c)), self.position(c))
        return cross64(p, q), p, q

    def joined(self, c):
        """Whether both ends of the edge opposite to a corner have the same wedges on both sides."""
        o = self.opposite[c]
        return (
            self.wedges[next_corner(o)] == self.wedges[prev_corner(c)]
            and self.wedges[prev_corner(o)] == self.wedges[next_corner(c)]
        )

    def beyond(self, c):
        return self.wedges[self.opposite[c]] if self.opposite[c] >= 0 and self.joined(c) else None

    def fan(self, v):
        """Corners of a vertex and whether they close."""
        corners = [self.first[v]]
        while True:
            o = self.opposite[next_corner(corners[-1])]
            if o < 0:
                return corners, False
            if next_corner(o) == corners[0]:
                return corners, True
            corners.append(next_corner(o))


class WedgeDecoder:
    """Decodes the wedges of a level into it; before: the last level that had attributes."""

    def __init__(self, streams, models, level, before, values, most):
        self.streams = streams
        self.models = models
        self.level = level
        self.values = values
        self.replaced = before is not None and level.replaced
        self.most = most
        self.seams = {}
        level.vertices = list(before.vertices) if before else []
        self.of_vertex = [[] for _ in level.positions]
        for w, v in enumerate(level.vertices):
            self.of_vertex[v].append(w)
        self.old_vertices = len(before.positions) if before else 0
        self.old_wedges = len(level.vertices)
        self._keep(before)
        if streams.raw(1, "seams"):
            self._with_seams()
        else:
            self._without_seams()

    def _keep(self, before):
        for c, v in enumerate(self.level.vertex):
            if not 0 <= v < self.old_vertices:
                continue
            if not self.replaced and c < len(before.wedges) and before.vertices[before.wedges[c]] == v:
                self.level.wedges[c] = before.wedges[c]
            elif len(self.of_vertex[v]) == 1:
                self.level.wedges[c] = self.of_vertex[v][0]

    def _new_wedge(self, v):
        if len(self.level.vertices) >= self.most:
            raise Refusal("bad-chunk")
        self.of_vertex[v].append(len(self.level.vertices))
        self.level.vertices.append(v)
        return self.of_vertex[v][-1]

    def _without_seams(self):
        for v in range(self.old_vertices, len(self.level.positions)):
            self._new_wedge(v)
        for c, v in enumerate(self.level.vertex):
            if v >= 0 and self.level.wedges[c] is None:
                self.level.wedges[c] = self.of_vertex[v][0]

    def _with_seams(self):
        for v in range(self.old_vertices):
            if len(self.of_vertex[v]) > 1:
                self._known_vertex(v)
        self._follow_seams()
        for v in range(self.old_vertices, len(self.level.positions)):
            self._new_vertex(v)
            self._follow_seams()

    def _follow_seams(self):
        while self.seams:
            self._new_vertex(self.seams.popitem()[0])

    def _go_on_at(self, c):
        v = self.level.vertex[prev_corner(c)]
        if v >= self.old_vertices and not self.of_vertex[v]:
            self.seams.pop(v, None)
            self.seams[v] = True

    def _far(self, c):
        x = self.level.wedges[prev_corner(c)]
        y = self.level.wedges[prev_corner(self.level.opposite[next_corner(c)])]
        return 2 if x is None or y is None else 0 if x == y else 1

    def _known_vertex(self, v):
        wedges = self.level.wedges
        fan, closed = self.level.fan(v)
        if closed:
            fan = self._turned(fan)
        for i, c in enumerate(fan):
            if wedges[c] is None:
                wedges[c] = self._first_of(v, c) if i == 0 else self._next_of(v, fan, i, closed)
        for i in range(len(fan) if closed else len(fan) - 1):
            if wedges[fan[i]] != wedges[fan[(i + 1) % len(fan)]]:
                self._go_on_at(fan[i])

    def _turned(self, fan):
        wedges = self.level.wedges
        start = next((i for i, c in enumerate(fan) if wedges[c] is not None), None)
        if start is None:
            start = next((i for i, c in enumerate(fan) if self._beside(c)), 0)
        return fan[start:] + fan[:start]

    def _beside(self, c):
        wedges = self.level.wedges[next_corner(c)], self.level.wedges[prev_corner(c)]
        return [wedge for wedge in wedges if wedge is not None]

    def _first_of(self, v, c):
        likely = self._likely(v, c)
        return self._choice(v, self.of_vertex[v][0] if likely is None else likely)

    def _next_of(self, v, fan, i, closed):
        wedges = self.level.wedges
        likely, before = self._likely(v, fan[i]), wedges[fan[i - 1]]
        last = i + 1 == len(fan)
        behind = None if last and not closed else wedges[fan[0 if last else i + 1]]
        kind = 0 if likely is None else 1 if likely == before else 2
        other = int(behind is not None and behind != before)
        context = 6 * self._far(fan[i - 1]) + 2 * kind + other
        if self.streams.adaptive(self.models.same[context], f"vertex {v} same wedge"):
            return before
        if kind < 2:
            own = self.of_vertex[v]
            likely = own[(own.index(before) + 1) % len(own)]
        return self._choice(v, likely)

    def _choice(self, v, likely):
        if self.streams.adaptive(self.models.follows, f"vertex {v} likely wedge"):
            return likely
        own = self.of_vertex[v]
        i = self.streams.raw((len(own) - 1).bit_length(), f"vertex {v} wedge")
        return own[min(i, len(own) - 1)]

    def _likely(self, v, c):
        beside = self._beside(c)
        if not beside:
            return None
        own = self.of_vertex[v][:MOST_COMPARED]
        return min(own, key=lambda w: sum(self._gap(w, x) for x in beside))

    def _gap(self, w, x):
        if max(w, x) >= self.old_wedges:
            return 0
        return sum(
            abs(a - b) for values in self.values if values for a, b in zip(values[w], values[x])
        )

    def _new_vertex(self, v):
        if self.of_vertex[v]:
            return
        fan, closed = self.level.fan(v)
        edges = len(fan) if closed else len(fan) - 1
        far = [self._far(fan[i]) for i in range(edges)]
        breaks = [0] * len(fan)
        context = 4 * min(far.count(1), 3) + min((far.count(2) + 1) // 2, 3)
        if edges > int(closed) and self.streams.adaptive(
            self.models.has_breaks[context], f"vertex {v} has seams"
        ):
            self._breaks(v, fan, closed, far, breaks)
        self._place(v, fan, closed, breaks)
        for i in range(edges):
            if breaks[i]:
                self._go_on_at(fan[i])

    def _breaks(self, v, fan, closed, far, breaks):
        least = 2 if closed else 1
        straight = self._straight(v, fan, far)
        for i, state in enumerate(far):
            count = sum(breaks[:i])
            if count + len(far) - i <= least:
                breaks[i] = 1
                continue
            context = 6 * state + 2 * min(count, 2) + int(i == straight) + 18 * self.replaced
            breaks[i] = self.streams.adaptive(self.models.is_break[context], f"vertex {v} seam {i}")

    def _straight(self, v, fan, far):
        if 1 not in far:
            return None
        positions = self.level.positions
        along = [
            difference(positions[self.level.vertex[prev_corner(fan[i])]], positions[v])
            for i in range(len(far))
        ]
        start = far.index(1)

        def cosine(i):
            square = dot64(along[i], along[i])
            return dot64(along[start], along[i]) / math.sqrt(square) if square > 0 else 0.0

        return min((i for i in range(len(far)) if i != start), key=cosine, default=None)

    def _place(self, v, fan, closed, breaks):
        start = breaks.index(1) + 1 if closed and 1 in breaks else 0
        wedge = None
        for n in range(len(fan)):
            i = (start + n) % len(fan)
            if n == 0 or breaks[i - 1]:
                wedge = self._new_wedge(v)
            self.level.wedges[fan[i]] = wedge


def decode_groups(streams, models, level, kept, count):
    """Groups of a level's triangles; kept: those of the first slots."""
    groups = list(kept) + [None] * (level.faces() - len(kept))
    last = 0
    digits = (count - 1).bit_length()
    for f in range(len(kept), len(groups)):
        likely = None
        for c in range(4 * f, 4 * f + 3):
            o = level.opposite[c]
            if o < 0 or groups[face_of(o)] is None:
                continue
            if level.joined(c):
                groups[f] = groups[face_of(o)]
                break
            likely = groups[face_of(o)] if likely is None else likely
        if groups[f] is not None:
            continue
        context = 0 if likely is None else 1 if likely == last else 2
        groups[f] = last if likely is None else likely
        if streams.adaptive(models.group[context], f"triangle {f} other group"):
            groups[f] = min(streams.raw(digits, f"triangle {f} group"), count - 1)
        last = groups[f]
    return groups
