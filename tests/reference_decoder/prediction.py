"""Where a removed vertex is expected: "Prediction" of proto/STREAM_FORMAT.md."""

from dataclasses import dataclass

from arithmetic import add, clamp, cross, divide, dot, from_bits, root, scale, single, subtract
from mesh import next_corner, prev_corner

ZERO = (0.0, 0.0, 0.0)
FLAT = from_bits(0x3D75C28F)                                         # 0.06


@dataclass
class Frame:
    expected: tuple
    normal: tuple
    radius: float
    lean: float                                                      # h_0


def ring_of(mesh, wedge):
    """The ring's vertices, kept first, and the outer vertex beyond each of its edges or None."""
    ring = [mesh.vertex[wedge[0]], mesh.vertex[next_corner(wedge[0])]]
    ring += [mesh.vertex[prev_corner(c)] for c in wedge]
    inner = [prev_corner(wedge[0]), *wedge, next_corner(wedge[-1])]
    across = [mesh.opposite[c] for c in inner]
    return ring, [mesh.vertex[o] if o >= 0 else None for o in across]


class _Sums:
    def __init__(self, p, outer_positions, mean):
        self.area = self.weighted = self.outer = ZERO
        self.length = self.square = self.outer_plane = 0.0
        for i, a in enumerate(p):
            self._add_edge(a, p[(i + 1) % len(p)], outer_positions[i], mean)

    def _add_edge(self, a, b, o, mean):
        d = subtract(b, a)
        length = root(dot(d, d))
        self.area = add(self.area, cross(a, b))
        self.length = single(self.length + length)
        self.weighted = add(self.weighted, scale(add(a, b), length))
        self.square = single(self.square + dot(a, a))
        if o is not None:
            n = cross(subtract(subtract(o, mean), a), d)
            self.outer = add(self.outer, n)
            self.outer_plane = single(self.outer_plane + dot(n, a))


def predict(mesh, wedge, boundary, weights):
    """boundary: None, "left" or "right"; weights: the five prediction weights."""
    ring, outer = ring_of(mesh, wedge)
    share = divide(1.0, float(len(ring)))
    positions = [tuple(map(float, mesh.positions[v])) for v in ring]
    mean = ZERO
    for position in positions:
        mean = add(mean, position)
    mean = scale(mean, share)
    p = [subtract(position, mean) for position in positions]
    outer_positions = [None if v is None else tuple(map(float, mesh.positions[v])) for v in outer]
    sums = _Sums(p, outer_positions, mean)
    centre = mean
    if boundary:
        middle = scale(add(p[0], p[-1] if boundary == "left" else p[1]), 0.5)
        centre = add(mean, middle)
        p[0] = subtract(p[0], middle)
        sums.weighted = subtract(sums.weighted, scale(middle, single(2 * sums.length)))
        sums.outer_plane = single(sums.outer_plane - dot(sums.outer, middle))
    return _place(sums, p[0], centre, share, weights)


def _place(sums, kept, centre, share, weights):
    s = dot(sums.area, sums.area)
    normal = scale(sums.area, divide(1.0, root(s))) if s > 0 else (0.0, 0.0, 1.0)
    radius = max(root(single(sums.square * share)), 0.5)
    weighted = sums.weighted
    if sums.length > 0:
        weighted = scale(weighted, divide(0.5, sums.length))
    h = (_lean(sums, normal, radius), dot(kept, normal), dot(weighted, normal))
    to_kept = subtract(kept, scale(normal, h[1]))
    to_mean = subtract(weighted, scale(normal, h[2]))
    u = [w / 64 for w in weights]
    height = single(
        single(single(h[0] * u[0]) + single(h[1] * u[1])) + single(h[2] * u[2])
    )
    height = clamp(height, -radius, radius)
    expected = add(centre, scale(to_kept, u[3]))
    expected = add(add(expected, scale(to_mean, u[4])), scale(normal, height))
    return Frame(expected, normal, radius, h[0])


def _lean(sums, normal, radius):
    along = dot(sums.outer, normal)
    flat = single(FLAT * dot(sums.outer, sums.outer))
    if not (along > 0 and single(along * along) > flat):
        return 0.0
    return clamp(divide(sums.outer_plane, along), -radius, radius)
