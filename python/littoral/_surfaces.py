"""Surfaces: triangle and polygon meshes, point clouds, boundaries of voxels."""

from __future__ import annotations

import itertools
import os
from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np

from . import _core
from ._arguments import number, path_to_write
from ._arrays import (
    Array,
    Floats,
    Ints,
    as_array,
    check_range,
    floats,
    ints,
    like,
    narrowed,
    result_type,
)
from ._errors import ArgumentError, InputError, UnsupportedError
from ._sources import point_arrays

S = TypeVar("S", bound="Surface")


class Surface:
    """What all surfaces have; make one of `Mesh`, `Polygons`, `PointCloud` or `Voxels`.

    Immutable. Nothing is merged, dropped or repaired: nonmanifold edges, boundaries, several
    components, inconsistent orientation and degenerate faces are all allowed. The library keeps one
    copy of the coordinates (float64) and indices (int32).

    >>> import littoral
    >>> square = littoral.examples.square(4)
    >>> square.kind, square.n_edges, isinstance(square, littoral.Surface)
    ('triangle mesh', 56, True)
    """

    _handle: _core.Mesh
    _dtype: Any = np.float64

    def __init__(self) -> None:
        raise ArgumentError("make a Mesh, Polygons, PointCloud or Voxels")

    @classmethod
    def _of(cls: type[S], core: _core.Mesh, dtype: Any = np.float64) -> S:
        self = cls.__new__(cls)
        self._handle = core
        self._dtype = dtype
        return self

    @property
    def kind(self) -> str:
        """ "triangle mesh", "polygon mesh", "point cloud" or "voxel surface"."""
        return self._handle.kind

    @property
    def n_vertices(self) -> int:
        """Vertices, or points of a cloud."""
        return self._handle.n_vertices

    @property
    def n_faces(self) -> int:
        """Faces; 0 of a cloud."""
        return self._handle.n_faces

    @property
    def n_edges(self) -> int:
        """Edges between vertices, however many faces share them."""
        return self._handle.n_edges

    @property
    def n_components(self) -> int:
        """Connected components; vertices without a face are none."""
        return self._handle.n_components

    @property
    def points(self) -> Floats:
        """vertices x 3, read-only, not copied [length]."""
        return self._handle.points

    @property
    def edges(self) -> Ints:
        """edges x 2, by vertex, in the order in which `SurfacePoint.edge` counts them."""
        return self._handle.edges()

    @property
    def corners(self) -> Ints:
        """The vertices of all faces one after the other, read-only, not copied."""
        return self._handle.corners

    @property
    def face_offsets(self) -> Ints:
        """faces + 1: where each face begins among the corners, read-only, not copied."""
        return self._handle.face_offsets

    @property
    def faces(self) -> Ints | list[Ints]:
        """faces x 3 or x 4 (read-only, not copied) where all have as many corners, or a list."""
        offsets, corners = self.face_offsets, self.corners
        sizes = np.diff(offsets)
        if len(sizes) == 0:
            return np.empty((0, 3), np.int32)
        if (sizes == sizes[0]).all():
            return corners.reshape(-1, int(sizes[0]))
        return [corners[a:b] for a, b in itertools.pairwise(offsets)]

    @property
    def normals(self) -> Floats:
        """vertices x 3 as they were given, or empty."""
        return self._handle.normals

    def positions(self, points: Any) -> Floats:
        """Where points of the surface lie: n x 3 [length]; IndexOutOfRange if one is not there.

        >>> import littoral
        >>> littoral.examples.square(4).positions([(0, [.5]), 24]).tolist()
        [[0.125, 0.0, 0.0], [1.0, 1.0, 0.0]]
        """
        return self._handle.positions(point_arrays(points, self, "points"))

    def interpolate(self, values: Any, points: Any) -> Floats:
        """n: a function given at the vertices, at points of the surface; linear in triangles.

        Raises InputError for values that are not one per vertex.
        """
        given = floats(values, "values", finite=False)
        if len(given) != self.n_vertices:
            raise InputError(
                f"values: expected {self.n_vertices}, one per vertex, got {len(given)}"
            )
        return self._handle.interpolate(given, point_arrays(points, self, "points"))

    def welded(self: S, distance: float = 0.0) -> S:
        """The same with one vertex for those that are close together.

        In their order, vertices no farther than `distance` [length] from one that was kept become
        that one; 0 joins those at one place. Faces with fewer than three corners left are dropped.
        Raises InputError for a distance that is negative or not finite, UnsupportedError for
        voxels, which share their vertices.

        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 0, 0], [1, 1, 0], [0, 1, 1e-9]]
        >>> soup = Mesh(corners, [[0, 1, 2], [3, 4, 5]])
        >>> soup.welded().n_vertices, soup.welded(1e-6).n_vertices
        (5, 4)
        """
        if self.kind == "voxel surface":
            raise UnsupportedError("welded: voxels share their vertices; there is nothing to weld")
        return type(self)._of(self._handle.welded(number(distance, "distance")), self._dtype)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the surface by extension: .obj .ply .off .stl .glb .3mf .vtp.

        Raises UnsupportedError for other extensions, IoError where it cannot be written.
        """
        self._handle.write(path_to_write(path))

    def _parts(self) -> tuple[Any, ...]:
        return "surface", self, {}, {}

    def __reduce__(self) -> tuple[Any, ...]:
        return _surface_from, (type(self), self._handle.soup(), np.dtype(self._dtype).str)

    def __repr__(self) -> str:
        name = type(self).__name__
        if self.n_faces == 0:
            return f"<littoral.{name}: {self.n_vertices} points>"
        return f"<littoral.{name}: {self.n_vertices} vertices, {self.n_faces} faces>"

    def _values(self, values: Array) -> Array:
        return like(values, self._dtype)


def _surface_from(cls: type[Surface], soup: tuple[Any, ...], dtype: str) -> Surface:
    return cls._of(_core.Mesh.from_soup(soup), np.dtype(dtype).type)


class Mesh(Surface):
    """A mesh of triangles or polygons.

    V: vertices x 3, real numbers [length]. F: faces x corners, integers, by vertex from 0; faces of
    fewer corners than columns end in -1. Raises ArgumentError (a TypeError), InputError (a
    ValueError) and IndexOutOfRange (an IndexError) naming the first entry that is wrong.

    >>> Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    <littoral.Mesh: 3 vertices, 1 faces>
    """

    def __init__(self, V: Any, F: Any) -> None:
        points = floats(V, "V", 3, finite=False)
        faces = as_array(F, "F")
        if faces.dtype.kind not in "iu" and faces.size:
            raise ArgumentError(f"F: expected integers (faces x corners), got {faces.dtype}")
        if faces.size == 0:
            raise InputError("F: there are no faces; PointCloud takes points alone")
        if faces.ndim != 2 or faces.shape[1] < 3:
            raise InputError(f"F: expected shape faces x 3 (or more), got {faces.shape}")
        self._dtype = result_type(V)
        if faces.shape[1] > 3 and faces.min() < 0:
            kept = faces >= 0
            ends_first = np.diff(kept.astype(np.int8), axis=1).max(axis=1, initial=0) > 0
            if (faces < -1).any() or ends_first.any():
                bad = int(np.flatnonzero((faces < -1).any(axis=1) | ends_first)[0])
                raise InputError(f"F[{bad}] is {faces[bad]}: only -1 may follow a face's corners")
            self._handle = _polygons(points, faces[kept], kept.sum(axis=1), "F")
            return
        check_range(faces, len(points), "F", "vertices")
        self._handle = _core.Mesh.of(points, narrowed(faces, "F"))


def _polygons(points: Floats, corners: Array, sizes: Any, name: str) -> _core.Mesh:
    """A mesh of faces of these sizes, whose corners stand one after the other."""
    check_range(corners, len(points), "the corners of " + name, "vertices")
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int32)
    return _core.Mesh.polygons(points, narrowed(corners, name), offsets)


class Polygons(Surface):
    """A mesh of polygons: V vertices x 3 [length], faces: a list, each a sequence of vertices.

    Raises as `Mesh`.

    >>> V = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, .5, 0]]
    >>> Polygons(V, [[0, 1, 2, 3], [1, 4, 2]])
    <littoral.Polygons: 5 vertices, 2 faces>
    """

    def __init__(self, V: Any, faces: Sequence[Any]) -> None:
        points = floats(V, "V", 3, finite=False)
        if not hasattr(faces, "__len__"):
            raise ArgumentError(f"faces: expected a list of faces, got {faces!r}")
        if len(faces) == 0:
            raise InputError("faces: there are none; PointCloud takes points alone")
        rows = [ints(face, f"faces[{f}]") for f, face in enumerate(faces)]
        sizes = [len(row) for row in rows]
        self._handle = _polygons(points, np.concatenate(rows), sizes, "faces")
        self._dtype = result_type(V)


class PointCloud(Surface):
    """A point cloud: P points x 3 [length], and N normals x 3 or none (need not be of unit length).

    On surfaces, normals are estimated where they are needed and not given. Raises ArgumentError for
    what is no numbers, InputError for other shapes and points that are not finite.

    >>> PointCloud([[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    <littoral.PointCloud: 3 points>
    """

    def __init__(self, P: Any, N: Any = None) -> None:
        points = floats(P, "P", 3)
        normals = np.empty((0, 3)) if N is None else floats(N, "N", 3)
        if N is not None and len(normals) != len(points):
            raise InputError(
                f"N: expected one normal per point ({len(points)}), got {len(normals)}"
            )
        if len(points) == 0:
            raise InputError("P: there are no points")
        self._handle = _core.Mesh.cloud(points, normals)
        self._dtype = result_type(P)


class Voxels(Surface):
    """The boundary of the voxels that are not 0, with normals that do not know about the grid.

    inside: nx x ny x nz. The centre of voxel i, j, k lies at origin + (i, j, k) * spacing [length].
    Outside the array is 0. Raises InputError for another shape, for numbers that are not finite and
    for spacings that are not positive.

    >>> import numpy as np
    >>> Voxels(np.pad(np.ones((2, 2, 2), bool), 1)).n_faces
    24
    """

    def __init__(
        self,
        inside: Any,
        spacing: float | Sequence[float] = 1.0,
        origin: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None:
        values = as_array(inside, "inside")
        if values.ndim != 3 or values.dtype.kind not in "biuf":
            raise InputError(
                f"inside: expected nx x ny x nz numbers, got {values.dtype} {values.shape}"
            )
        if not np.isfinite(values).all():  # neither inside nor outside
            i, j, k = np.argwhere(~np.isfinite(values))[0]
            raise InputError(f"inside[{i}, {j}, {k}] is {values[i, j, k]}: expected finite numbers")
        self._inside = np.asarray(values != 0)
        self._spacing = spacings(spacing)
        self._origin = triple(origin, "origin")
        grid = _core.Grid(self._inside.shape, self._origin, self._spacing)
        x_first = self._inside.ravel(order="F").astype(np.uint8)
        self._handle = _core.Mesh.voxels(grid, x_first)

    def __reduce__(self) -> tuple[Any, ...]:
        return Voxels, (self._inside, self._spacing, self._origin)


def spacings(value: Any) -> tuple[float, float, float]:
    """Of a grid: one for all axes, or one for each; InputError unless all are positive."""
    steps = triple(value, "spacing")
    if not min(steps) > 0:
        raise InputError(f"spacing: expected positive lengths, got {steps}")
    return steps


def triple(value: Any, name: str) -> tuple[float, float, float]:
    """One number for all axes, or one for each."""
    numbers = np.atleast_1d(floats(np.atleast_1d(as_array(value, name)), name))
    if numbers.size == 1:
        numbers = np.repeat(numbers, 3)
    if numbers.shape != (3,):
        raise InputError(f"{name}: expected one number or three, got {numbers.size}")
    return float(numbers[0]), float(numbers[1]), float(numbers[2])
