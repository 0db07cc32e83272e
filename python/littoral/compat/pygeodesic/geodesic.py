"""pygeodesic.geodesic's names and arguments (release 0.1.11), computed by littoral.

Distances are exact along the triangles [length]. Different from pygeodesic: bad arguments raise
TypeError, ValueError or IndexError, where it prints a sentence and returns None; vertices need not
all belong to faces; paths may pass vertices at which parts of the surface touch; a target that no
source reaches is at distance infinity, has an empty path and the best source -1, where it gives 0
and a number without meaning. What littoral has doubts about is a RuntimeWarning.
"""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from ..._arguments import number
from ..._arrays import Floats, Ints, floats
from ..._errors import InputError, IoError
from .._arguments import Indices, indices, one_index, own, triangle_mesh
from .._shortest_paths import ShortestPaths

__all__ = ["PyGeodesicAlgorithmExact", "read_mesh_from_file"]


class PyGeodesicAlgorithmExact:
    """Exact distances and shortest paths. _points: vertices x 3. _faces: faces x 3.

    >>> from littoral.examples import square
    >>> geodesics = PyGeodesicAlgorithmExact(square(2).points, square(2).faces)
    >>> length, path = geodesics.geodesicDistance(0, 8)
    >>> round(length, 6), path[0].tolist()
    (1.414214, [1.0, 1.0, 0.0])
    """

    def __init__(self, _points: Any, _faces: Any) -> None:
        self._paths = ShortestPaths(triangle_mesh(_points, _faces))

    def geodesicDistance(self, sourceIndex: int, targetIndex: int) -> tuple[float, Floats]:
        """The distance between two vertices and a shortest path from target to source.

        The path is nodes x 3: the target, one node for each edge or vertex it crosses, the source.
        Raises SolveError where no path of that length is found.
        """
        n = self._paths.mesh.n_vertices
        source = one_index(sourceIndex, n, "sourceIndex", "vertices")
        target = one_index(targetIndex, n, "targetIndex", "vertices")
        length = float(self._paths.distance(source)[target])
        return length, self._paths.trace(source, target)

    def geodesicDistances(
        self,
        source_indices: Any = None,
        target_indices: Any = None,
        max_distance: float = np.inf,
    ) -> tuple[Floats, Ints]:
        """The distance of each target to the nearest source, and which that is.

        source_indices: vertices, vertex 0 where None; target_indices: vertices, all where None.
        Returns distances, float64, and positions in source_indices, int32, each one a target.
        Targets farther than max_distance are at infinity, with source -1. One solve a source.
        """
        n = self._paths.mesh.n_vertices
        sources = (
            np.zeros(1, np.int32)
            if source_indices is None
            else indices(_flat(source_indices, "source_indices"), n, "source_indices", "vertices")
        )
        limit = number(max_distance, "max_distance")
        if not limit >= 0:
            raise InputError(f"max_distance: expected a number of at least 0, got {limit}")
        best = np.full(n, -1, np.int32)
        nearest = np.full(n, np.inf)
        for i, source in enumerate(sources.tolist()):
            d = self._paths.distance(source)
            closer = (d < nearest) & (d <= limit)
            best[closer] = i
            nearest[closer] = d[closer]
        if target_indices is None:
            return nearest, best
        targets = indices(_flat(target_indices, "target_indices"), n, "target_indices", "vertices")
        return own(nearest[targets]), best[targets].copy()


def _flat(value: Any, name: str) -> Any:
    if np.ndim(value) != 1:
        raise InputError(f"{name}: expected a list of vertices, got {np.ndim(value)} dimensions")
    return value


def read_mesh_from_file(filename: str | os.PathLike[str]) -> tuple[Floats, Indices]:
    """Points x 3 and faces x 3 of a text: a line with both numbers, the points, the faces.

    Raises InputError and IoError.
    """
    try:
        with open(filename, encoding="utf-8") as file:
            rows = [line.split() for line in file]
    except OSError as error:
        raise IoError(f"{os.fspath(filename)}: {error.strerror}") from error
    try:
        n_points, n_faces = (int(word) for word in rows[0])
        points = np.array([[float(w) for w in row] for row in rows[1 : n_points + 1]])
        faces = np.array(
            [[int(w) for w in row] for row in rows[n_points + 1 : n_points + 1 + n_faces]],
            dtype=np.int64,
        )
    except (IndexError, ValueError) as error:
        raise InputError(
            f"{os.fspath(filename)}: expected the numbers of points and faces, then these ({error})"
        ) from error
    if points.shape != (n_points, 3) or faces.shape != (n_faces, 3):
        raise InputError(
            f"{os.fspath(filename)}: expected {n_points} points and {n_faces} triangles, "
            f"got {points.shape} and {faces.shape}"
        )
    return floats(points, "points", 3), faces
