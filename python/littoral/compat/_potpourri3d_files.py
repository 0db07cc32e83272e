"""Reading and writing meshes and clouds with the arguments of potpourri3d."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from .._arrays import Array, Floats, as_array, floats
from .._errors import InputError, IoError
from .._files import read
from .._surfaces import Mesh, PointCloud
from ._arguments import Indices, own, unsupported

Name = str | os.PathLike[str]


def read_mesh(filename: Name) -> tuple[Floats, Indices]:
    """V vertices x 3 float64 and F faces x corners int64.

    Raises InputError where there are no faces or they have different numbers of corners.
    """
    mesh = read(filename)
    faces = mesh.faces
    if mesh.n_faces == 0:
        raise InputError(f"{os.fspath(filename)}: there are no faces")
    if isinstance(faces, list):
        raise InputError(
            f"{os.fspath(filename)}: faces have different numbers of corners; "
            "read_polygon_mesh takes those"
        )
    return own(mesh.points), faces.astype(np.int64)


def read_polygon_mesh(filename: Name) -> tuple[Floats, list[list[int]]]:
    """V vertices x 3 float64 and the faces, each a list of vertices."""
    mesh = read(filename)
    if mesh.n_faces == 0:
        raise InputError(f"{os.fspath(filename)}: there are no faces")
    return own(mesh.points), [[int(v) for v in face] for face in mesh.faces]


def read_point_cloud(filename: Name) -> Floats:
    """points x 3 float64: the points of a cloud or the vertices of a mesh."""
    return own(read(filename).points)


def write_point_cloud(V: Any, filename: Name) -> None:
    """Points x 3 by extension: .obj or .ply, and what else littoral writes clouds to."""
    PointCloud(floats(V, "V", 3)).save(filename)


def write_mesh(
    V: Any, F: Any, filename: Name, UV_coords: Any = None, UV_type: str | None = None
) -> None:
    """V vertices x 3 and F faces x corners by extension: .obj, and what else littoral writes.

    UV_type: None, "per-vertex" (UV_coords vertices x 2), "per-face" (faces x 2) or "per-corner"
    (faces * corners x 2, face after face); these three only to .obj.
    """
    mesh = Mesh(floats(V, "V", 3), F)
    if UV_type is None:
        mesh.save(filename)
        return
    faces = as_array(F, "F")
    given = floats(UV_coords, "UV_coords", 2)
    n_corners = faces.size
    numbers = {
        "per-vertex": (mesh.n_vertices, faces),
        "per-face": (len(faces), np.repeat(np.arange(len(faces)), faces.shape[1])),
        "per-corner": (n_corners, np.arange(n_corners)),
    }
    if UV_type not in numbers:
        raise InputError(
            f"UV_type: expected None, 'per-vertex', 'per-face' or 'per-corner', got {UV_type!r}"
        )
    expected, corner_uv = numbers[UV_type]
    if len(given) != expected:
        raise InputError(f"UV_coords: expected {expected} rows ({UV_type}), got {len(given)}")
    if Path(filename).suffix.lower() != ".obj":
        unsupported(
            "texture coordinates but in .obj files", "write an .obj, or leave out UV_coords"
        )
    _write_obj(Path(filename), mesh.points, faces, given, corner_uv.reshape(faces.shape))


def _write_obj(path: Path, V: Floats, F: Array, UV: Floats, corner_uv: Array) -> None:
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in V.tolist()]
    lines += [f"vt {u!r} {v!r}" for u, v in UV.tolist()]
    for face, uvs in zip((F + 1).tolist(), (corner_uv + 1).tolist(), strict=True):
        corners = (f"{v}/{t}" for v, t in zip(face, uvs, strict=True) if v > 0)
        lines.append("f " + " ".join(corners))
    try:
        path.write_text("\n".join(lines) + "\n", encoding="ascii")
    except OSError as error:
        raise IoError(f"{path}: {error.strerror}") from error
