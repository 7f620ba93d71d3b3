"""Bit streams and models of proto/STREAM_FORMAT.md ("Bit streams", "Models")."""

import math

from arithmetic import clamp, int32


class Refusal(Exception):
    """An error of the stream by its name in "Errors"."""


def _crc_table():
    table = []
    for byte in range(256):
        for _ in range(8):
            byte = (byte >> 1) ^ (0x82F63B78 if byte & 1 else 0)
        table.append(byte)
    return table


_CRC = _crc_table()


def crc32c(data):
    value = 0xFFFFFFFF
    for byte in data:
        value = (value >> 8) ^ _CRC[(value ^ byte) & 255]
    return value ^ 0xFFFFFFFF


def _squash_entry(i):
    return round(clamp(65536 / (1 + math.exp(-(i - 2048) / 256)), 48, 65488))


SQUASH = [_squash_entry(i) for i in range(4096)]
LOG_SUM = [round(256 * math.log1p(math.exp(-i / 64))) for i in range(1024)]
ADAPTATION = [655360 // (10 * i + 16) for i in range(128)]


def squash(s):
    return SQUASH[clamp(s + 2048, 0, 4095)]


def log_sum(a, b):
    return max(a, b) + LOG_SUM[min(1023, abs(a - b) >> 2)]


class AdaptiveBit:
    __slots__ = ("probability", "count")

    def __init__(self, probability=32768, count=0):
        self.probability = probability
        self.count = count

    def learn(self, x):
        target = 65535 if x else 0
        self.probability += ((target - self.probability) * ADAPTATION[self.count]) >> 16
        self.count = min(120, self.count + 1)


def adaptive_bits(n):
    return [AdaptiveBit() for _ in range(n)]


class IntegerModel:
    """100 adaptive bits, made by make(name, index) in the order of the initial state."""

    def __init__(self, make=lambda name, index: AdaptiveBit()):
        self.nonzero = make("nonzero", 0)
        self.sign = [make("sign", i) for i in range(3)]
        self.prefix = [make("prefix", e) for e in range(24)]
        self.mantissa = [[make("mantissa", e) for _ in range(3)] for e in range(24)]


def trace_bytes(trace, data, label):
    for i in range(0, len(data), 16):
        line = " ".join(f"{byte:02x}" for byte in data[i:i + 16])
        trace(f"{line:26}  {label}" if i == 0 else line)


class BitStreams:
    """The raw bits from the front and the modelled ones from the end of the same bytes.

    trace is called with a line for every decision; None for none."""

    def __init__(self, data, error, trace=None):
        self.data = data
        self.error = error
        self.trace = trace
        self.raw_bits = 0
        if not data or data[-1] >> 6 == 3:
            raise Refusal(error)
        t = data[-1] >> 6
        if t + 1 > len(data):
            raise Refusal(error)
        self.position = len(data) - 1 - t
        number = int.from_bytes(data[self.position:], "little")
        self.state = (number & ((1 << (6 + 8 * t)) - 1)) + 4096
        if self.state >= 1 << 20:
            raise Refusal(error)

    def _begun(self):
        return (self.raw_bits + 7) // 8

    def exhausted(self):
        begun = self._begun()
        return begun > self.position or (begun == self.position and self.state < 4096)

    def refuse_exhausted(self):
        if self.exhausted():
            raise Refusal(self.error)

    def raw(self, n, name):
        first = self.raw_bits >> 3
        window = int.from_bytes(self.data[first:first + 5], "little")
        value = (window >> (self.raw_bits & 7)) & ((1 << n) - 1)
        self.raw_bits += n
        if self.trace and n:
            self.trace(f"raw {n:2}              {name}: {value}")
        return value

    def _refill(self):
        if self.state < 4096 and self.position > 0:
            self.position -= 1
            self.state = self.state * 256 + self.data[self.position]

    def bit(self, q, name):
        p = 256 - clamp(256 - ((q + 128) >> 8), 1, 255)
        self._refill()
        before = self.state
        quotient, rest = before >> 8, before & 255
        x = 1 if rest < p else 0
        self.state = quotient * p + rest if x else before - quotient * p - p
        if self.trace:
            self.trace(f"state {before:7} p {p:3}  {name}: {x}")
        return x

    def adaptive(self, model, name):
        x = self.bit(((model.probability * 1023) >> 10) + 32, name)
        model.learn(x)
        return x

    def logistic(self, rate, entries, name):
        """entries: pairs (table, index) of weights."""
        score = int32(sum(table[i] for table, i in entries))
        q = squash(score >> 8)
        x = self.bit(q, name)
        step = (((65535 if x else 0) - q) * rate) >> 15
        for table, i in entries:
            table[i] = int32(table[i] + step)
        return x

    def integer(self, model, sign_context, name):
        if not self.adaptive(model.nonzero, f"{name} nonzero"):
            return 0
        negative = self.adaptive(model.sign[sign_context], f"{name} negative")
        e = 0
        while e < 23 and self.adaptive(model.prefix[e], f"{name} beyond 2^{e + 1} - 1"):
            e += 1
        v = 1
        if e >= 1:
            first = self.adaptive(model.mantissa[e][0], f"{name} mantissa")
            v = 2 + first
        if e >= 2:
            v = 2 * v + self.adaptive(model.mantissa[e][2 if first else 1], f"{name} mantissa")
        if e >= 3:
            v = (v << (e - 2)) + self.raw(e - 2, f"{name} low bits")
        return -v if negative else v

    def finish(self):
        """Checks that the two streams meet."""
        self._refill()
        if self.state != 4096 or self.position != self._begun():
            raise Refusal(self.error)
        if self.raw_bits & 7 and self.data[self.raw_bits >> 3] >> (self.raw_bits & 7):
            raise Refusal(self.error)
