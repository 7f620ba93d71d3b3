"""Programs that the benchmark runs, and how they get built."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
BUILD = ROOT / "build/bench"
VSPLIT = BUILD / "bin/vsplit"
BENCH_LOD = BUILD / "bin/bench_lod"
DECODE_SPEED = BUILD / "bin/decode_speed"
BENCH_ATTRIBUTES = BUILD / "bin/bench_attributes"
BENCH_PICTURES = BUILD / "bin/bench_pictures"
BENCH_DISTANCE = BUILD / "bin/bench_distance"
MAKE_BIG_MESH = BUILD / "bin/make_big_mesh"
MESHDIST = BUILD / "meshdist"
MESHDIST_SOURCE = ROOT.parent / "shared/tools/meshdist.cpp"
CGAL = BUILD / "cgal/usr/include"


def note(text):
    """Tells the person at the terminal how far we are."""
    print(text, file=sys.stderr, flush=True)


class Failed(Exception):
    """A program that the benchmark cannot do without has failed."""


class Run:
    """A finished program: exit status (negative for a signal), output, errors, time."""

    def __init__(self, *arguments):
        self.command = [str(argument) for argument in arguments]
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            started = time.monotonic()
            process = subprocess.Popen(self.command, stdin=subprocess.DEVNULL, stdout=out, stderr=err)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = self.status = os.waitstatus_to_exitcode(status)
            self.wall_seconds = time.monotonic() - started
            self.cpu_seconds = usage.ru_utime + usage.ru_stime
            out.seek(0)
            err.seek(0)
            self.output = out.read().decode(errors="replace")
            self.errors = err.read().decode(errors="replace").strip()

    def good(self):
        """Returns itself; raises Failed when the program did not end with status 0."""
        if self.status != 0:
            raise Failed(f"{' '.join(self.command)}: status {self.status}: {self.errors}")
        return self

    def json(self):
        return json.loads(self.good().output)


def build():
    """Builds vsplit and the tools of tests/bench in build/bench, with the release flags."""
    Run(ROOT / "scripts/install-deps", "core", "bench").good()
    BUILD.mkdir(parents=True, exist_ok=True)
    unpack_cgal()
    note("building vsplit and its peers in build/bench")
    Run("cmake", "--preset", "bench", "-S", ROOT, f"-DVSPLIT_CGAL_INCLUDE_DIR={CGAL}").good()
    Run("cmake", "--build", BUILD, "--parallel", os.cpu_count()).good()
    build_meshdist()


def unpack_cgal():
    """CGAL's headers: libcgal-dev conflicts with Boost 1.81 as a package, not as code."""
    if CGAL.exists():
        return
    with tempfile.TemporaryDirectory(dir="/tmp") as folder:
        subprocess.run(["apt-get", "download", "-qq", "libcgal-dev"], cwd=folder, check=True)
        package = next(pathlib.Path(folder).glob("libcgal-dev_*.deb"))
        Run("dpkg-deb", "-x", package, BUILD / "cgal").good()


def build_meshdist():
    """The independent distance tool, where its source is at hand."""
    if MESHDIST_SOURCE.exists() and not MESHDIST.exists():
        note("building meshdist")
        Run("g++", "-O2", "-std=c++17", f"-I{CGAL}", MESHDIST_SOURCE, "-o", MESHDIST,
            "-lOpenMeshCore", "-lgmp").good()
