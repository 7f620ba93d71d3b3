"""The mesh: "Corner table", "Base chunk" and "Applying splits" of proto/STREAM_FORMAT.md.

Corner 4 f + k is the k-th one of face f; -1 stands for no corner."""

from bits import Refusal

FREE, TAKEN, REFUSED = range(3)
MANY = 65535


def face_of(c):
    return c >> 2


def next_corner(c):
    return c - 2 if c & 3 == 2 else c + 1


def prev_corner(c):
    return c + 2 if c & 3 == 0 else c - 1


class Corners:
    """Vertices and opposites of corners."""

    def __init__(self):
        self.vertex = []
        self.opposite = []

    def faces(self):
        return len(self.vertex) // 4

    def append_face(self, a, b, c):
        """Appends a face without neighbours, gives its corner 0."""
        self.vertex += (a, b, c, -1)
        self.opposite += (-1, -1, -1, -1)
        return len(self.vertex) - 4

    def join(self, c, d):
        """Makes two corners opposite; d may be none."""
        self.opposite[c] = d
        if d >= 0:
            self.opposite[d] = c

    def edge(self, c):
        """The edge opposite to a corner: (from, to)."""
        return self.vertex[next_corner(c)], self.vertex[prev_corner(c)]

    def around(self, first):
        """Corners at the vertex of a corner: counter-clockwise, at a boundary then the other way."""
        corners = [first]
        c = self.opposite[next_corner(first)]
        while c >= 0 and next_corner(c) != first:
            corners.append(next_corner(c))
            c = self.opposite[next_corner(corners[-1])]
        if c < 0:
            c = self.opposite[prev_corner(first)]
            while c >= 0:
                corners.append(prev_corner(c))
                c = self.opposite[prev_corner(corners[-1])]
        return corners


class Mesh(Corners):
    """Faces in the array whose order the traversal follows, with positions on the grid of the shift."""

    def __init__(self, positions, triangles):
        super().__init__()
        self.positions = positions
        self.valence = [0] * len(positions)
        self.state = []
        self.slot = []
        self.logs = []
        self.new_faces = {}
        self.batch_faces = 0
        self._connect(triangles)

    def add_parts(self, positions, triangles):
        """Appends components ("Parts chunks")."""
        parts = Mesh(positions, triangles)
        vertices, corners, slots = len(self.positions), len(self.vertex), len(self.slot)
        self.positions += positions
        self.valence += parts.valence
        self.vertex += [v if v < 0 else v + vertices for v in parts.vertex]
        self.opposite += [o if o < 0 else o + corners for o in parts.opposite]
        self.state += parts.state
        self.slot += [slot + slots for slot in parts.slot]
        self.logs += parts.logs

    def _connect(self, triangles):
        edges = {}
        for triangle in triangles:
            if len(set(triangle)) < 3 or not all(0 <= v < len(self.positions) for v in triangle):
                raise Refusal("bad-chunk")
            first = self.append(triangle)
            for c in range(first, first + 3):
                if self.edge(c) in edges:
                    raise Refusal("bad-chunk")
                edges[self.edge(c)] = c
        for (a, b), c in edges.items():
            self.opposite[c] = edges.get((b, a), -1)
        for a, b in edges:
            self.valence[a] += 1
            self.valence[b] += (b, a) not in edges
        self.valence = [min(n, MANY) for n in self.valence]
        self._check_fans()

    def _check_fans(self):
        """Every vertex belongs to a face, and going round it meets all of its faces."""
        faces = [0] * len(self.positions)
        corner = [-1] * len(self.positions)
        for c, v in enumerate(self.vertex):
            if v >= 0:
                faces[v] += 1
                corner[v] = c
        if not all(faces):
            raise Refusal("bad-chunk")
        if any(len(self.around(c)) != faces[v] for v, c in enumerate(corner)):
            raise Refusal("bad-chunk")

    def append(self, triangle, logs=(0, 0, 0)):
        self.state.append(TAKEN)
        self.slot.append(len(self.state) - 1)
        self.logs += (*logs, 0)
        return self.append_face(*triangle)

    def triangles(self):
        """Triangles in the order of their slots."""
        by_slot = [None] * self.faces()
        for f, slot in enumerate(self.slot):
            by_slot[slot] = tuple(self.vertex[4 * f:4 * f + 3])
        return by_slot

    def check_coordinates(self, most):
        if not all(0 <= x <= most for position in self.positions for x in position):
            raise Refusal("bad-chunk")

    def apply(self, wedge, seed, right, left):
        """Splits the vertex at the wedge's corners; right, left: whether there are such faces."""
        first, last = wedge[0], wedge[-1]
        kept = self.vertex[first]
        removed = len(self.valence)
        right_vertex = self.vertex[next_corner(first)]
        left_vertex = self.vertex[prev_corner(last)]
        beyond_right = self.opposite[prev_corner(first)]
        beyond_left = self.opposite[next_corner(last)]
        for c in wedge:
            self.vertex[c] = removed
        if right:
            r = self.append((kept, right_vertex, removed), self._logs(first))
            self.join(r, prev_corner(first))
            self.join(r + 2, beyond_right)
        if left:
            face = self.append((kept, removed, left_vertex), self._logs(last))
            self.join(face, next_corner(last))
            self.join(face + 1, beyond_left)
            if right:
                self.join(r + 1, face + 2)
        self.valence.append(len(wedge) + 2)
        self.new_faces[seed] = int(right) + int(left)

    def _logs(self, c):
        f = face_of(c)
        return self.logs[4 * f:4 * f + 3]

    def begin_batch(self):
        self.batch_faces = self.faces()
        self.new_faces = {}

    def end_batch(self):
        """Puts new faces behind the seeds of their splits."""
        order = []
        new = self.batch_faces
        for f in range(self.batch_faces):
            order.append(f)
            for _ in range(self.new_faces.get(f, 0)):
                order.append(new)
                new += 1
        place = [0] * len(order)
        for i, f in enumerate(order):
            place[f] = i
        self.slot = [self.slot[f] for f in order]
        self.state = [self.state[f] for f in order]
        self.logs = [log for f in order for log in self.logs[4 * f:4 * f + 4]]
        self.vertex = [v for f in order for v in self.vertex[4 * f:4 * f + 4]]
        self.opposite = [
            o if o < 0 else 4 * place[o >> 2] + (o & 3)
            for f in order for o in self.opposite[4 * f:4 * f + 4]
        ]
