"""What the modules for trimesh, Open3D and mesh_to_sdf share: a surface prepared for nearness."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
import numpy.typing as npt

from .._arrays import Array, Floats
from .._errors import InputError
from .._foreign import as_surface
from .._space import SDF
from .._surfaces import Surface


class Nearest:
    """Distance to the faces themselves, and inside where the winding number is beyond 1/2.

    Either way round: a closed surface whose normals all point inward has the same inside.
    """

    def __init__(self, mesh: Any) -> None:
        self.surface: Surface = as_surface(mesh)
        if self.surface.n_faces == 0:
            raise InputError("mesh: expected faces, got points alone")
        self.sdf = SDF(self.surface, method="winding")

    def inside(self, points: Array, threads: int | None = None) -> npt.NDArray[np.bool_]:
        """n: whether points (n x 3) are inside."""
        return np.abs(self.sdf.winding_number(points, threads=threads)) > 0.5

    def signed(self, points: Array, threads: int | None = None) -> Array:
        """n: distance, negative inside [length]."""
        values = np.abs(self.sdf(points, threads=threads))
        return np.where(self.inside(points, threads), -values, values)

    def unsigned(self, points: Array, threads: int | None = None) -> Array:
        """n: distance to the faces [length]."""
        return np.abs(self.sdf(points, threads=threads))


class _Content:
    """A surface that is equal to others of the same vertices and faces."""

    def __init__(self, surface: Surface) -> None:
        self.surface = surface
        self._hash = hash((surface.points.tobytes(), surface.corners.tobytes()))

    def __hash__(self) -> int:
        return self._hash

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Content) and all(
            np.array_equal(getattr(self.surface, name), getattr(other.surface, name))
            for name in ("points", "corners", "face_offsets")
        )


@lru_cache(maxsize=4)
def _of_content(content: _Content) -> Nearest:
    return Nearest(content.surface)


def prepared(mesh: Any) -> Nearest:
    """What was made for a mesh of the same vertices and faces before, of the last four."""
    return _of_content(_Content(as_surface(mesh)))


def face_normals(surface: Surface, faces: Array) -> Floats:
    """n x 3: unit normals of faces by number at their first corners; 0 without an area."""
    corners = surface.corners[surface.face_offsets[faces][:, None] + np.arange(3)]
    a, b, c = (surface.points[corners[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    out: Floats = normals / np.where(lengths > 0, lengths, 1)
    return out
