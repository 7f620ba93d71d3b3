"""Binary32 and vectors, proto/STREAM_FORMAT.md, "Arithmetic". Python's own numbers are binary64; each
result is rounded at once, which gives what binary32 would give."""
import struct


def clamp(x, low, high):
    return low if x < low else high if x > high else x


def f32(x):
    return struct.unpack("<f", struct.pack("<f", x))[0]


K006, K002, K03, K017 = f32(0.06), f32(0.02), f32(0.3), f32(0.17)


def pattern(x):
    return struct.unpack("<I", struct.pack("<f", x))[0]


def l3(x):
    return (pattern(x) >> 20) - 1016


def l1(x):
    return (pattern(x) >> 22) - 254


def add(a, b):
    return tuple(f32(x + y) for x, y in zip(a, b))


def sub(a, b):
    return tuple(f32(x - y) for x, y in zip(a, b))


def mul(a, s):
    return tuple(f32(x * s) for x in a)


def dot(a, b):
    return f32(f32(f32(a[0] * b[0]) + f32(a[1] * b[1])) + f32(a[2] * b[2]))


def cross(a, b):
    def one(i, j):
        return f32(f32(a[i] * b[j]) - f32(a[j] * b[i]))
    return one(1, 2), one(2, 0), one(0, 1)
