"""The mesh and its splits, proto/STREAM_FORMAT.md, "Corner table" to "Applying splits"."""
import math

from stream_arithmetic import (
    K002, K006, K017, K03, add, clamp, cross, dot, f32, l1, l3, mul, sub)
from stream_models import PACKED, IntegerModel, Refusal, Weights, log_sum, squash, total

NONE = -1
TABLES = {
    "split_best_edge": 128, "split_second_edge": 32, "split_edge_valence": 192, "split_shape": 32,
    "split_valences": 256, "split_size": 32, "kept_valence": 16, "kept_longer_edge": 64,
    "kept_shorter_edge": 64, "kept_far_edge": 32, "kept_beyond": 256, "grow_start": 64,
    "grow_edge": 128, "grow_cut_valence": 32, "grow_kept_valence": 128, "grow_beyond": 40,
    "grow_length": 64, "grow_centre": 512, "boundary": 16,
}


def next_corner(c):
    return c - 2 if c % 4 == 2 else c + 1


def prev_corner(c):
    return c + 2 if c % 4 == 0 else c - 1


class Face:
    def __init__(self, vertices, slot, logs=None, state="Free"):
        self.v, self.o, self.e = list(vertices), [NONE] * 3, logs
        self.slot, self.state, self.added = slot, state, 0


class Mesh:
    """Corner table, positions, valences."""

    def __init__(self, positions, triangles, bits, shift):
        self.positions, self.bits, self.shift = positions, bits, shift
        self.faces = [Face(triangle, slot) for slot, triangle in enumerate(triangles)]
        edges = {}
        for c in (4 * f + k for f in range(len(triangles)) for k in range(3)):
            edges[self.V(next_corner(c)), self.V(prev_corner(c))] = c
        for (a, b), c in edges.items():
            self.faces[c >> 2].o[c & 3] = edges.get((b, a), NONE)
        neighbours = [set() for _ in positions]
        for a, b in edges:
            neighbours[a].add(b)
            neighbours[b].add(a)
        self.valence = [min(65535, len(n)) for n in neighbours]

    def V(self, c):
        return self.faces[c >> 2].v[c & 3]

    def O(self, c):  # noqa: E743
        return self.faces[c >> 2].o[c & 3]

    def free(self, c):
        return c != NONE and self.faces[c >> 2].state == "Free"

    def link(self, a, b):
        for c, other in ((a, b), (b, a)):
            if c != NONE:
                self.faces[c >> 2].o[c & 3] = other

    def triangles(self):
        return [tuple(face.v) for face in sorted(self.faces, key=lambda face: face.slot)]

    def e(self, c):
        return self.faces[c >> 2].e[c & 3]

    def R(self, c):
        return 6 * self.e(c) - sum(self.faces[c >> 2].e) - sum(self.faces[self.O(c) >> 2].e)


def bucket(r):
    return clamp((r + 52) * 13 >> 6, 0, 27)


class Split:
    def __init__(self, seed, corner):
        self.seed, self.first, self.last, self.length = seed, corner, corner, 1
        self.kind = "interior"


class Splits:
    """Decodes and applies splits; holds all state that lasts."""

    def __init__(self, mesh):
        self.mesh, self.batch, self.cursor = mesh, 0, 0
        packed = iter(PACKED)
        self.t = {name: Weights(entries, packed) for name, entries in TABLES.items()}
        self.tangential = [[IntegerModel(packed) for _ in range(32)] for _ in range(2)]
        self.along_normal = [IntegerModel(packed) for _ in range(48)]
        self.further = [[[8192, 8] for _ in range(16)] for _ in range(3)]
        self.weights = [26, 6, 3, 11, 16]

    def chosen(self, **indices):
        return [(self.t[name], index) for name, index in indices.items()]

    def start_level(self, bits, shift):
        mesh = self.mesh
        d, mesh.shift = mesh.shift - shift, shift
        self.d, self.refined = d, 0
        if d > 0:
            self.moving = bits.raw(1, "moving")
            mesh.positions = [
                tuple((x << d) + (1 << (d - 1)) for x in position) for position in mesh.positions]

    def refine(self, bits):
        """Brings precision to as many vertices as a chunk holds; says whether some are left."""
        mesh, d = self.mesh, self.d
        if d == 0:
            return False
        end = min(self.refined + 2**18 // (3 * d), len(mesh.positions))
        for v in range(self.refined, end):
            self.left, moved = 0, []
            for x, axis in zip(mesh.positions[v], "xyz"):
                name = f"vertex {v} {axis}"
                x += self.step(bits, d, name) if self.moving else bits.raw(d, name)
                x -= 1 << (d - 1)
                if not 0 <= x <= (1 << mesh.bits) - 1 >> mesh.shift:
                    raise Refusal("bad-chunk", "a vertex leaves the grid")
                moved.append(x)
            mesh.positions[v] = tuple(moved)
        self.refined = end
        self.d = 0 if end == len(mesh.positions) else d
        return self.d > 0

    def step(self, bits, d, name):
        upper, cells = bits.raw(1, name + " upper"), 0
        further = self.further[self.left]
        while cells < 16 and bits.adaptive(further[cells], name + " further"):
            cells += 1
        if cells > 0:
            self.left += 1
        half = cells + 1 if upper else -cells
        return (half << (d - 1)) + bits.raw(d - 1, name + " low bits")

    def start_batch(self):
        mesh = self.mesh
        self.batch += 1
        self.split_rate = max(650, 4000 // self.batch)
        self.wedge_rate = max(1100, 7000 // self.batch)
        self.cursor, self.to_ask = 0, len(mesh.faces)
        for face in mesh.faces:
            a, b, c = (mesh.positions[v] for v in face.v)
            edges = sub(c, b), sub(a, c), sub(b, a)
            face.e = [min(255, l3(f32(dot(d, d) + 1.0))) for d in edges]
            face.state, face.added = "Free", 0

    def end_batch(self):
        mesh, order = self.mesh, []
        added = iter(range(self.to_ask, len(mesh.faces)))
        for f in range(self.to_ask):
            order.append(f)
            order += [next(added) for _ in range(mesh.faces[f].added)]
        place = {f: i for i, f in enumerate(order)}
        mesh.faces = [mesh.faces[f] for f in order]
        for face in mesh.faces:
            face.o = [c if c == NONE else place[c >> 2] * 4 + (c & 3) for c in face.o]

    def part(self, bits, count):
        splits = self.find_splits(bits, count)
        if bits.raw(1, "new weights"):
            self.weights = [(bits.raw(8, "weight") + 128) % 256 - 128 for _ in range(5)]
        positions = [self.position(bits, split) for split in splits]
        for split, position in zip(splits, positions):
            self.apply(split, position)

    def find_splits(self, bits, count):
        splits = []
        while len(splits) < count:
            if self.cursor == self.to_ask:
                raise Refusal("bad-chunk", "splits")
            if self.mesh.faces[self.cursor].state == "Free":
                split = self.ask(bits, self.cursor)
                splits += [split] if split else []
            self.cursor += 1
        return splits

    def ask(self, bits, f):
        mesh, face = self.mesh, self.mesh.faces[f]
        own, b, beyond, free = sum(face.e), [0, 0, 0], 0, 0
        for k in range(3):
            c = face.o[k]
            other = own if c == NONE else sum(mesh.faces[c >> 2].e)
            beyond += other
            if mesh.free(c):
                free += 1
                b[k] = bucket(6 * face.e[k] - own - other) + 1
        local = (3 * own + beyond) * 57 >> 10
        best, second = sorted(b, reverse=True)[:2]
        j = 2 if b[2] > max(b[0], b[1]) else 1 if b[1] > b[0] else 0
        v = [mesh.valence[vertex] for vertex in face.v]
        ends = min(15, max(v[k] for k in range(3) if k != j))
        long = max(face.e)
        if not bits.logistic(self.split_rate, self.chosen(
                split_best_edge=free * 32 + best,
                split_second_edge=second,
                split_edge_valence=ends * 12 + (best * 3 >> 3),
                split_shape=clamp(long - (own - long >> 1) + 4, 0, 31),
                split_valences=min(15, min(v)) * 16 + min(15, max(v)),
                split_size=clamp((own * 85 >> 8) - local + 16, 0, 31)), f"face {f} split"):
            face.state = "Refused"
            return None
        split = Split(f, 4 * f + self.ask_kept(bits, f, b))
        face.state = "Taken"
        self.grow(bits, split, local)
        self.ask_boundary(bits, split)
        return split

    def kept_entries(self, f, b, k):
        mesh, face, n, p = self.mesh, self.mesh.faces[f], (k + 1) % 3, (k + 2) % 3

        def quality(c):
            return bucket(mesh.R(c)) + 1 if mesh.free(mesh.O(c)) else 0

        longer, shorter = max(b[n], b[p]), min(b[n], b[p])
        w = min(15, mesh.valence[face.v[k]])
        beyond = max(
            quality(next_corner(face.o[p])) if b[p] else 0,
            quality(prev_corner(face.o[n])) if b[n] else 0)
        return self.chosen(
            kept_valence=w,
            kept_longer_edge=longer + (32 if shorter else 0),
            kept_shorter_edge=shorter + (32 if longer > 14 else 0),
            kept_far_edge=clamp(math.trunc((3 * face.e[k] - sum(face.e)) / 3) + 16, 0, 31),
            kept_beyond=(beyond >> 1) * 16 + w)

    def ask_kept(self, bits, f, b):
        entries = [self.kept_entries(f, b, k) for k in range(3)]
        score = [clamp(total(chosen) >> 8, -2**20, 2**20) for chosen in entries]
        q0 = squash(score[0] - log_sum(score[1], score[2]))
        q1 = squash(score[1] - score[2])
        kept = 0
        if not bits.bit(q0, f"face {f} kept corner 0"):
            kept = 1 if bits.bit(q1, f"face {f} kept corner 1") else 2
        share = (65536 - q0) * q1 >> 16
        for k, probability in enumerate((q0, share, 65536 - q0 - share)):
            step = ((65535 if k == kept else 0) - probability) * self.wedge_rate >> 15
            for table, index in entries[k]:
                table.add(index, step)
        return kept

    def offset(self, vertex, origin):
        return sub(self.mesh.positions[vertex], self.mesh.positions[origin])

    def grow(self, bits, split, local):
        mesh = self.mesh
        kept = mesh.V(split.first)
        split.sum = add(self.offset(mesh.V(next_corner(split.first)), kept),
                        self.offset(mesh.V(prev_corner(split.first)), kept))
        for right in (False, True):
            towards, back = (prev_corner, next_corner) if right else (next_corner, prev_corner)
            grown = 0
            while split.length < 4 and split.length < mesh.valence[kept] - 1:
                end = split.first if right else split.last
                across = mesh.O(towards(end))
                if not mesh.free(across):
                    break
                grown_sum = add(split.sum, self.offset(mesh.V(across), kept))
                chosen = self.grow_entries(
                    split, towards, back(end), grown_sum, local, (2 if right else 0) + (grown > 0))
                if not bits.logistic(self.wedge_rate, chosen, "right on" if right else "left on"):
                    break
                grown, split.length, split.sum = grown + 1, split.length + 1, grown_sum
                mesh.faces[across >> 2].state = "Taken"
                if right:
                    split.first = towards(across)
                else:
                    split.last = towards(across)

    def grow_entries(self, split, towards, cut, grown_sum, local, start):
        mesh, kept = self.mesh, self.mesh.V(split.first)
        crossing = towards(split.first if start >= 2 else split.last)
        across = mesh.O(crossing)
        far = towards(towards(across))
        d, longer = split.length - 1, 1 if split.length > 1 else 0
        beyond = mesh.O(far)
        next_edge = 30 if beyond == NONE else bucket(mesh.R(far)) + 1 if mesh.free(beyond) else 31
        w = min(15, mesh.valence[kept] - split.length + 2)
        centre = mul(grown_sum, f32(1.0 / (split.length + 3)))
        reach = sub(self.offset(mesh.V(across), kept), centre)
        near = clamp(l3(f32(dot(reach, reach) + 1.0)) - l3(f32(dot(centre, centre) + 1.0)) + 32,
                     0, 63)
        return self.chosen(
            grow_start=start * 8 + d,
            grow_edge=bucket(mesh.R(crossing)) + 32 * min(d, 2),
            grow_cut_valence=min(15, mesh.valence[mesh.V(cut)]) + 16 * longer,
            grow_kept_valence=w * 8 + d,
            grow_beyond=next_edge,
            grow_length=clamp(mesh.e(crossing) - local + 24 >> 1, 0, 31) + 32 * longer,
            grow_centre=near * 8 + d)

    def ask_boundary(self, bits, split):
        mesh = self.mesh
        right = mesh.O(prev_corner(split.first)) == NONE
        left = mesh.O(next_corner(split.last)) == NONE
        if right or left:
            context = 2 * right + left + 4 * min(split.length - 1, 2)
            if bits.logistic(self.wedge_rate, self.chosen(boundary=context), "boundary"):
                to_right = right
                if right and left:
                    to_right = bits.logistic(self.wedge_rate, self.chosen(boundary=12), "at right")
                split.kind = "right" if to_right else "left"
        changes = []
        if split.kind != "right":
            changes.append((mesh.V(next_corner(split.first)), 1))
        if split.kind != "left":
            changes.append((mesh.V(prev_corner(split.last)), 1))
        changes.append((mesh.V(split.first), (2 if split.kind == "interior" else 1) - split.length))
        for vertex, change in changes:
            if mesh.valence[vertex] != 65535:
                mesh.valence[vertex] = clamp(mesh.valence[vertex] + change, 0, 65535)

    def ring(self, split):
        """Corners of the wedge, ring positions, outer positions or None."""
        mesh, corners = self.mesh, [split.first]
        while len(corners) < split.length:
            corners.append(next_corner(mesh.O(next_corner(corners[-1]))))
        around = [mesh.V(split.first), mesh.V(next_corner(split.first))]
        around += [mesh.V(prev_corner(c)) for c in corners]
        inner = [prev_corner(split.first), *corners, next_corner(corners[-1])]
        outer = [mesh.O(c) for c in inner]
        at = mesh.positions
        return ([tuple(map(float, at[v])) for v in around],
                [None if c == NONE else tuple(map(float, at[mesh.V(c)])) for c in outer])

    def frame(self, split):
        p, o = self.ring(split)
        share, mean = f32(1.0 / len(p)), (0.0, 0.0, 0.0)
        for point in p:
            mean = add(mean, point)
        mean = mul(mean, share)
        p = [sub(point, mean) for point in p]
        area = weighted = outer = (0.0, 0.0, 0.0)
        length = square = outer_plane = 0.0
        for i, a in enumerate(p):
            b = p[(i + 1) % len(p)]
            d = sub(b, a)
            edge = f32(math.sqrt(dot(d, d)))
            area, length = add(area, cross(a, b)), f32(length + edge)
            weighted, square = add(weighted, mul(add(a, b), edge)), f32(square + dot(a, a))
            if o[i] is not None:
                n = cross(sub(sub(o[i], mean), a), d)
                outer, outer_plane = add(outer, n), f32(outer_plane + dot(n, a))
        centre = mean
        if split.kind != "interior":
            middle = mul(add(p[0], p[-1] if split.kind == "left" else p[1]), 0.5)
            centre, p[0] = add(mean, middle), sub(p[0], middle)
            weighted = sub(weighted, mul(middle, f32(2.0 * length)))
            outer_plane = f32(outer_plane - dot(outer, middle))
        s = dot(area, area)
        normal = mul(area, f32(1.0 / f32(math.sqrt(s)))) if s > 0 else (0.0, 0.0, 1.0)
        radius = max(0.5, f32(math.sqrt(f32(square * share))))
        if length > 0:
            weighted = mul(weighted, f32(0.5 / length))
        along, h0 = dot(outer, normal), 0.0
        if along > 0 and f32(along * along) > f32(K006 * dot(outer, outer)):
            h0 = clamp(f32(outer_plane / along), -radius, radius)
        h1, h2 = dot(p[0], normal), dot(weighted, normal)
        to_kept, to_mean = sub(p[0], mul(normal, h1)), sub(weighted, mul(normal, h2))
        u = [w / 64 for w in self.weights]
        height = f32(f32(f32(h0 * u[0]) + f32(h1 * u[1])) + f32(h2 * u[2]))
        height = clamp(height, -radius, radius)
        expected = add(add(add(centre, mul(to_kept, u[3])), mul(to_mean, u[4])), mul(normal, height))
        return expected, normal, radius, h0

    def position(self, bits, split):
        y, normal, radius, h0 = self.frame(split)
        slope = [abs(x) for x in normal]
        last = slope.index(max(slope))
        first, second = (last + 1) % 3, (last + 2) % 3
        sideways = self.tangential[split.kind != "interior"][clamp(l1(f32(radius + 1.0)), 0, 31)]
        spread = f32(f32(f32(abs(h0) * 0.5) + f32(K002 * radius)) + K03)
        along = self.along_normal[clamp(l1(spread) + 5, 0, 47)]
        result = [0, 0, 0]
        result[first] = self.coordinate(bits, sideways, y[first], "xyz"[first])
        result[second] = self.coordinate(bits, sideways, y[second], "xyz"[second])
        a, b = f32(f32(result[first]) - y[first]), f32(f32(result[second]) - y[second])
        slide = f32(f32(f32(normal[first] * a) + f32(normal[second] * b)) / normal[last])
        result[last] = self.coordinate(bits, along, f32(y[last] - slide), "xyz"[last])
        if not all(0 <= x <= 2**self.mesh.bits - 1 >> self.mesh.shift for x in result):
            raise Refusal("bad-chunk", "position")
        return tuple(result)

    @staticmethod
    def coordinate(bits, model, y, name):
        r = math.floor(f32(y + 0.5))
        rest = f32(y - r)
        sign_context = 0 if rest < -K017 else 2 if rest > K017 else 1
        bits.show(f"expected {name} {y:.9g}")
        return r + bits.integer(model, sign_context, name)

    def apply(self, split, position):
        mesh = self.mesh
        A, K, c, corners = len(mesh.positions), mesh.V(split.first), split.first, [split.first]
        while c != split.last:
            c = next_corner(mesh.O(next_corner(c)))
            corners.append(c)
        i, o = mesh.O(prev_corner(split.first)), mesh.O(next_corner(split.last))
        right, left = mesh.V(next_corner(split.first)), mesh.V(prev_corner(split.last))
        for c in corners:
            mesh.faces[c >> 2].v[c & 3] = A
        r, f = NONE, NONE
        if split.kind != "right":
            r = self.append((K, right, A), split.first)
            mesh.link(r, prev_corner(split.first))
            mesh.link(r + 2, i)
        if split.kind != "left":
            f = self.append((K, A, left), split.last)
            mesh.link(f, next_corner(split.last))
            mesh.link(f + 1, o)
        if r != NONE and f != NONE:
            mesh.link(f + 2, r + 1)
        mesh.positions.append(position)
        mesh.valence.append(split.length + 2)
        mesh.faces[split.seed].added = (r != NONE) + (f != NONE)

    def append(self, vertices, like):
        faces = self.mesh.faces
        faces.append(Face(vertices, len(faces), faces[like >> 2].e, "Taken"))
        return 4 * (len(faces) - 1)
