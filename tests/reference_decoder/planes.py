"""Predictions of attributes from what lies around: "Values" of proto/STREAM_FORMAT.md.

Everything is binary64, which is what Python's numbers are."""

import math

from arithmetic import AXES
from mesh import next_corner, prev_corner

MOST_SAMPLES = 64


def dot64(a, b):
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]


def cross64(a, b):
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def difference(a, b):
    return tuple(float(a[k] - b[k]) for k in range(3))


def add64(a, b):
    return tuple(a[k] + b[k] for k in range(len(AXES)))


def unit_or(vector, other):
    """The vector by its length; other when it has none."""
    square = dot64(vector, vector)
    if not square > 0:
        return other
    length = math.sqrt(square)
    return tuple(x / length for x in vector)


class Expected:
    def __init__(self, value, slope_squared=0.0, error_squared=0.0):
        self.value = value
        self.slope_squared = slope_squared
        self.error_squared = error_squared


class Plane:
    """What the samples around a wedge tell of its numbers."""

    def __init__(self, level, order, wedge):
        self.samples = []
        self._collect(level, order, wedge)
        self.size = len(self.samples)
        if self.samples:
            self._fit(level, order, wedge)

    def _collect(self, level, order, wedge):
        corners = order.corners[wedge]
        near = [
            (level.wedge(c), 1.0) for corner in corners for c in (next_corner(corner), prev_corner(corner))
        ]
        near += [(beyond, 0.3125) for beyond in map(level.beyond, corners) if beyond not in (None, wedge)]
        seen = set()
        for sample, weight in near:
            if order.known[sample] and sample not in seen and len(seen) < MOST_SAMPLES:
                seen.add(sample)
                self.samples.append([sample, weight, 0.0, 0.0])

    def _fit(self, level, order, wedge):
        t, u = self._axes(level, order, wedge)
        centre = level.position(order.corners[wedge][0])
        self.sums = sums = [0.0] * 6
        for sample in self.samples:
            d = difference(level.positions[level.vertices[sample[0]]], centre)
            x, y = dot64(d, t), dot64(d, u)
            weight = sample[1] / (dot64(d, d) + 1.0)
            sample[1:] = weight, x, y
            for i, term in enumerate((
                weight, weight * x, weight * y, weight * x * x, weight * x * y, weight * y * y
            )):
                sums[i] = sums[i] + term
        total, sum_x, sum_y, a, b, c = sums
        self.mean_x, self.mean_y = sum_x / total, sum_y / total
        a = a - sum_x * self.mean_x
        b = b - sum_x * self.mean_y
        c = c - sum_y * self.mean_y
        ridge = 0.0001 * (a + c) + 2.0 ** -30
        a, c = a + ridge, c + ridge
        self.matrix = a, b, c, a * c - b * b

    @staticmethod
    def _axes(level, order, wedge):
        normal = (0.0, 0.0, 0.0)
        for corner in order.corners[wedge]:
            normal = add64(normal, level.face_normal(corner)[0])
        normal = unit_or(normal, (0.0, 0.0, 1.0))
        axis = (1.0, 0.0, 0.0) if -0.625 < normal[0] < 0.625 else (0.0, 1.0, 0.0)
        t = cross64(axis, normal)
        length = math.sqrt(dot64(t, t))
        t = tuple(x / length for x in t)
        return t, cross64(normal, t)

    def reach_squared(self):
        return self.size / self.sums[0]

    def expect(self, values, k):
        """What is expected of number k; values: by wedge."""
        total, sum_x, sum_y = self.sums[:3]
        g = h = i = 0.0
        for sample, weight, x, y in self.samples:
            weighted = weight * values[sample][k]
            g = g + weighted
            h = h + weighted * x
            i = i + weighted * y
        mean = g / total
        h, i = h - mean * sum_x, i - mean * sum_y
        a, b, c, determinant = self.matrix
        slope_x = (h * c - i * b) / determinant
        slope_y = (i * a - h * b) / determinant
        value = mean - slope_x * self.mean_x - slope_y * self.mean_y
        error = 0.0
        for sample, weight, x, y in self.samples:
            rest = values[sample][k] - (value + slope_x * x + slope_y * y)
            error = error + weight * rest * rest
        return Expected(value, slope_x * slope_x + slope_y * slope_y, error / total)
