#!/usr/bin/python3
"""Simplifies a PLY mesh to so many faces by a filter of VTK.
usage: paper_vtk.py vtk-decimate-pro|vtk-quadrics|vtk-clustering IN.ply OUT.ply FACES"""

import sys

from vtkmodules.vtkFiltersCore import vtkDecimatePro, vtkQuadricClustering, vtkQuadricDecimation
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter


def read(path):
    reader = vtkPLYReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def run(algorithm, mesh):
    algorithm.SetInputData(mesh)
    algorithm.Update()
    return algorithm.GetOutput()


def decimate_pro(mesh, faces):
    """Schroeder, Zarge, Lorensen, "Decimation of Triangle Meshes", 1992: topology kept, the least
    feature angle that gets as far as it is to."""
    for angle in (15, 30, 60, 90, 180):
        algorithm = vtkDecimatePro()
        algorithm.PreserveTopologyOn()
        algorithm.SplittingOff()
        algorithm.SetFeatureAngle(angle)
        algorithm.SetTargetReduction(1.0 - faces / mesh.GetNumberOfPolys())
        result = run(algorithm, mesh)
        if result.GetNumberOfPolys() <= faces:
            break
    return result


def quadrics(mesh, faces):
    """Garland, Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997."""
    algorithm = vtkQuadricDecimation()
    algorithm.SetTargetReduction(1.0 - faces / mesh.GetNumberOfPolys())
    return run(algorithm, mesh)


def clustering(mesh, faces):
    """Lindstrom, "Out-of-Core Simplification of Large Polygonal Models", 2000: the finest grid of cubes
    that leaves at most `faces`."""
    low, high = 1, 400
    best = None
    bounds = mesh.GetBounds()
    sides = [bounds[2 * k + 1] - bounds[2 * k] for k in range(3)]
    while low <= high:
        cells = (low + high) // 2
        algorithm = vtkQuadricClustering()
        algorithm.AutoAdjustNumberOfDivisionsOff()
        algorithm.SetNumberOfDivisions(*(max(1, round(cells * side / max(sides))) for side in sides))
        result = run(algorithm, mesh)
        if result.GetNumberOfPolys() <= faces:
            best, low = result, cells + 1
        else:
            high = cells - 1
    return best


METHODS = {"vtk-decimate-pro": decimate_pro, "vtk-quadrics": quadrics, "vtk-clustering": clustering}


def main():
    method, source, target, faces = sys.argv[1:]
    writer = vtkPLYWriter()
    writer.SetFileName(target)
    writer.SetInputData(METHODS[method](read(source), int(faces)))
    return 0 if writer.Write() == 1 else 1


sys.exit(main())
