"""What scripts/bench --paper measures: streams, rules, methods, regions."""

import dataclasses
import math
import pathlib
import struct

from . import paper_programs as run
from .programs import note

# Shares of the vertices that the simplified levels keep, in percent.
LEVELS = (50, 25, 10)

# Metrics of whole streams: the paper's Tables I to IV compare the first two.
STREAM_METRICS = {
    "curvature": "curvature (default)",
    "normal": "normals (\"vector-based\")",
    "quadrics": "the same quadrics, no curvature",
    "qem": "accumulated quadrics",
    "paper": "curvature as the order (the paper's rule)",
}

# Methods at equal faces: what the tables call them, and what runs.
METHODS = {
    "vsplit-curvature": "vsplit: quadrics × curvature",
    "vsplit-quadrics": "vsplit: the same without curvature",
    "vsplit-qem": "vsplit: accumulated quadrics (Garland, Heckbert)",
    "vsplit-normal": "vsplit: normals (\"vector-based\")",
    "vsplit-edge-length": "vsplit: edge length",
    "vsplit-paper": "vsplit: the paper's rule",
    "vtk-decimate-pro": "vertex decimation (Schroeder; VTK)",
    "grid-clustering": "grid clustering by importance (Rossignac, Borrel; ours)",
    "floating-cells": "floating cells (Low, Tan; ours)",
    "vtk-clustering": "quadric clustering (Lindstrom; VTK)",
    "meshopt-sloppy": "quadric clustering (meshopt_simplifySloppy)",
    "energy": "edge collapse by energy (Hoppe; ours)",
    "lindstrom-turk": "edge collapse, memoryless (Lindstrom, Turk; CGAL)",
    "openmesh": "quadrics, half-edges (Garland, Heckbert; OpenMesh)",
    "vtk-quadrics": "quadrics, best place (Garland, Heckbert; VTK)",
    "meshopt": "quadrics, half-edges (meshopt_simplify)",
}

# Rules whose order alone differs, for the question where curvature helps.
RULES = ["vsplit-curvature", "vsplit-quadrics", "vsplit-normal", "vsplit-paper"]
RULE_MODELS = ["cow", "bones", "homer", "gargoyle-20k", "lucy-5k", "fandisk", "rocker-arm", "casting",
               "stanford-bunny"]
REGION_SHARE = 0.1


@dataclasses.dataclass
class Model:
    """A mesh, repaired and written as PLY, which every tool reads."""

    name: str
    path: pathlib.Path
    vertices: int
    faces: int
    boundary: bool


def prepare(source, folder):
    """Encodes a mesh once to learn what it is, and writes its repaired form into `folder`."""
    name = source.stem
    path = folder / f"{name}-original.ply"
    report = run.encode(source, folder / f"{name}.vsplit")
    run.simplify("vsplit-qem", source, path, report["faces"])
    return Model(name, path, report["vertices"], report["faces"],
                 report["input"]["boundary_edges"] > 0)


def level_vertices(model):
    return [model.vertices * share // 100 for share in LEVELS]


def plain_bytes(vertices, faces):
    """What GPU-ready arrays take: three floats a vertex, three indices of 16 bits (32 if they must)."""
    return 12 * vertices + (6 if vertices <= 65536 else 12) * faces


def measure_streams(model, folder, judge):
    """Rows of Tables I to IV and their neighbours: for every metric the whole stream and three levels."""
    rows, meshes = [], []
    for metric in STREAM_METRICS:
        stream = folder / f"{model.name}-{metric}.vsplit"
        wanted = level_vertices(model)
        report = run.encode(model.path, stream, "--metric", metric, "--level-vertices",
                            ",".join(map(str, wanted)))
        by_vertices = {level["vertices"]: level for level in report["levels"]}
        for vertices in [report["vertices"], *wanted]:
            level = by_vertices.get(vertices)
            if level is None:
                raise run.programs.Failed(
                    f"{model.name}, {metric}: there is no level of {vertices} vertices")
            mesh = folder / f"{model.name}-{metric}-{vertices}.ply"
            run.decode(stream, mesh, level["level"])
            meshes.append(mesh)
            rows.append({
                "model": model.name, "metric": metric, "vertices": vertices, "faces": level["faces"],
                "stream_bytes": level["cumulative_bytes"],
                "plain_bytes": plain_bytes(vertices, level["faces"]), "mesh": mesh,
            })
    rates = run.frame_rates(model.path, meshes)
    for row, rate, distance in zip(rows, rates, judge.distances(model.path, meshes)):
        row.update(frames_per_second=rate, rms=distance["rms"], max=distance["max"],
                   normals=distance["normals"])
    return rows


def faces_of(model, share):
    """Faces that methods are asked for."""
    return model.faces * share // 100


def measure_methods(model, methods, folder, judge):
    """One row for every method and share, all at (about) the same number of faces."""
    rows, meshes = [], []
    for share in LEVELS:
        for method in methods:
            mesh = folder / f"{model.name}-{share}-{method}.ply"
            try:
                run.simplify(method, model.path, mesh, faces_of(model, share))
            except run.programs.Failed as failure:
                note(f"{model.name}, {method}: {failure}")
                continue
            meshes.append(mesh)
            rows.append({"model": model.name, "share": share, "method": method,
                         "wanted_faces": faces_of(model, share), "mesh": mesh})
    for row, distance in zip(rows, judge.distances(model.path, meshes)):
        row.update({key: distance[key] for key in ("vertices", "faces", "rms", "max", "normals")})
    return rows


def read_points(path):
    """Vertices of a binary PLY with coordinates as double or float, as vsplit writes it."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    header = data[:end].decode()
    count = int(header.split("element vertex ")[1].split()[0])
    form = "<3d" if "property double x" in header else "<3f"
    size = struct.calcsize(form)
    return [struct.unpack_from(form, data, end + i * size) for i in range(count)]


def end_ball(points):
    """A ball around the last vertex of the longest axis that holds a tenth of the vertices."""
    extents = [max(p[k] for p in points) - min(p[k] for p in points) for k in range(3)]
    axis = extents.index(max(extents))
    centre = max(points, key=lambda point: point[axis])
    distances = sorted(math.dist(point, centre) for point in points)
    return [*centre, distances[int(REGION_SHARE * len(points))]]


def measure_regions(model, folder):
    """Rows with and without a region that is to be kept, at the same numbers of vertices."""
    points = read_points(model.path)
    ball = end_ball(points)
    text = ",".join(f"{value:.9g}" for value in ball)
    rows = []
    for kept in (False, True):
        stream = folder / f"{model.name}-region-{kept}.vsplit"
        wanted = level_vertices(model)
        options = ["--keep-region", text] if kept else []
        report = run.encode(model.path, stream, "--level-vertices", ",".join(map(str, wanted)),
                            *options)
        by_vertices = {level["vertices"]: level for level in report["levels"]}
        levels = [by_vertices[vertices] for vertices in [*wanted, report["vertices"]]
                  if vertices in by_vertices]
        meshes = []
        for level in levels:
            meshes.append(folder / f"{model.name}-region-{kept}-{level['vertices']}.ply")
            run.decode(stream, meshes[-1], level["level"])
        found = run.region_distances(text, model.path, meshes)
        for level, row, mesh in zip(levels, found, meshes):
            rows.append({"model": model.name, "kept": kept, "vertices": level["vertices"],
                         "faces": level["faces"], "stream_bytes": level["cumulative_bytes"],
                         "vertices_inside": row["vertices_inside"], "inside": row["inside_pct"],
                         "outside": row["outside_pct"], "rms": row["rms_pct"], "mesh": mesh})
    return rows
