"""Fields of the header of proto/STREAM_FORMAT.md ("Header", "Attributes")."""

import math
import struct

from bits import Refusal


def require(condition, error="bad-header"):
    if not condition:
        raise Refusal(error)


class Attribute:
    """An entry of the table of attributes ("Attributes")."""

    COMPONENTS = ((2,), (3,), (3, 4), (1, 2, 3, 4))

    def __init__(self, data):
        fields = HeaderBytes(data)
        try:
            shape, self.set, self.bits = (fields.unpack("B") for _ in range(3))
            self.kind, self.components, self.rgb = shape & 7, shape >> 4, bool(shape & 8)
            has_grid = self.kind in (0, 3)
            self.grid = [fields.unpack("f") for _ in range(self.components + 1 if has_grid else 0)]
        except Refusal:
            raise Refusal("bad-header") from None
        require(self.kind < 4 and self.components in self.COMPONENTS[self.kind])
        require(self.bits <= 16 and self.bits >= (2 if self.kind == 1 else 1))
        require(self.kind == 2 or not self.rgb)
        require(all(map(math.isfinite, self.grid)) and (not has_grid or self.grid[-1] > 0))
        self.name = fields.take(len(data) - fields.at)
        self.numbers = 2 if self.kind == 1 else self.components

    def number_range(self, k):
        """Least and greatest value of number k."""
        most = (1 << self.bits) - 1
        return (-most if self.kind == 2 and not self.rgb and k in (1, 2) else 0), most


class Entry:
    """The bytes of an entry, shown as hexadecimal digits."""

    def __init__(self, fields):
        self.data = fields.take(fields.varint())

    def __str__(self):
        return self.data.hex()


class HeaderBytes:
    """Takes fields from the header; what lies behind its end is truncated."""

    def __init__(self, data):
        self.data = data
        self.at = 0

    def take(self, n):
        if n > len(self.data) - self.at:
            raise Refusal("truncated")
        self.at += n
        return self.data[self.at - n:self.at]

    def unpack(self, kind):
        return struct.unpack("<" + kind, self.take(struct.calcsize("<" + kind)))[0]

    def varint(self):
        value = 0
        for i in range(10):
            byte = self.unpack("B")
            value |= (byte & 127) << (7 * i)
            if byte < 128:
                break
        else:
            raise Refusal("bad-header")
        if value >> 64:
            raise Refusal("bad-header")
        return value
