"""The meshes that are measured."""

import os
import pathlib

from .programs import ROOT

SET_S = [
    "cow", "bones", "homer", "gargoyle-20k", "lucy-5k", "stanford-bunny", "horse", "dragon-100k",
    "skull", "hand-34k", "fandisk", "rocker-arm", "casting", "thingi-73416", "camelhead", "face-52k",
    "three-peaks",
]
EXTENSIONS = (".ply", ".obj", ".off", ".stl")


def models_folder(named):
    """The folder that was named, or $VSPLIT_MODELS, or ../shared/models, or assets/."""
    named = named or os.environ.get("VSPLIT_MODELS")
    folder = pathlib.Path(named) if named else ROOT.parent / "shared/models"
    return folder if named or folder.is_dir() else ROOT / "assets"


def find_model(folder, name):
    """The file of a model, or None."""
    paths = (folder / (name + extension) for extension in EXTENSIONS)
    return next((path for path in paths if path.exists()), None)


def find_models(folder, only=None):
    """The set S (or the named models) as far as the folder has it, and the names it lacks; every mesh
    of a folder that has none of S."""
    names = only or SET_S
    found = [path for path in (find_model(folder, name) for name in names) if path]
    if not found and not only:
        found = sorted(path for path in folder.iterdir() if path.suffix in EXTENSIONS)
        return found, []
    return found, [name for name in names if not find_model(folder, name)]
