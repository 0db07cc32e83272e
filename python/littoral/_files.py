"""Reading files: littoral's own formats, and those of meshio and trimesh where installed."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from . import _core
from ._arguments import path_of
from ._errors import InputError
from ._foreign import as_surface
from ._surfaces import Mesh, PointCloud, Polygons, Surface
from ._tets import TetMesh
from ._volumes import Volume


def _of_kind(core: _core.Mesh) -> Surface:
    kinds: dict[str, type[Surface]] = {"point cloud": PointCloud, "polygon mesh": Polygons}
    if core.kind == "voxel surface":
        return Surface._of(core)
    return kinds.get(core.kind, Mesh)._of(core)


def read(path: str | os.PathLike[str]) -> Surface:
    """A mesh or cloud from a file.

    Formats that littoral does not know are read by meshio or trimesh where these are installed
    (Abaqus, Nastran, ...). Raises InputError naming file and line, IoError.

    >>> import tempfile, littoral
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     littoral.examples.cube().save(f"{folder}/cube.obj")
    ...     littoral.read(f"{folder}/cube.obj")
    <littoral.Mesh: 8 vertices, 12 faces>
    """
    name = path_of(path)
    try:
        return _of_kind(_core.read_mesh(name))
    except InputError as error:
        if Path(name).suffix.lower() in _known_extensions() or not Path(name).is_file():
            raise
        other = _read_elsewhere(name)
        if other is None:
            raise InputError(
                f"{error}; meshio and trimesh read more formats, and neither could read this"
            ) from error
        return other


def _known_extensions() -> frozenset[str]:
    return frozenset(_core.mesh_extensions().split())


def _read_elsewhere(name: str) -> Surface | None:
    for library in ("trimesh", "meshio"):
        try:
            module: Any = __import__(library)
        except ImportError:
            continue
        try:
            read_file = module.load if library == "trimesh" else module.read
            surface = as_surface(read_file(name))
        except (Exception, SystemExit):  # whatever these raise, the other one may read it
            continue
        return surface
    return None


def read_volume(path: str | os.PathLike[str]) -> Volume:
    """A volume from a file (.vti .nrrd .npy ...). Raises InputError and IoError as `read`.

    >>> import tempfile, numpy as np, littoral
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     littoral.Volume(np.zeros((2, 3, 4)), spacing=.5).save(f"{folder}/values.nrrd")
    ...     littoral.read_volume(f"{folder}/values.nrrd")
    <littoral.Volume: 2 x 3 x 4 nodes>
    """
    return Volume._of(_core.read_volume(path_of(path)))


def read_tets(path: str | os.PathLike[str]) -> TetMesh:
    """A tet mesh from a file (.mesh .vtk .vtu .msh ...). Raises InputError and IoError as `read`.

    >>> import pathlib, tempfile, littoral
    >>> text = "4 vertices\\n1 tets\\n0 0 0\\n1 0 0\\n0 1 0\\n0 0 1\\n4 0 1 2 3\\n"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "one.tet")
    ...     size = path.write_text(text)
    ...     littoral.read_tets(path)
    <littoral.TetMesh: 4 vertices, 1 tets>
    """
    return TetMesh._of(_core.read_tets(path_of(path)))


def read_sources(path: str | os.PathLike[str], mesh: Any) -> _core.Sources:
    """Curves and points on a mesh from a file, for `distance(mesh, curves=...)`.

    docs/reference/curves.md describes the formats (.txt .obj .ply .json).
    mesh: what `as_surface` takes.
    Raises InputError naming file and line, IoError.

    >>> import pathlib, tempfile, littoral
    >>> square = littoral.examples.square(4)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "curve.txt")
    ...     size = path.write_text("signed_curve\\nv 2\\nv 7\\nv 12\\nv 17\\nv 22\\n")
    ...     curves = littoral.read_sources(path, square)
    >>> littoral.distance(square, curves).values[:2].tolist()
    [0.5, 0.25]
    """
    return _core.read_sources(path_of(path), as_surface(mesh)._handle)
