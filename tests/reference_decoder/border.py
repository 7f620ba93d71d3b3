"""The complete mesh grown face by face: "Growth chunks", "Border" of proto/STREAM_FORMAT.md."""

from dataclasses import dataclass

from arithmetic import digits
from bits import Refusal, adaptive_bits
from mesh import Corners

NEW, PREVIOUS, NEXT, TOUCH, BOUNDARY = range(5)
HISTORY = {NEW: 0, PREVIOUS: 1, NEXT: 2, TOUCH: 3, BOUNDARY: 3}
RATE = 4000


@dataclass
class Node:
    corner: int
    previous: int = -1
    next: int = -1
    closed: bool = False
    used: bool = True


class BorderModels:
    def __init__(self):
        self.previous_ends, self.previous_across = [0] * 256, [0] * 256
        self.next_ends, self.next_across = [0] * 256, [0] * 256
        self.previous_history, self.next_history = [0] * 4096, [0] * 4096
        self.rare, self.touch = adaptive_bits(4), adaptive_bits(4)
        self.near = adaptive_bits(1)[0]


class Border:
    """The grown mesh and the loops of edges with a face on one side only."""

    def __init__(self, vertices, faces):
        self.mesh = Corners()
        self.models = BorderModels()
        self.most = vertices
        self.most_nodes = faces // 8 + 1024
        self.grown_faces = []                                        # by vertex
        self.components = []                                         # their first corners
        self.nodes = []
        self.freed = []
        self.node_of = {}                                            # by corner
        self.open = []
        self.history = 0
        self.streams = None

    def grow(self, streams):
        """Grows one face, or closes an edge, or drops a corner of Open."""
        self.streams = streams
        if not self.open:
            self._component()
            return
        c = self.open.pop()
        g = self.node_of.get(c)
        if g is not None and not self.nodes[g].closed:
            self._step(c, g)

    # ---- Nodes

    def _new_node(self, corner):
        if len(self.node_of) >= self.most_nodes:
            raise Refusal("bad-chunk")
        if self.freed:
            g = self.freed.pop()
            self.nodes[g] = Node(corner)
        else:
            g = len(self.nodes)
            self.nodes.append(Node(corner))
        self.node_of[corner] = g
        return g

    def _free(self, g):
        self.nodes[g].used = False
        self.node_of.pop(self.nodes[g].corner, None)
        self.freed.append(g)

    def _rename(self, g, corner):
        self.node_of.pop(self.nodes[g].corner, None)
        self.nodes[g].corner = corner
        self.node_of[corner] = g

    def _link(self, a, b):
        self.nodes[a].next = b
        self.nodes[b].previous = a

    # ---- Faces

    def _new_vertex(self):
        if len(self.grown_faces) >= self.most:
            raise Refusal("bad-chunk")
        self.grown_faces.append(0)
        return len(self.grown_faces) - 1

    def _new_face(self, a, b, c):
        for v in (a, b, c):
            self.grown_faces[v] += 1
        return self.mesh.append_face(a, b, c)

    def _component(self):
        vertices = [self._new_vertex() for _ in range(3)]
        corner = self._new_face(*vertices)
        self.components.append(corner)
        nodes = [self._new_node(corner + k) for k in range(3)]
        for k in range(3):
            self._link(nodes[k], nodes[(k + 1) % 3])
        self.open += [corner + 2, corner + 1, corner]

    def _step(self, c, g):
        node = self.nodes[g]
        p, q = node.previous, node.next
        u, v = self.mesh.edge(c)
        w, x = self.mesh.edge(self.nodes[p].corner)[0], self.mesh.edge(self.nodes[q].corner)[1]
        step = self._which(p, q, (u, v, w, x))
        if step == BOUNDARY:
            node.closed = True
            return
        k = -1
        if step == NEW:
            tip = self._new_vertex()
        elif step == PREVIOUS:
            self._require(not self.nodes[p].closed and w != v and p != q)
            tip = w
        elif step == NEXT:
            self._require(not self.nodes[q].closed and x != u and p != q)
            tip = x
        else:
            k = self._place(g)
            tip = self.mesh.edge(self.nodes[k].corner)[0]
            self._require(tip not in (u, v))
        corner = self._new_face(tip, v, u)
        self.mesh.join(corner, c)
        join = {NEW: self._join_new, PREVIOUS: self._join_previous, NEXT: self._join_next}
        join.get(step, self._join_touch)(corner, g, p, q, k)
        self.open += [corner + 2, corner + 1]

    def _require(self, condition):
        if not condition:
            raise Refusal("bad-chunk")

    def _join_new(self, corner, g, p, q, k):
        self._rename(g, corner + 1)
        n = self._new_node(corner + 2)
        self._link(g, n)
        self._link(n, q)

    def _join_previous(self, corner, g, p, q, k):
        before = self.nodes[p].previous
        self.mesh.join(corner + 1, self.nodes[p].corner)
        self._free(p)
        if q == before and not self.nodes[q].closed:
            self.mesh.join(corner + 2, self.nodes[q].corner)
            self._free(q)
            self._free(g)
            return
        self._rename(g, corner + 2)
        self._link(before, g)

    def _join_next(self, corner, g, p, q, k):
        after = self.nodes[q].next
        self.mesh.join(corner + 2, self.nodes[q].corner)
        self._free(q)
        self._rename(g, corner + 1)
        self._link(g, after)

    def _join_touch(self, corner, g, p, q, k):
        before = self.nodes[k].previous
        self._rename(g, corner + 1)
        self._link(g, k)
        n = self._new_node(corner + 2)
        self._link(before, n)
        self._link(n, q)

    # ---- What is coded

    def _which(self, p, q, ends):
        step = self._coded(p, q, *ends)
        self.history = (4 * self.history + HISTORY[step]) % 256
        return step

    def _coded(self, p, q, u, v, w, x):
        streams, models = self.streams, self.models
        p_closed, q_closed = self.nodes[p].closed, self.nodes[q].closed
        i = {vertex: min(15, self.grown_faces[vertex]) for vertex in (u, v, w, x)}
        h = 16 * self.history
        if not p_closed and streams.logistic(RATE, [
            (models.previous_ends, 16 * i[u] + i[w]),
            (models.previous_across, 16 * i[u] + i[v]),
            (models.previous_history, h + i[u]),
        ], "previous"):
            return PREVIOUS
        if not q_closed and streams.logistic(RATE, [
            (models.next_ends, 16 * i[v] + i[x]),
            (models.next_across, 16 * i[v] + i[u]),
            (models.next_history, h + i[v]),
        ], "next"):
            return NEXT
        m = (2 if p_closed else 0) + (1 if q_closed else 0)
        if not streams.adaptive(models.rare[m], "rare"):
            return NEW
        return TOUCH if streams.adaptive(models.touch[m], "touch") else BOUNDARY

    def _place(self, g):
        if self.streams.adaptive(self.models.near, "near"):
            d = self.streams.raw(6, "steps")
            for _ in range(d // 2 + 1):
                g = self.nodes[g].previous if d % 2 else self.nodes[g].next
            return g
        k = self.streams.raw(digits(len(self.nodes) - 1), "node")
        self._require(k < len(self.nodes) and self.nodes[k].used)
        return k
