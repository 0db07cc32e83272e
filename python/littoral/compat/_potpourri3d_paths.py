"""Geodesic paths with the arguments of potpourri3d, and what of it is not supported."""

from __future__ import annotations

from typing import Any

from .._arrays import Floats
from ._arguments import one_index, triangle_mesh, unsupported
from ._shortest_paths import ShortestPaths


class EdgeFlipGeodesicSolver:
    """Shortest paths on a triangle mesh. V: vertices x 3. F: faces x 3. t_coef has no effect.

    Paths come from exact distances, not from edge flips, which find a path that is as short as
    those beside it, but perhaps not the shortest.

    >>> from littoral.examples import square
    >>> paths = EdgeFlipGeodesicSolver(square(2).points, square(2).faces)
    >>> paths.find_geodesic_path(0, 8).round(6).tolist()
    [[0.0, 0.0, 0.0], [0.5, 0.5, 0.0], [1.0, 1.0, 0.0]]
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        self._paths = ShortestPaths(triangle_mesh(V, F))

    def find_geodesic_path(
        self,
        v_start: int,
        v_end: int,
        max_iterations: int | None = None,
        max_relative_length_decrease: float | None = None,
    ) -> Floats:
        """A shortest path between vertices: nodes x 3 [length]; none where there is no path.

        The limits have no effect: no path is made shorter step by step.
        """
        n = self._paths.mesh.n_vertices
        start = one_index(v_start, n, "v_start", "vertices")
        return self._paths.trace(start, one_index(v_end, n, "v_end", "vertices"))[::-1].copy()

    def find_geodesic_path_poly(
        self, v_list: Any, max_iterations: Any = None, max_relative_length_decrease: Any = None
    ) -> Floats:
        """Not supported: raises UnsupportedError."""
        unsupported(
            "shortening of a given path",
            "use find_geodesic_path for the shortest one, or potpourri3d itself",
        )

    def find_geodesic_loop(
        self, v_list: Any, max_iterations: Any = None, max_relative_length_decrease: Any = None
    ) -> Floats:
        """Not supported: raises UnsupportedError."""
        unsupported("geodesic loops", "potpourri3d itself has them")


class GeodesicTracer:
    """Not supported: raises UnsupportedError."""

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        unsupported(
            "geodesics from a point in a direction",
            "trace between two vertices with EdgeFlipGeodesicSolver, or use potpourri3d itself",
        )


class MeshVectorHeatSolver:
    """Not supported: raises UnsupportedError."""

    def __init__(
        self, V: Any, F: Any, t_coef: float = 1.0, use_intrinsic_delaunay: bool = True
    ) -> None:
        unsupported(
            "vector heat method (tangent frames, transport of vectors, logarithmic maps)",
            "use potpourri3d itself for those, and littoral.DistanceSolver for distance",
        )


class PointCloudLocalTriangulation:
    """Not supported: raises UnsupportedError."""

    def __init__(self, P: Any, with_degeneracy_heuristic: bool = True) -> None:
        unsupported(
            "local triangulations of a cloud to look at",
            "use potpourri3d itself for those, and littoral.PointCloud for distance",
        )
