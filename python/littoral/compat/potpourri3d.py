"""potpourri3d's names and arguments (release 1.4), computed by littoral.

    import littoral.compat.potpourri3d as pp3d

Lengths are in the unit of the input; results are float64, one value a vertex. As in potpourri3d,
diffusion times are t = t_coef h^2: h is the mean edge length, half of it for the signed heat method
on triangle meshes. Signs follow potpourri3d, which has two conventions: distances of
`MeshSignedHeatSolver` are positive to the left of a curve, seen along it with normals up, those of
`MeshFastMarchingDistanceSolver`, `PolygonMeshHeatSolver` and `PointCloudHeatSolver` to the right.

Different from potpourri3d: meshes may be nonmanifold and inconsistently oriented for all methods;
nodes that follow each other on a curve need not share a face; points and unsigned curves may lie
anywhere; distances between components are infinite; a bad index, shape or word raises IndexError,
TypeError or ValueError. Several points are sources of the most accurate kind, not one sum of radial
vectors. What littoral has doubts about is a RuntimeWarning, what it does not compute raises
`littoral.UnsupportedError`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from .._arguments import number
from .._arrays import Floats, as_array, floats
from .._distance import DistanceSolver
from .._errors import ArgumentError, InputError
from .._sources import Curve
from .._surfaces import Mesh, PointCloud, Polygons, Surface
from ._arguments import (
    answer,
    indices,
    one_index,
    own,
    positive,
    surface_curves,
    surface_point,
    triangle_mesh,
    unsupported,
    vertex_curves,
)
from ._marching_triangles import level_lines
from ._potpourri3d_checks import validate_mesh, validate_points
from ._potpourri3d_files import (
    read_mesh,
    read_point_cloud,
    read_polygon_mesh,
    write_mesh,
    write_point_cloud,
)
from ._potpourri3d_matrices import cotan_laplacian, edges, face_areas, vertex_areas
from ._potpourri3d_paths import (
    EdgeFlipGeodesicSolver,
    GeodesicTracer,
    MeshVectorHeatSolver,
    PointCloudLocalTriangulation,
)

__all__ = [
    "EdgeFlipGeodesicSolver",
    "GeodesicTracer",
    "MeshFastMarchingDistanceSolver",
    "MeshHeatMethodDistanceSolver",
    "MeshMarchingTrianglesSolver",
    "MeshSignedHeatSolver",
    "MeshVectorHeatSolver",
    "PointCloudHeatSolver",
    "PointCloudLocalTriangulation",
    "PolygonMeshHeatSolver",
    "compute_distance",
    "compute_distance_multisource",
    "cotan_laplacian",
    "edges",
    "face_areas",
    "marching_triangles",
    "read_mesh",
    "read_point_cloud",
    "read_polygon_mesh",
    "validate_mesh",
    "validate_points",
    "vertex_areas",
    "write_mesh",
    "write_point_cloud",
]

_EXTEND = ("extension of scalars", "find nearest sources with littoral.distance_matrix")
_FRAMES = ("tangent frames", "potpourri3d itself has them")
_TRANSPORT = ("transport of tangent vectors", "potpourri3d itself has it")
_LOG_MAP = ("logarithmic map", "potpourri3d itself has one")

_NO_MATTER = "no normals"  # unsigned distance on a cloud does not depend on their directions
_CONSTRAINTS = {"none": "none", "zeroset": "zero_set", "multiple": "level_sets"}


def _constraint(name: str) -> str:
    """littoral's word for "ZeroSet", "None" or "Multiple", in letters of either case."""
    if not isinstance(name, str):
        raise ArgumentError(f"level_set_constraint: expected a word, got {name!r}")
    if name.lower() not in _CONSTRAINTS:
        raise InputError(
            f"level_set_constraint: expected 'ZeroSet', 'None' or 'Multiple', got {name!r}"
        )
    return _CONSTRAINTS[name.lower()]


class _Solvers:
    """Solvers of one method on one surface, one for each set of options, prepared once."""

    def __init__(self, surface: Surface, method: str, t_coef: float | None = None) -> None:
        self.surface = surface
        self._method = method
        self._time: dict[str, Any] = {}
        if t_coef is not None:
            self._time["time_scale"] = positive(t_coef, "t_coef")
        self._made: dict[tuple[tuple[str, Any], ...], DistanceSolver] = {}

    def __call__(self, **options: Any) -> DistanceSolver:
        key = tuple(sorted(options.items()))
        if key not in self._made:
            self._made[key] = DistanceSolver(self.surface, self._method, **self._time, **options)
        return self._made[key]

    def from_one(self, source: Any, name: str, of: str, **options: Any) -> Floats:
        index = one_index(source, self.surface.n_vertices, name, of)
        return answer(self(**options).solve(points=[index]), _NO_MATTER)

    def from_many(self, sources: Any, name: str, of: str, **options: Any) -> Floats:
        given = indices(sources, self.surface.n_vertices, name, of)
        return answer(self(**options).solve(points=given), _NO_MATTER)


class MeshHeatMethodDistanceSolver:
    """Unsigned distance to vertices by the heat method.

    V: vertices x 3. F: faces x 3. use_robust: on an intrinsic Delaunay triangulation.

    >>> from littoral.examples import sphere
    >>> d = MeshHeatMethodDistanceSolver(sphere().points, sphere().faces).compute_distance(0)
    >>> d.shape, bool(abs(d.max() - 3.14) < .1)
    ((642,), True)
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0, use_robust: bool = True) -> None:
        self._solvers = _Solvers(triangle_mesh(V, F), "unsigned-heat", t_coef)
        self._options = {"intrinsic_delaunay": bool(use_robust)}
        self._solvers(**self._options)

    def compute_distance(self, v_ind: int) -> Floats:
        """Distance to a vertex, at all vertices."""
        return self._solvers.from_one(v_ind, "v_ind", "vertices", **self._options)

    def compute_distance_multisource(self, v_inds: Any) -> Floats:
        """Distance to the nearest of several vertices, at all vertices."""
        return self._solvers.from_many(v_inds, "v_inds", "vertices", **self._options)


def compute_distance(V: Any, F: Any, v_ind: int) -> Floats:
    """Distance to a vertex by `MeshHeatMethodDistanceSolver`."""
    return MeshHeatMethodDistanceSolver(V, F).compute_distance(v_ind)


def compute_distance_multisource(V: Any, F: Any, v_inds: Any) -> Floats:
    """Distance to the nearest of several vertices by `MeshHeatMethodDistanceSolver`."""
    return MeshHeatMethodDistanceSolver(V, F).compute_distance_multisource(v_inds)


class MeshFastMarchingDistanceSolver:
    """Distance by fast marching. V: vertices x 3. F: faces x 3.

    >>> from littoral.examples import square
    >>> solver = MeshFastMarchingDistanceSolver(square(4).points, square(4).faces)
    >>> solver.compute_distance([[(0, [])]]).round(6)[:3].tolist()
    [0.0, 0.25, 0.5]
    """

    def __init__(self, V: Any, F: Any) -> None:
        self._mesh = triangle_mesh(V, F)
        self._solver = DistanceSolver(self._mesh, "fast-marching")

    def compute_distance(
        self, curves: Any, distances: Sequence[Sequence[float]] = (), sign: bool = False
    ) -> Floats:
        """Distance at all vertices.

        curves: lists of (element, barycentric): none for a vertex, t for an edge, two or three
        numbers for a face. Without sign, distance to their nodes alone, each beginning at its entry
        of `distances`; with sign, to the curves, positive to their right, where `distances` must be
        the same number for all nodes. Missing ones are 0.
        """
        nodes = surface_curves(curves)
        starts = [np.zeros(len(curve)) for curve in nodes]
        for i, (start, given) in enumerate(zip(starts, distances, strict=False)):
            row = floats(given, f"distances[{i}]")[: len(start)]
            start[: len(row)] = row
        levels = np.unique(np.concatenate([*starts, np.empty(0)]))
        if sign:
            if len(levels) > 1:
                unsupported(
                    "signed distance that begins at different values along a curve",
                    "use the same number for all nodes",
                )
            signed = answer(self._solver.solve([Curve(curve) for curve in nodes] or None))
            return own(levels.sum() - own(signed))
        out: Floats = np.full(self._mesh.n_vertices, np.inf)
        if len(levels) == 0:
            raise InputError("curves: there are no nodes to measure distance from")
        for level in levels:
            points = [
                p
                for curve, start in zip(nodes, starts, strict=True)
                for p, value in zip(curve, start, strict=True)
                if value == level
            ]
            np.minimum(out, level + answer(self._solver.solve(points=points)), out=out)
        return out


class MeshMarchingTrianglesSolver:
    """Lines on which a function takes a value. V: vertices x 3. F: faces x 3."""

    def __init__(self, V: Any, F: Any) -> None:
        self._mesh = triangle_mesh(V, F)

    def marching_triangles(
        self, u: Any, isoval: float = 0.0
    ) -> list[list[tuple[int, list[float]]]]:
        """The lines on which u (one value a vertex) is isoval: curves of (element, barycentric).

        (e, [t]) is a point of edge e (`edges`), (v, []) a vertex. Smaller values are on the left,
        so the line around a minimum is counterclockwise. Closed lines repeat their first node.
        """
        values = as_array(u, "u")
        values = floats(values[:, 0] if values.shape[1:] == (1,) else values, "u")
        if len(values) != self._mesh.n_vertices:
            raise InputError(
                f"u: expected {self._mesh.n_vertices} values, one per vertex, got {len(values)}"
            )
        return level_lines(self._mesh, values, number(isoval, "isoval"))


def marching_triangles(
    V: Any, F: Any, u: Any, isoval: float = 0.0
) -> list[list[tuple[int, list[float]]]]:
    """Lines on which u is isoval by `MeshMarchingTrianglesSolver`."""
    return MeshMarchingTrianglesSolver(V, F).marching_triangles(u, isoval)


class MeshSignedHeatSolver:
    """Signed distance to curves, which may be broken, by the signed heat method.

    V: vertices x 3. F: faces x 3. Each set of options is prepared once.

    >>> from littoral.examples import square
    >>> solver = MeshSignedHeatSolver(square(4).points, square(4).faces)
    >>> up = [(2, []), (7, []), (12, []), (17, []), (22, [])]
    >>> solver.compute_distance([up]).round(6)[:2].tolist()
    [0.5, 0.25]
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        self._solvers = _Solvers(triangle_mesh(V, F), "signed-heat", t_coef)
        self._solvers(constraint="zero_set", preserve_normals=False)

    def compute_distance(
        self,
        curves: Any,
        curve_signs: Sequence[bool] = (),
        points: Any = (),
        preserve_source_normals: bool = False,
        level_set_constraint: str = "ZeroSet",
        soft_level_set_weight: float = -1,
    ) -> Floats:
        """Distance at all vertices, positive to the left of signed curves.

        curves: lists of (element, barycentric); points: such points, or vertices. curve_signs: one
        truth value a curve; missing ones are true. soft_level_set_weight, where positive: the
        values on the source are drawn to zero by a penalty of that weight a mean edge length.
        """
        nodes = surface_curves(curves)
        signs = ([bool(s) for s in curve_signs] + [True] * len(nodes))[: len(nodes)]
        options: dict[str, Any] = {
            "constraint": _constraint(level_set_constraint),
            "preserve_normals": bool(preserve_source_normals),
        }
        if not soft_level_set_weight <= 0:
            options["soft"] = positive(soft_level_set_weight, "soft_level_set_weight")
        spots = [surface_point(p, f"points[{i}]") for i, p in enumerate(points)]
        drawn = [Curve(curve, sign) for curve, sign in zip(nodes, signs, strict=True)]
        field = self._solvers(**options).solve(drawn or None, spots or None)
        return answer(field)


class PolygonMeshHeatSolver:
    """Distance on a mesh of polygons by heat methods.

    V: vertices x 3. F: a list of faces, each a list of vertices, or faces x corners.
    """

    def __init__(self, V: Any, F: Any, t_coef: float = 1.0) -> None:
        points = floats(V, "V", 3, finite=False)
        faces = F if isinstance(F, np.ndarray) else list(F)
        surface = Mesh(points, faces) if isinstance(faces, np.ndarray) else Polygons(points, faces)
        self._unsigned = _Solvers(surface, "unsigned-heat", t_coef)
        self._signed = _Solvers(surface, "signed-heat", t_coef)

    def compute_distance(self, v_inds: Any) -> Floats:
        """Distance to the nearest of several vertices, at all vertices."""
        return self._unsigned.from_many(v_inds, "v_inds", "vertices")

    def compute_signed_distance(self, curves: Any, level_set_constraint: str = "ZeroSet") -> Floats:
        """Distance at all vertices, positive to the right of curves, each a list of vertices."""
        given = vertex_curves(curves, self._signed.surface, "vertices")
        solver = self._signed(constraint=_constraint(level_set_constraint))
        return -answer(solver.solve(given or None))

    def extend_scalar(self, v_inds: Any, values: Any) -> Floats:
        """Not supported: raises UnsupportedError."""
        unsupported(*_EXTEND)

    def get_tangent_frames(self) -> tuple[Floats, Floats, Floats]:
        """Not supported: raises UnsupportedError."""
        unsupported(*_FRAMES)

    def transport_tangent_vectors(self, v_inds: Any, vectors: Any) -> Floats:
        """Not supported: raises UnsupportedError."""
        unsupported(*_TRANSPORT)


class PointCloudHeatSolver:
    """Distance on a point cloud by heat methods. P: points x 3."""

    def __init__(self, P: Any, t_coef: float = 1.0) -> None:
        self._points = floats(P, "P", 3)
        self._t_coef = positive(t_coef, "t_coef")
        self._unsigned = _Solvers(PointCloud(self._points), "unsigned-heat", self._t_coef)
        self._signed: tuple[Floats, _Solvers] | None = None

    def compute_distance(self, p_ind: int) -> Floats:
        """Distance to a point of the cloud, at all points [length]."""
        return self._unsigned.from_one(p_ind, "p_ind", "points")

    def compute_distance_multisource(self, p_inds: Any) -> Floats:
        """Distance to the nearest of several points of the cloud, at all points."""
        return self._unsigned.from_many(p_inds, "p_inds", "points")

    def compute_signed_distance(
        self,
        curves: Any,
        cloud_normals: Any,
        preserve_source_normals: bool = False,
        level_set_constraint: str = "ZeroSet",
        soft_level_set_weight: float = -1,
    ) -> Floats:
        """Distance at all points, positive to the right of curves, each a list of points.

        cloud_normals: points x 3, of any length. Solvers are kept as long as these are the same.
        """
        N = floats(cloud_normals, "cloud_normals", 3)
        kept = self._signed
        if kept is None or not np.array_equal(kept[0], N):
            cloud = PointCloud(self._points, N)
            kept = self._signed = (own(N), _Solvers(cloud, "signed-heat", self._t_coef))
        solvers = kept[1]
        given = vertex_curves(curves, solvers.surface, "points")
        options: dict[str, Any] = {"constraint": _constraint(level_set_constraint)}
        if preserve_source_normals:
            options["preserve_normals"] = True
        if not soft_level_set_weight <= 0:
            options["soft"] = positive(soft_level_set_weight, "soft_level_set_weight")
        return -answer(solvers(**options).solve(given or None))

    def extend_scalar(self, p_inds: Any, values: Any) -> Floats:
        """Not supported: raises UnsupportedError."""
        unsupported(*_EXTEND)

    def get_tangent_frames(self) -> tuple[Floats, Floats, Floats]:
        """Not supported: raises UnsupportedError."""
        unsupported(*_FRAMES)

    def transport_tangent_vector(self, p_ind: int, vector: Any) -> Floats:
        """Not supported: raises UnsupportedError."""
        unsupported(*_TRANSPORT)

    def transport_tangent_vectors(self, p_inds: Any, vectors: Any) -> Floats:
        """Not supported: raises UnsupportedError."""
        unsupported(*_TRANSPORT)

    def compute_log_map(self, p_ind: int) -> Floats:
        """Not supported: raises UnsupportedError."""
        unsupported(*_LOG_MAP)
