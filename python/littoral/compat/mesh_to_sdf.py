"""The package mesh_to_sdf by littoral; neither it nor trimesh nor a display is needed.

    from littoral.compat.mesh_to_sdf import mesh_to_sdf, mesh_to_voxels, sample_sdf_near_surface

Signs are mesh_to_sdf's: NEGATIVE INSIDE. `mesh_to_sdf` measures in the unit of the mesh. The other
two first scale the mesh about the centre of its box: `mesh_to_voxels` until the longest side of the
box is 2, `sample_sdf_near_surface` until the farthest vertex is 1 from the centre; they measure in
that unit. Results are float32, gradients double. A mesh is a `trimesh.Trimesh`, a scene, or
anything else with faces that `littoral.as_surface` takes.

Distance is to the mesh itself, not to points scanned or sampled on it, so it differs from
mesh_to_sdf's by the spacing of these points. Inside is where the generalized winding number is
beyond 1/2, either way round; faces should be oriented alike. The arguments that say how to scan and
sample are checked and have no effect, and `bounding_radius` only where it is not positive.

There is no scan: it would put points a pixel apart, on what cameras around the mesh see, in place
of the faces. The answer is the one that both of mesh_to_sdf's ways approximate, unless faces lie
inside others: cameras do not see them, and here they count, as for "sample".

Bad input raises TypeError or ValueError.
"""

from __future__ import annotations

from typing import Any, NoReturn

import numpy as np

from .._arguments import whole
from .._arrays import Array, Floats
from .._errors import ArgumentError, InputError, UnsupportedError
from .._foreign import as_surface
from .._surfaces import Mesh, Polygons, Surface
from ._nearest import Nearest, face_normals, prepared


class BadMeshException(Exception):
    """The values of a mesh fail the check that was asked for."""


def _check(surface_point_method: str, sign_method: str) -> None:
    if surface_point_method not in ("scan", "sample"):
        raise InputError(
            f"surface_point_method: expected 'scan' or 'sample', got {surface_point_method!r}"
        )
    if sign_method not in ("normal", "depth"):
        raise InputError(f"sign_method: expected 'normal' or 'depth', got {sign_method!r}")


def _moved(surface: Surface, points: Floats) -> Surface:
    faces = surface.faces
    return Polygons(points, faces) if isinstance(faces, list) else Mesh(points, faces)


def _scaled(mesh: Any, to_sphere: bool) -> Nearest:
    """In the unit sphere, or in the cube from -1 to 1; the centre of the box becomes 0."""
    surface = as_surface(mesh)
    used = surface.points[np.unique(surface.corners)] if surface.n_faces else surface.points
    low, high = used.min(axis=0), used.max(axis=0)
    points = surface.points - (low + high) / 2
    if to_sphere:
        size = float(np.linalg.norm(points, axis=1).max())
    else:
        size = float((high - low).max()) / 2
    if not 0 < size < np.inf:
        raise InputError(f"mesh: expected vertices of a positive, finite extent, got {size}")
    return prepared(_moved(surface, points / size))


def _with_gradients(near: Nearest, points: Floats) -> tuple[Array, Array]:
    """float32 distance, and unit vectors of its steepest increase (n x 3), normals on faces."""
    found = near.sdf.closest(points)
    sign = np.where(near.inside(points), -1.0, 1.0)
    away = (points - found.point) * sign[:, None]
    length = np.linalg.norm(away, axis=1, keepdims=True)
    gradients = away / np.where(length > 0, length, 1)
    on = length[:, 0] == 0
    gradients[on] = face_normals(near.surface, found.face[on])
    return (found.distance * sign).astype(np.float32), gradients


def mesh_to_sdf(
    mesh: Any,
    query_points: Any,
    surface_point_method: str = "scan",
    sign_method: str = "normal",
    bounding_radius: float | None = None,
    scan_count: int = 100,
    scan_resolution: int = 400,
    sample_point_count: int = 10000000,
    normal_sample_count: int = 11,
) -> Array:
    """float32 n: distance at points (n x 3), negative inside [length].

    Raises TypeError where the points are no numpy array, ValueError for another shape.

    >>> import littoral, numpy as np
    >>> mesh_to_sdf(littoral.examples.cube(), np.array([[.5, .5, .5], [.5, .5, 3]])).tolist()
    [-0.5, 2.0]
    """
    if not isinstance(query_points, np.ndarray):
        raise ArgumentError(
            f"query_points: expected a numpy array, got {type(query_points).__name__}"
        )
    if query_points.ndim != 2 or query_points.shape[1] != 3:
        raise InputError(f"query_points: expected shape n x 3, got {query_points.shape}")
    _check(surface_point_method, sign_method)
    if bounding_radius is not None and not bounding_radius > 0:
        raise InputError(f"bounding_radius: expected a positive length, got {bounding_radius}")
    return prepared(mesh).signed(query_points).astype(np.float32)


def _integer(value: Any, name: str, least: int) -> int:
    """A whole number of at least that many, also as a float."""
    if isinstance(value, bool):
        raise ArgumentError(f"{name}: expected an integer, got {value}")
    return whole(value, name, f" of at least {least}", least)


def _raster(resolution: int) -> Floats:
    """resolution^3 x 3: nodes from -1 to 1, z fastest."""
    axis = np.linspace(-1, 1, resolution).astype(np.float32).astype(np.float64)
    return np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)


def _is_plausible(voxels: Array) -> bool:
    """Whether no value falls from a node to the next by more than the voxels' size allows."""
    most = 2.0 / len(voxels) * 3**0.5 * 1.1
    return all(float(np.max(-np.diff(voxels, axis=axis))) < most for axis in range(3))


def mesh_to_voxels(
    mesh: Any,
    voxel_resolution: int = 64,
    surface_point_method: str = "scan",
    sign_method: str = "normal",
    scan_count: int = 100,
    scan_resolution: int = 400,
    sample_point_count: int = 10000000,
    normal_sample_count: int = 11,
    pad: bool = False,
    check_result: bool = False,
    return_gradients: bool = False,
) -> Any:
    """float32 R x R x R: distance in the cube from -1 to 1 that the mesh is scaled to.

    Element i, j, k is at x, y, z = -1 + 2 (i, j, k) / (R - 1). pad: a layer of 1 around it, R + 2.
    check_result: BadMeshException where neighbours differ too much. return_gradients: also
    R x R x R x 3, of unit length.

    >>> import littoral
    >>> voxels = mesh_to_voxels(littoral.examples.cube(), 5)
    >>> voxels.shape, float(voxels[2, 2, 2])
    ((5, 5, 5), -1.0)
    """
    _check(surface_point_method, sign_method)
    side = _integer(voxel_resolution, "voxel_resolution", 2)
    points = _raster(side)
    near = _scaled(mesh, to_sphere=False)
    shape = (side,) * 3
    gradients: Array = np.empty(0)
    values: Array
    if return_gradients:
        values, gradients = _with_gradients(near, points)
        gradients = gradients.reshape(*shape, 3)
    else:
        values = near.signed(points).astype(np.float32)
    voxels: Array = values.reshape(shape)
    if check_result and not _is_plausible(voxels):
        raise BadMeshException("neighbouring voxels differ by more than their distance")
    if pad:
        voxels = np.pad(voxels, 1, mode="constant", constant_values=1)
        if return_gradients:
            gradients = np.pad(gradients, ((1, 1), (1, 1), (1, 1), (0, 0)), mode="edge")
    return (voxels, gradients) if return_gradients else voxels


def _on_surface(near: Nearest, count: int) -> Floats:
    """Random points, as many on equal areas on average."""
    surface = near.surface
    sizes = np.diff(surface.face_offsets)
    first = surface.face_offsets[:-1]
    fans = [  # polygons as triangles from their first corner
        np.stack([first[sizes > k + 1], first[sizes > k + 1] + k, first[sizes > k + 1] + k + 1], 1)
        for k in range(1, int(sizes.max()) - 1)
    ]
    corners = surface.points[surface.corners[np.concatenate(fans)]]
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    if not areas.sum() > 0:
        raise InputError("mesh: expected faces that have an area")
    face = np.random.choice(len(areas), count, p=areas / areas.sum())
    u, v = np.random.random((2, count, 1))
    over = u + v > 1
    u, v = np.where(over, 1 - u, u), np.where(over, 1 - v, v)
    out: Floats = a[face] + u * (b - a)[face] + v * (c - a)[face]
    return out


def _in_sphere(count: int) -> Floats:
    """Random points of the unit sphere, evenly."""
    directions = np.random.normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    out: Floats = directions * np.random.random((count, 1)) ** (1 / 3)
    return out


def sample_sdf_near_surface(
    mesh: Any,
    number_of_points: int = 500000,
    surface_point_method: str = "scan",
    sign_method: str = "normal",
    scan_count: int = 100,
    scan_resolution: int = 400,
    sample_point_count: int = 10000000,
    normal_sample_count: int = 11,
    min_size: float = 0,
    return_gradients: bool = False,
) -> Any:
    """Random points of the unit sphere that the mesh is scaled to, and the distance there.

    float32 n x 3 and float32 n, and with return_gradients n x 3 of unit length. 47 of 50 points are
    near the surface, half of them 0.0025 off along each axis (standard deviation) and the other
    half 0.00025; the others, at the end, are even in the sphere. min_size: BadMeshException where a
    smaller share of these is inside. `numpy.random.seed` makes the points repeat.

    >>> import littoral
    >>> points, sdf = sample_sdf_near_surface(littoral.examples.cube(), 100)
    >>> points.shape, sdf.shape
    ((100, 3), (100,))
    """
    _check(surface_point_method, sign_method)
    count = _integer(number_of_points, "number_of_points", 1)
    near = _scaled(mesh, to_sphere=True)
    close = int(count * 47 / 50) // 2
    surface = _on_surface(near, close)
    points = np.concatenate(
        [
            surface + np.random.normal(scale=0.0025, size=(close, 3)),
            surface + np.random.normal(scale=0.00025, size=(close, 3)),
            _in_sphere(count - 2 * close),
        ]
    ).astype(np.float32)
    queries = points.astype(np.float64)
    gradients: Array = np.empty(0)
    values: Array
    if return_gradients:
        values, gradients = _with_gradients(near, queries)
    else:
        values = near.signed(queries).astype(np.float32)
    if min_size > 0 and np.mean(values[2 * close :] < 0) < min_size:
        raise BadMeshException(f"less than {min_size} of the unit sphere is inside")
    return (points, values, gradients) if return_gradients else (points, values)


def get_surface_point_cloud(*args: Any, **kwargs: Any) -> NoReturn:
    """Not supported: raises UnsupportedError."""
    raise UnsupportedError(
        "get_surface_point_cloud: littoral measures to the mesh itself and makes no cloud of it; "
        "use mesh_to_sdf, or littoral.SDF for many queries"
    )
