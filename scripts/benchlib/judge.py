"""Surface distances: rms and Hausdorff in percent of the original's bounding-box diagonal."""

from . import programs
from .cache import content_hash
from .programs import Run


class Judge:
    """Measures by ../shared/tools/meshdist.cpp (CGAL, independent of vsplit) when it could be built,
    else by vsplit's own distance code."""

    def __init__(self, cache):
        self.cache = cache
        self.independent = programs.MESHDIST.exists()
        self.tool = programs.MESHDIST if self.independent else programs.BENCH_DISTANCE
        self.name = "meshdist (CGAL, 200,000 points a side)" if self.independent else (
            "vsplit's own distance (200,000 points a side)")
        self.version = content_hash(programs.MESHDIST_SOURCE) if self.independent else "own 1"

    def distance(self, original, shown):
        """{"rms", "max"} of a mesh file against the original's."""
        key = content_hash("distance", self.version, original, shown)
        return self.cache.get(key, lambda: self.measure(original, shown))

    def measure(self, original, shown):
        result = Run(self.tool, original, shown).json()
        return {"rms": result["rms_pct"], "max": result["haus_pct"]}
