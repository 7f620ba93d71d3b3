"""Surface distances: rms and Hausdorff in percent of the original's bounding-box diagonal."""

from . import programs
from .cache import content_hash
from .programs import Run


SAMPLES = 200_000  # points a side, for everything that counts
CURVE_SAMPLES = 50_000  # for points that are only drawn


class Judge:
    """Measures by ../shared/tools/meshdist.cpp (CGAL, independent of vsplit) when it could be built,
    else by vsplit's own distance code."""

    def __init__(self, cache):
        self.cache = cache
        self.independent = programs.MESHDIST.exists()
        self.tool = programs.MESHDIST if self.independent else programs.BENCH_DISTANCE
        who = "meshdist (CGAL)" if self.independent else "vsplit's own code"
        self.name = f"{who}, {SAMPLES:,} points a side ({CURVE_SAMPLES:,} where they are only drawn)"
        self.version = content_hash(programs.MESHDIST_SOURCE) if self.independent else "own 1"

    def distance(self, original, shown, samples=SAMPLES):
        """{"rms", "max"} of a mesh file against the original's."""
        key = content_hash("distance", self.version, original, shown, *sampling(samples))
        return self.cache.get(key, lambda: self.measure(original, shown, samples))

    def measure(self, original, shown, samples=SAMPLES):
        """The same, measured anew."""
        result = Run(self.tool, original, shown, samples).json()
        return {"rms": result["rms_pct"], "max": result["haus_pct"]}


def sampling(samples):
    """What a number of samples adds to a key of the cache."""
    return [] if samples == SAMPLES else [samples]
