"""Numbers as proto/STREAM_FORMAT.md wants them ("Arithmetic"): binary32, integers in 32 bits.

Every function on reals takes and gives binary32 numbers, held in Python's binary64: the result of one
operation in binary64, rounded once more, is the correctly rounded binary32 result."""

import math
import struct
from array import array

_CELL = array("f", [0.0])
_BITS = struct.Struct("<f"), struct.Struct("<I")
AXES = "xyz"


def single(x):
    """Rounds to binary32, ties to even; beyond its range to infinity."""
    _CELL[0] = x
    return _CELL[0]


def from_bits(bits):
    return _BITS[0].unpack(_BITS[1].pack(bits))[0]


def to_bits(x):
    return _BITS[1].unpack(_BITS[0].pack(x))[0]


def clamp(x, low, high):
    return low if x < low else high if x > high else x


def l3(x):
    return (to_bits(x) >> 20) - 1016


def l1(x):
    return (to_bits(x) >> 22) - 254


def l0(x):
    return (to_bits(x) >> 23) - 127


def int32(x):
    return ((x + 0x80000000) & 0xFFFFFFFF) - 0x80000000


def digits(n):
    """Number of binary digits: 0 has none, 1 has one."""
    return n.bit_length()


def divide(a, b):
    return single(a / b)


def root(x):
    return single(math.sqrt(x))


def add(a, b):
    return single(a[0] + b[0]), single(a[1] + b[1]), single(a[2] + b[2])


def subtract(a, b):
    return single(a[0] - b[0]), single(a[1] - b[1]), single(a[2] - b[2])


def scale(a, k):
    return single(a[0] * k), single(a[1] * k), single(a[2] * k)


def dot(a, b):
    return single(
        single(single(a[0] * b[0]) + single(a[1] * b[1])) + single(a[2] * b[2])
    )


def cross(a, b):
    return (
        single(single(a[1] * b[2]) - single(a[2] * b[1])),
        single(single(a[2] * b[0]) - single(a[0] * b[2])),
        single(single(a[0] * b[1]) - single(a[1] * b[0])),
    )


def squared_distance(a, b):
    d = subtract(a, b)
    return dot(d, d)


def axes_of(normal):
    """Axes (first, second, last) of "Positions"; last is the one along which the normal is longest."""
    x, y, z = (abs(component) for component in normal)
    last = 0 if x >= y and x >= z else 1 if y >= z else 2
    return (last + 1) % 3, (last + 2) % 3, last
