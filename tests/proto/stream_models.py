"""Bit streams and models, proto/STREAM_FORMAT.md, "Bit streams" and "Models"."""
import math
import pathlib
import re

from stream_arithmetic import clamp

PACKED = [
    int(number) for number in re.findall(
        r"\d+", (pathlib.Path(__file__).parents[2] / "proto/initial_model.inc").read_text())
]
SQUASH = [
    math.floor(min(65488.0, max(48.0, 65536 / (1 + math.exp(-(i - 2048) / 256)))) + 0.5)
    for i in range(4096)
]
LOG_SUM = [math.floor(256 * math.log(1 + math.exp(-i / 64)) + 0.5) for i in range(1024)]
ADAPTATION = [655360 // (10 * i + 16) for i in range(128)]


class Refusal(Exception):
    """Why a stream is refused: the error's name and where."""

    def __str__(self):
        return f"{self.args[0]}: {self.args[1]}"


def crc32c(data, previous=0):
    value = previous ^ 0xFFFFFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0x82F63B78 if value & 1 else 0)
    return value ^ 0xFFFFFFFF


def wrap(x):
    return (x + 2**31) % 2**32 - 2**31


def squash(score):
    return SQUASH[clamp(score + 2048, 0, 4095)]


def log_sum(a, b):
    return max(a, b) + LOG_SUM[min(1023, abs(a - b) >> 2)]


class Weights:
    """A table of learned weights."""

    def __init__(self, entries, packed):
        self.entries = [((next(packed) + 128) % 256 - 128) * 2048 for _ in range(entries)]

    def add(self, index, step):
        self.entries[index] = wrap(self.entries[index] + step)


def total(chosen):
    """Wrapping sum of (table, index) pairs."""
    return wrap(sum(table.entries[index] for table, index in chosen))


def initial_bit(packed):
    """Probability and count."""
    byte = next(packed)
    return [256 * byte + 128, 24] if byte else [32768, 0]


class IntegerModel:
    def __init__(self, packed):
        self.nonzero = initial_bit(packed)
        self.sign = [initial_bit(packed) for _ in range(3)]
        self.prefix = [initial_bit(packed) for _ in range(24)]
        self.mantissa = [[initial_bit(packed) for _ in range(3)] for _ in range(24)]


class BitStreams:
    """Raw and modelled bits of one chunk."""

    def __init__(self, contents, trace, error="bad-chunk"):
        self.trace, self.error, self.bytes, self.raw_taken = trace, error, contents, 0
        more = contents[-1] >> 6 if contents else 3
        if more == 3 or more + 1 > len(contents):
            raise Refusal(error, "modelled bits")
        self.position = len(contents) - 1 - more
        number = int.from_bytes(contents[self.position:], "little")
        self.state = (number & (2 ** (6 + 8 * more) - 1)) + 4096
        if self.state >= 2**20:
            raise Refusal(error, "state")

    def show(self, text):
        if self.trace:
            print("    " + text)

    def raw(self, count, name):
        value = 0
        for i in range(count):
            byte, bit = divmod(self.raw_taken, 8)
            if byte < len(self.bytes):
                value |= (self.bytes[byte] >> bit & 1) << i
            self.raw_taken += 1
        if count:
            self.show(f"raw {count:2}              {name}: {value}")
        return value

    def refill(self):
        if self.state < 4096 and self.position > 0:
            self.position -= 1
            self.state = self.state * 256 + self.bytes[self.position]

    def bit(self, q, name):
        z = clamp(256 - ((q + 128) >> 8), 1, 255)
        p = 256 - z
        self.refill()
        before, quotient, rest = self.state, self.state >> 8, self.state & 255
        one = rest < p
        self.state = quotient * p + rest if one else self.state - quotient * p - p
        self.show(f"state {before:7} p {p:3}  {name}: {int(one)}")
        return one

    def exhausted(self):
        begun = (self.raw_taken + 7) // 8
        return begun > self.position or (begun == self.position and self.state < 4096)

    def finish(self):
        self.refill()
        begun = (self.raw_taken + 7) // 8
        rest = self.bytes[begun - 1] >> self.raw_taken % 8 if self.raw_taken % 8 else 0
        if begun != self.position or rest or self.state != 4096:
            raise Refusal(self.error, "end of the bit streams")

    def adaptive(self, m, name):
        x = self.bit((m[0] * 1023 >> 10) + 32, name)
        m[0] += ((65535 if x else 0) - m[0]) * ADAPTATION[m[1]] >> 16
        m[1] = min(120, m[1] + 1)
        return x

    def logistic(self, rate, chosen, name):
        q = squash(total(chosen) >> 8)
        x = self.bit(q, name)
        step = ((65535 if x else 0) - q) * rate >> 15
        for table, index in chosen:
            table.add(index, step)
        return x

    def integer(self, m, sign_context, name):
        if not self.adaptive(m.nonzero, name + " nonzero"):
            return 0
        negative = self.adaptive(m.sign[sign_context], name + " negative")
        e = 0
        while e < 23 and self.adaptive(m.prefix[e], name + f" beyond 2^{e + 1} - 1"):
            e += 1
        v = 1
        if e >= 1:
            first = self.adaptive(m.mantissa[e][0], name + " mantissa")
            v = 2 + first
        if e >= 2:
            v = 2 * v + self.adaptive(m.mantissa[e][2 if first else 1], name + " mantissa")
        if e >= 3:
            v = (v << (e - 2)) + self.raw(e - 2, name + " low bits")
        return -v if negative else v
