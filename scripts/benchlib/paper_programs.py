"""Programs that scripts/bench --paper runs, and what they tell."""

import concurrent.futures
import json
import os
import pathlib
import statistics
import subprocess

from . import models, programs
from .cache import Cache, content_hash
from .programs import ROOT, Run

BIN = ROOT / "build/release/bin"
VSPLIT = BIN / "vsplit"
SIMPLIFY = BIN / "paper_simplify"
DISTANCE = BIN / "paper_distance"
DRAW = BIN / "paper_draw"
VTK_SCRIPT = pathlib.Path(__file__).with_name("paper_vtk.py")
# VTK comes from Debian, so that is the interpreter that finds it.
PYTHON = "/usr/bin/python3"
JUDGE_SAMPLES = 100_000
# To be raised when paper_distance measures otherwise than before: forgets what is cached.
CACHE_VERSION = 1
PAPER_MODELS = ["cow", "bones"]
DRAW_ROUNDS, DRAW_FRAMES = 5, 40
SCREEN = (240, 320)
PICTURE = (320, 320)


def build():
    """Builds vsplit and the tools of tests/bench/paper, and the independent judge where it is at hand."""
    Run(ROOT / "scripts/install-deps", "core", "demo", "bench", "paper").good()
    programs.BUILD.mkdir(parents=True, exist_ok=True)
    programs.unpack_cgal()
    programs.note("building vsplit and the tools of tests/bench/paper in build/release")
    Run("cmake", "--preset", "release", "-S", ROOT,
        f"-DVSPLIT_CGAL_INCLUDE_DIR={programs.CGAL}").good()
    Run("cmake", "--build", ROOT / "build/release", "--parallel", os.cpu_count(), "--target",
        "vsplit", "paper_simplify", "paper_distance", "paper_draw").good()
    programs.build_meshdist()


def find_paper_models(named):
    """The cow and the bones: from the folder of models, else from Debian's libcgal-demo."""
    folder = models.models_folder(named)
    paths = [models.find_model(folder, name) for name in PAPER_MODELS]
    if all(paths):
        return paths
    programs.note("getting the models from Debian's libcgal-demo")
    fetched = Run(ROOT / "scripts/fetch-paper-models").good().output
    return [pathlib.Path(line) for line in fetched.split("\n") if line]


def encode(mesh, stream, *options):
    """Encodes a mesh and returns the encoder's report."""
    return Run(VSPLIT, "encode", mesh, "-o", stream, "--quiet", "--json", "-", *options).json()


def decode(stream, mesh, level):
    """Writes what the stream shows at a level."""
    Run(VSPLIT, "decode", stream, "-o", mesh, "--level", level).good()


def simplify(method, original, mesh, faces):
    """Simplifies by a method of paper_simplify, or of VTK when its name says so."""
    if method.startswith("vtk-"):
        Run(PYTHON, VTK_SCRIPT, method, original, mesh, faces).good()
    else:
        Run(SIMPLIFY, method, original, mesh, faces).good()


class PaperJudge:
    """rms, Hausdorff and normal error, by ../shared/tools/meshdist.cpp (CGAL, independent of vsplit)
    when it could be built, else by vsplit's own distance code; in the first case the second one gives
    its opinion, too."""

    def __init__(self, cache_folder):
        self.cache = Cache(cache_folder)
        self.independent = programs.MESHDIST.exists()
        self.name = "meshdist (CGAL)" if self.independent else "vsplit's own distance code"
        self.disagreements = []

    def distances(self, original, meshes):
        """One {"vertices", "faces", "rms", "max", "normals"} for each mesh: percent of the diagonal,
        and degrees."""
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            return list(pool.map(lambda mesh: self.distance(original, mesh), meshes))

    def distance(self, original, mesh):
        key = content_hash("paper", CACHE_VERSION, str(self.independent), original, mesh)
        found = self.cache.get(key, lambda: self.measure(original, mesh))
        if found["other_rms"] is not None and found["rms"] > 0.001:
            self.disagreements.append(abs(found["other_rms"] / found["rms"] - 1.0))
        return found

    def measure(self, original, mesh):
        own = Run(DISTANCE, "-", original, mesh).json()[0]
        row, other = own, None
        if self.independent:
            row, other = Run(programs.MESHDIST, original, mesh, JUDGE_SAMPLES).json(), own["rms_pct"]
        return {"vertices": own["vertices"], "faces": own["faces"], "rms": row["rms_pct"],
                "max": row["haus_pct"], "normals": row["normal_deg"], "other_rms": other}


def region_distances(ball, original, meshes):
    """What vsplit's own distance code says about the inside and the outside of a ball."""
    return Run(DISTANCE, ball, original, *meshes).json()


def draw(original, meshes, *options):
    command = [DRAW, original, *meshes, *options]
    # Software rendering in the program's own thread, so that its processor time is the frame's time.
    result = subprocess.run([str(part) for part in command], capture_output=True, text=True,
                            env={**os.environ, "LP_NUM_THREADS": "0"})
    if result.returncode != 0:
        raise programs.Failed(f"{' '.join(map(str, command))}: {result.stderr.strip()}")
    return json.loads(result.stdout)


def frame_rates(original, meshes):
    """Frames a second of the grid display for each mesh: the median over rounds, in which the meshes
    take turns."""
    size = ["--width", SCREEN[0], "--height", SCREEN[1]]
    rounds = [draw(original, meshes, "--wireframe", "--frames", DRAW_FRAMES, *size)
              for _ in range(DRAW_ROUNDS)]
    return [1000.0 / statistics.median(row[i]["processor_ms"] for row in rounds)
            for i in range(len(meshes))]


def pictures(original, meshes, folder, wireframe):
    """Draws each mesh into a PNG of its name; returns the paths."""
    folder.mkdir(parents=True, exist_ok=True)
    draw(original, meshes, "--pictures", folder, "--width", PICTURE[0], "--height", PICTURE[1],
         *(["--wireframe"] if wireframe else []))
    return [folder / f"{pathlib.Path(mesh).stem}.png" for mesh in meshes]
