#!/usr/bin/env python3
"""Tests of proto/STREAM_FORMAT.md with the decoder written from it: the worked stream, the tables'
checksums, and that damaged streams are refused."""

import pathlib
import re
import struct
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import bits
from attributes import initial_residuals
from decode import PROTO, Decoder, packed_model, show_level

DOCUMENT = (PROTO / "STREAM_FORMAT.md").read_text(encoding="utf-8")
GOLDEN = PROTO.parent / "tests" / "golden"
ERRORS = set(re.findall(r"\n\| \d \| ([a-z-]+) \|", DOCUMENT))
BYTES = re.compile(r"(?:[0-9a-f]{2} )*[0-9a-f]{2}(?=  |$)")


def worked_trace():
    section = DOCUMENT[DOCUMENT.index("\n## Worked stream"):]
    lines = [line[4:] for line in section.splitlines() if line.startswith("    ")]
    return lines[next(i for i, line in enumerate(lines) if BYTES.match(line)):]


def worked_stream():
    found = filter(None, map(BYTES.match, worked_trace()))
    return bytes.fromhex(" ".join(match.group() for match in found))


def refusal(data):
    """Name of the error with which the data are refused, None when they are not."""
    try:
        Decoder(data, lambda *level: None)
    except bits.Refusal as error:
        return str(error)
    return None


class DocumentTest(unittest.TestCase):
    def test_the_worked_stream_is_decoded_as_the_document_shows(self):
        lines = []
        Decoder(
            worked_stream(), lambda *level: lines.extend(show_level(*level)), lines.append
        )
        self.assertEqual(lines, worked_trace())

    def test_the_tables_have_the_checksums_of_the_document(self):
        steps = [2 ** (-i / 8) for i in range(8)]
        tables = {
            "kSquash": struct.pack("<4096H", *bits.SQUASH),
            "kLogSum": struct.pack("<1024h", *bits.LOG_SUM),
            "kAdaptation": struct.pack("<128H", *bits.ADAPTATION),
            "kErrorSteps": struct.pack("<8d", *steps),
            "kInitialResiduals": initial_residuals(),
            "kPacked": packed_model(),
        }
        rows = re.findall(r"\n\| `(k\w+)` \| \d+ \| \w+ \| 0x([0-9a-f]{8}) \|", DOCUMENT)
        self.assertEqual(
            {name: int(crc, 16) for name, crc in rows},
            {name: bits.crc32c(data) for name, data in tables.items()},
        )

    def test_every_prefix_is_truncated(self):
        data = worked_stream()
        for length in range(len(data)):
            self.assertEqual(refusal(data[:length]), "truncated", length)

    def test_every_changed_byte_is_refused(self):
        data = worked_stream()
        for i in range(len(data)):
            damaged = data[:i] + bytes([data[i] ^ 0x55]) + data[i + 1:]
            self.assertIn(refusal(damaged), ERRORS, i)

    def test_bytes_behind_the_end_are_refused(self):
        self.assertEqual(refusal(worked_stream() + b"\0"), "trailing-bytes")

    def test_changed_chunks_with_right_checksums_are_refused_or_valid(self):
        """Nothing but a refusal may leave the decoder, whatever the bits say."""
        for name in ("strip", "sheet_splits"):
            outcomes = self._outcomes((GOLDEN / f"{name}.vsplit").read_bytes())
            self.assertIn("bad-chunk", outcomes)
            self.assertLessEqual(outcomes, {"bad-chunk", None})

    @staticmethod
    def _outcomes(data):
        rows = Decoder(data, lambda *level: None).header.rows
        begin = len(data) - sum(row.size for row in rows)
        outcomes = set()
        for row in rows:
            for i in range(begin, begin + row.size - 4, 5):
                chunk = bytearray(data[begin:begin + row.size - 4])
                chunk[i - begin] ^= 0x24
                checksum = bits.crc32c(chunk).to_bytes(4, "little")
                end = begin + row.size
                outcomes.add(refusal(data[:begin] + bytes(chunk) + checksum + data[end:]))
            begin += row.size
        return outcomes


if __name__ == "__main__":
    unittest.main()
