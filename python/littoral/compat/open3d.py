"""open3d.t.geometry.RaycastingScene by littoral, without rays; Open3D itself is not needed.

    from littoral.compat.open3d import RaycastingScene

Signs are Open3D's: distance is NEGATIVE INSIDE, occupancy 1 inside and 0 outside. Normals are on
the side from which a triangle's vertices are counterclockwise. Lengths are in the unit of the
vertices. Results are float32 and uint32 and have the shape of the queries, as in Open3D. They are
`open3d.core.Tensor` where the queries are, and otherwise numpy arrays with a method `numpy()`.

Inside is where the generalized winding number of all triangles together is beyond 1/2, either way
round. On closed meshes that do not overlap this is what Open3D finds with rays. Scenes with holes
have an inside here, which in Open3D depends on the direction of a ray; overlaps of closed meshes
are inside here and outside in Open3D. Where several triangles are equally near, another one of them
may be named. Computation is in double precision. Bad input raises TypeError, ValueError or
IndexError.
"""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from .._arrays import Array, Floats, as_array, floats, ints
from .._errors import ArgumentError, InputError, UnsupportedError
from .._foreign import as_surface
from .._surfaces import Mesh
from ._nearest import Nearest, face_normals


class Tensor(np.ndarray[Any, Any]):
    """A numpy array with the method by which Open3D's tensors become one."""

    def numpy(self) -> Array:
        """The same values as a plain array, not copied."""
        return self.view(np.ndarray)

    def cpu(self) -> Tensor:
        """Itself."""
        return self


def _is_tensor(value: Any) -> bool:
    return type(value).__module__.startswith("open3d.")


def _array(value: Any, name: str) -> Array:
    return value.cpu().numpy() if _is_tensor(value) else as_array(value, name)


class _Queries:
    """Points ... x 3, and results in the shape and kind that belong to them."""

    def __init__(self, value: Any) -> None:
        array = _array(value, "query_points")
        if array.ndim < 2 or array.shape[-1] != 3:
            raise InputError(f"query_points: expected shape ... x 3, got {array.shape}")
        self._shape = array.shape[:-1]
        self._make = type(value).from_numpy if _is_tensor(value) else None
        self.points = floats(array.reshape(-1, 3), "query_points", 3)

    def result(self, values: Array, dtype: npt.DTypeLike = np.float32) -> Any:
        shaped = np.ascontiguousarray(values, dtype=dtype)
        shaped = shaped.reshape(self._shape + shaped.shape[1:])
        return shaped.view(Tensor) if self._make is None else self._make(shaped)


def _no_rays(name: str) -> NoReturn:
    raise UnsupportedError(
        f"{name}: littoral casts no rays; use compute_distance, compute_signed_distance, "
        "compute_occupancy or compute_closest_points, or Open3D's own RaycastingScene"
    )


def _threads(value: int) -> int | None:
    return int(value) if value else None


def _check_samples(nsamples: int) -> None:
    if nsamples < 1 or nsamples % 2 == 0:
        raise InputError(f"nsamples: expected an odd number of at least 1, got {nsamples}")


class RaycastingScene:
    """Triangle meshes to measure distance from; prepared by the first query after the last mesh.

    nthreads: of the preparation, 0 for all cores. device: the CPU. The arguments `nthreads` of
    queries mean the same; `nsamples` is checked and has no effect, as no rays are cast.

    >>> import littoral
    >>> scene = RaycastingScene()
    >>> scene.add_triangles(littoral.examples.cube())
    0
    >>> scene.compute_signed_distance([[.5, .5, .5], [.5, .5, 3]]).numpy().tolist()
    [-0.5, 2.0]
    """

    INVALID_ID = 4294967295

    def __init__(self, nthreads: int = 0, device: Any = None) -> None:
        if device is not None and not str(device).upper().startswith("CPU"):
            raise UnsupportedError(f"device: littoral computes on the CPU, not on {device}")
        self._nthreads = nthreads
        self._vertices: list[Floats] = []
        self._triangles: list[Array] = []
        self._near: Nearest | None = None
        self._starts: Array = np.zeros(1, np.int64)

    def add_triangles(
        self, vertex_positions: Any = None, triangle_indices: Any = None, *, mesh: Any = None
    ) -> int:
        """Adds vertices (n x 3) and triangles (m x 3), or a mesh; returns its geometry id.

        A mesh is what `littoral.as_surface` takes. Raises ValueError, TypeError and IndexError.
        """
        if mesh is None and triangle_indices is None:
            mesh = vertex_positions
        elif mesh is not None and (vertex_positions is not None or triangle_indices is not None):
            raise ArgumentError(
                "add_triangles: expected a mesh, or vertices and triangles, not both"
            )
        vertices: Array
        triangles: Array
        if mesh is not None:
            surface = as_surface(mesh)
            if surface.n_faces == 0 or len(surface.corners) != 3 * surface.n_faces:
                raise InputError(f"mesh: expected triangles, got a {surface.kind}")
            vertices, triangles = surface.points, surface.corners.reshape(-1, 3)
        else:
            vertices = floats(_array(vertex_positions, "vertex_positions"), "vertex_positions", 3)
            triangles = ints(_array(triangle_indices, "triangle_indices"), "triangle_indices", 3)
            if len(triangles):
                Mesh(vertices, triangles)  # complains
        self._vertices.append(np.array(vertices))
        self._triangles.append(np.array(triangles))
        self._near = None
        return len(self._triangles) - 1

    def _prepared(self) -> Nearest | None:
        """None for a scene without triangles."""
        if self._near is None and any(map(len, self._triangles)):
            offsets = np.cumsum([0] + [len(v) for v in self._vertices])
            faces = [t + o for t, o in zip(self._triangles, offsets[:-1], strict=True)]
            self._starts = np.cumsum([0] + [len(t) for t in self._triangles])
            self._near = Nearest((np.concatenate(self._vertices), np.concatenate(faces)))
        return self._near

    def compute_distance(self, query_points: Any, nthreads: int = 0) -> Any:
        """Distance at points (... x 3): ..., at least 0, inf in an empty scene [length]."""
        queries, near = _Queries(query_points), self._prepared()
        if near is None:
            return queries.result(np.full(len(queries.points), np.inf))
        return queries.result(near.unsigned(queries.points, _threads(nthreads)))

    def compute_signed_distance(
        self, query_points: Any, nthreads: int = 0, nsamples: int = 1
    ) -> Any:
        """Distance at points (... x 3): ..., negative inside [length]."""
        _check_samples(nsamples)
        queries, near = _Queries(query_points), self._prepared()
        if near is None:
            return queries.result(np.full(len(queries.points), np.inf))
        return queries.result(near.signed(queries.points, _threads(nthreads)))

    def compute_occupancy(self, query_points: Any, nthreads: int = 0, nsamples: int = 1) -> Any:
        """1 where points (... x 3) are inside and 0 elsewhere: ..., float32."""
        _check_samples(nsamples)
        queries, near = _Queries(query_points), self._prepared()
        if near is None:
            return queries.result(np.zeros(len(queries.points)))
        return queries.result(near.inside(queries.points, _threads(nthreads)))

    def compute_closest_points(self, query_points: Any, nthreads: int = 0) -> dict[str, Any]:
        """The nearest points of the scene, by name.

        points: ... x 3. geometry_ids, primitive_ids: ..., uint32: the mesh, and the triangle in it.
        primitive_uvs: ... x 2: (1 - u - v) A + u B + v C is the point. primitive_normals: ... x 3,
        of unit length. Without triangles ids are INVALID_ID and the others nan.
        """
        queries, near = _Queries(query_points), self._prepared()
        n = len(queries.points)
        points: Array = np.full((n, 3), np.nan)
        uvs: Array = np.full((n, 2), np.nan)
        normals: Array = points
        geometry: Array = np.full(n, self.INVALID_ID)
        face: Array = geometry
        if near is not None:
            found = near.sdf.closest(queries.points, threads=_threads(nthreads))
            geometry = np.searchsorted(self._starts, found.face, side="right") - 1
            face = found.face - self._starts[geometry]
            points, uvs = found.point, found.barycentric[:, 1:]
            normals = face_normals(near.surface, found.face)
        return {
            "points": queries.result(points),
            "geometry_ids": queries.result(geometry, np.uint32),
            "primitive_ids": queries.result(face, np.uint32),
            "primitive_uvs": queries.result(uvs),
            "primitive_normals": queries.result(normals),
        }

    def cast_rays(self, rays: Any, nthreads: int = 0) -> NoReturn:
        """Raises UnsupportedError."""
        _no_rays("cast_rays")

    def count_intersections(self, rays: Any, nthreads: int = 0) -> NoReturn:
        """Raises UnsupportedError."""
        _no_rays("count_intersections")

    def list_intersections(self, rays: Any, nthreads: int = 0) -> NoReturn:
        """Raises UnsupportedError."""
        _no_rays("list_intersections")

    def test_occlusions(
        self, rays: Any, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0
    ) -> NoReturn:
        """Raises UnsupportedError."""
        _no_rays("test_occlusions")

    @staticmethod
    def create_rays_pinhole(*args: Any, **kwargs: Any) -> NoReturn:
        """Raises UnsupportedError."""
        _no_rays("create_rays_pinhole")
