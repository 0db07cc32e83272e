"""libigl's names and arguments (Python release 2.6), computed by littoral.

    import littoral.compat.igl as igl

Lengths are in the unit of the input; results are float64 and int64. Distance in space is negative
inside of faces that are counterclockwise seen from outside. As in libigl, signs from winding
numbers scale: S = (1 - 2 w) |P - C|, which is the distance only where w is 0 or 1. Around surfaces
with holes `littoral.SDF(V, F)` gives a distance instead.

Different from libigl: winding numbers are accurate to about 0.001; between several nearest faces
another may be chosen; what no source reaches is at distance infinity; shortest paths may pass
vertices at which parts of the surface touch; heat does not flow across boundaries, where libigl
takes the mean of that and of a boundary held at 0; bad input raises TypeError, ValueError or
IndexError. What littoral has doubts about is a RuntimeWarning, what it does not compute raises
`littoral.UnsupportedError`.
"""

from __future__ import annotations

import enum
from typing import Any

import numpy as np

from .._arguments import number
from .._arrays import Array, Floats, Ints, as_array, check_range, floats, ints
from .._distance import DistanceSolver, distance
from .._errors import ArgumentError, InputError
from .._space import SDF, Closest
from .._surfaces import Mesh, PointCloud
from ._arguments import (
    Indices,
    answer,
    indices,
    missing,
    own,
    positive,
    space_points,
    triangle_mesh,
    unsupported,
)
from ._pseudonormals import pseudonormals

__all__ = [
    "SIGNED_DISTANCE_TYPE_DEFAULT",
    "SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER",
    "SIGNED_DISTANCE_TYPE_PSEUDONORMAL",
    "SIGNED_DISTANCE_TYPE_UNSIGNED",
    "SIGNED_DISTANCE_TYPE_WINDING_NUMBER",
    "FastWindingNumberBVH",
    "HeatGeodesicsData",
    "SignedDistanceType",
    "exact_geodesic",
    "fast_winding_number",
    "fast_winding_number_precompute",
    "heat_geodesics_precompute",
    "heat_geodesics_solve",
    "point_mesh_squared_distance",
    "signed_distance",
    "winding_number",
]

_INSTEAD = {
    "AABB": "littoral.SDF(V, F).closest(X) finds nearest points",
    "cotmatrix": "-littoral.operators((V, F)).L is that matrix",
    "grad": "littoral.operators((V, F)).G is that matrix",
    "hausdorff": "the command littoral compare measures it",
    "isolines": "littoral.isolines((V, F), values, level) has them as lines",
    "marching_cubes": "littoral.Volume(values, spacing, origin).isosurface() makes surfaces",
    "massmatrix": "littoral.operators((V, F)).M has the areas of vertices",
    "offset_surface": "littoral.offset((V, F), distance) makes it",
}


def __getattr__(name: str) -> Any:
    raise missing(__name__, "libigl", _INSTEAD, name)


_PAIRS = 4_000_000  # of points and queries at once


class SignedDistanceType(enum.Enum):
    """Where the sign of `signed_distance` comes from."""

    SIGNED_DISTANCE_TYPE_PSEUDONORMAL = 0
    SIGNED_DISTANCE_TYPE_WINDING_NUMBER = 1
    SIGNED_DISTANCE_TYPE_UNSIGNED = 3
    SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER = 4
    SIGNED_DISTANCE_TYPE_DEFAULT = 2


SIGNED_DISTANCE_TYPE_PSEUDONORMAL = SignedDistanceType.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
SIGNED_DISTANCE_TYPE_WINDING_NUMBER = SignedDistanceType.SIGNED_DISTANCE_TYPE_WINDING_NUMBER
SIGNED_DISTANCE_TYPE_UNSIGNED = SignedDistanceType.SIGNED_DISTANCE_TYPE_UNSIGNED
SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER = (
    SignedDistanceType.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
)
SIGNED_DISTANCE_TYPE_DEFAULT = SignedDistanceType.SIGNED_DISTANCE_TYPE_DEFAULT


def signed_distance(
    P: Any,
    V: Any,
    F: Any,
    sign_type: SignedDistanceType = SIGNED_DISTANCE_TYPE_DEFAULT,
    lower_bound: float = -np.inf,
    upper_bound: float = np.inf,
) -> tuple[Floats, Indices, Floats, Floats]:
    """Signed distance of points to a mesh: S, I, C, N.

    P: points x 3. V: vertices x 3. F: faces x 3. S: points, distance; I: points, nearest face; C:
    points x 3, nearest point there; N: points x 3, unit pseudonormal there, or 0 x 0 unless
    sign_type is PSEUDONORMAL. DEFAULT and both kinds of winding number: S = (1 - 2 w) |P - C|, w
    without its sign for the fast one. With bounds, points farther than the larger of their sizes,
    or nearer than that less the difference of the bounds, get S = nan, I = faces + 1, C = N = 0.

    >>> from littoral.examples import cube
    >>> S, I, C, N = signed_distance([[.5, .5, .5], [.5, .5, 3]], cube().points, cube().faces)
    >>> S.round(2).tolist(), C[1].tolist()
    ([-0.5, 2.0], [0.5, 0.5, 1.0])
    """
    queries = as_array(P, "P")
    if queries.ndim == 2 and queries.shape[1] == 2:
        unsupported("signed distance in the plane", "use libigl itself, or 3D triangles")
    if getattr(sign_type, "name", None) not in SignedDistanceType.__members__:
        raise ArgumentError(f"sign_type: expected a SignedDistanceType, got {sign_type!r}")
    sign = SignedDistanceType[sign_type.name]
    x = floats(queries, "P", 3)
    low, high = number(lower_bound, "lower_bound"), number(upper_bound, "upper_bound")
    if np.isnan(low) or np.isnan(high) or low > high:
        raise InputError(f"lower_bound {low} must be at most upper_bound {high}")
    mesh = triangle_mesh(V, F)
    plain = sign in (SIGNED_DISTANCE_TYPE_PSEUDONORMAL, SIGNED_DISTANCE_TYPE_UNSIGNED)
    sdf = SDF(mesh, method="closest-point" if plain else "winding")
    closest = sdf.closest(x)
    S, C = own(closest.distance), own(closest.point)
    N: Floats = np.empty((0, 0))
    I: Indices = closest.face.astype(np.int64)  # noqa: E741
    if sign == SIGNED_DISTANCE_TYPE_PSEUDONORMAL:
        S = own(sdf(x))
        N = pseudonormals(mesh, closest)
    elif not plain:
        w = sdf.winding_number(x)
        S *= 1 - 2 * (np.abs(w) if sign == SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER else w)
    largest = max(abs(low), abs(high))
    smallest = max(largest - (high - low), 0.0) if np.isfinite(largest) else 0.0
    outside = (closest.distance >= largest) | (closest.distance < smallest)
    S[outside], I[outside], C[outside] = np.nan, mesh.n_faces + 1, 0
    if len(N):
        N[outside] = 0
    return S, I, C, N


def point_mesh_squared_distance(P: Any, V: Any, Ele: Any) -> tuple[Floats, Indices, Floats]:
    """Squared distance of points to triangles or points: D, I, C.

    P: points x 3 (or x 2). V: vertices x 3 (or x 2). Ele: elements x 3, triangles, or x 1, points.
    D: points [length^2]; I: points, nearest element; C: nearest point there, as P.

    >>> from littoral.examples import cube
    >>> D, I, C = point_mesh_squared_distance([[.2, .3, 3]], cube().points, cube().faces)
    >>> D.tolist(), C.tolist()
    ([4.0], [[0.2, 0.3, 1.0]])
    """
    x, points = space_points(P, "P"), space_points(V, "V")
    elements = ints(as_array(Ele, "Ele").reshape(-1), "Ele").reshape(np.shape(Ele))
    if elements.ndim == 1:
        elements = elements[:, None]
    if elements.ndim == 2 and elements.shape[1] == 2:
        unsupported("distance to segments in space", "use libigl itself for elements x 2")
    check_range(elements, len(points), "Ele", "vertices")
    closest = _closest_points(points, elements, x)
    columns = 2 if as_array(P, "P").shape[1:] == (2,) else 3
    squared: Floats = own(closest.distance) ** 2
    return squared, closest.face.astype(np.int64), own(closest.point)[:, :columns].copy()


def _closest_points(points: Floats, elements: Ints, x: Floats) -> Closest:
    if elements.ndim == 2 and elements.shape[1] == 1 and len(elements):
        places = points[elements[:, 0]]
        try:
            cloud = PointCloud(places, np.ones((len(elements), 3)))
            return SDF(cloud, method="winding").closest(x)
        except InputError:  # a cloud has points at three places
            different = np.unique(places, axis=0, return_index=True)[1]
            if len(different) < 3:
                return _closest_of_few(places, different, x)
            raise
    return SDF(triangle_mesh(points, elements), method="closest-point").closest(x)


def _closest_of_few(places: Floats, chosen: Array, x: Floats) -> Closest:
    """The nearest of the chosen places, which are too few to be a cloud."""
    away = np.linalg.norm(x[:, None] - places[chosen][None], axis=2)
    nearest = chosen[away.argmin(axis=1)].astype(np.int32)
    corners = np.repeat(nearest[:, None], 3, axis=1)
    barycentric = np.tile([1.0, 0.0, 0.0], (len(x), 1))
    return Closest(places[nearest], nearest, barycentric, corners, away.min(axis=1))


def winding_number(V: Any, F: Any, O: Any = None, *, o: Any = None) -> Any:  # noqa: E741
    """Generalized winding number of triangles at points: points, or one number for one point.

    V: vertices x 3. F: faces x 3. O, or o: points x 3, or 3 numbers.

    >>> from littoral.examples import cube
    >>> round(winding_number(cube().points, cube().faces, [.5, .5, .5]), 3)
    1.0
    """
    if (O is None) == (o is None):
        raise ArgumentError("winding_number: expected V, F and O, or V, F and o")
    queries = as_array(O if o is None else o, "O")
    if queries.shape[-1:] == (2,):
        unsupported("winding numbers in the plane", "use libigl itself, or 3D triangles")
    single = queries.ndim == 1
    x = floats(queries[None] if single else queries, "O", 3)
    w = own(SDF(triangle_mesh(V, F), method="winding").winding_number(x))
    return float(w[0]) if single else w


def fast_winding_number(*args: Any, **named: Any) -> Floats:
    """Winding number at points Q: of triangles (V, F, Q) or of oriented points (P, N, A, Q).

    P: points x 3; N: their unit normals; A: points, their areas [length^2]; expansion_order and
    beta may follow and have no effect: points are summed exactly, one by one.
    """
    if len(args) + len(named) == 3:
        w: Floats = winding_number(*_in_order("V F Q", args, named))
        return w
    if "EC" in named or len(args) + len(named) > 6:
        unsupported(
            "octrees of points to pass in", "leave them out: fast_winding_number(P, N, A, Q)"
        )
    P, N, A, Q, _, _ = _in_order("P N A Q expansion_order beta", args, named, 2)
    points, normals, x = floats(P, "P", 3), floats(N, "N", 3), floats(Q, "Q", 3)
    areas = floats(A, "A")
    if not len(points) == len(normals) == len(areas):
        raise InputError(
            f"P, N, A: expected as many of each, got {len(points)}, {len(normals)}, {len(areas)}"
        )
    moments = normals * (areas / (4 * np.pi))[:, None]
    out = np.zeros(len(x))
    step = max(1, _PAIRS // max(len(points), 1))
    for i in range(0, len(x), step):
        away = points[None] - x[i : i + step, None]
        r = np.linalg.norm(away, axis=2)
        r[r == 0] = np.inf  # a point has no side as seen from itself
        out[i : i + step] = (np.einsum("qpk,pk->qp", away, moments) / r**3).sum(axis=1)
    return out


def _in_order(
    names: str, args: tuple[Any, ...], named: dict[str, Any], optional: int = 0
) -> list[Any]:
    """Arguments by position and by name, None for those left out at the end."""
    expected = names.split()
    given = dict(zip(expected, args, strict=False))
    needed = expected[: len(expected) - optional]
    if (
        len(args) > len(expected)
        or set(named) - set(expected)
        or set(named) & set(given)
        or set(needed) - set(given) - set(named)
    ):
        raise ArgumentError(f"fast_winding_number: expected {', '.join(needed)} or (V, F, Q)")
    given.update(named)
    return [given.get(name) for name in expected]


def fast_winding_number_precompute(*args: Any, **named: Any) -> tuple[Floats, Floats, Floats]:
    """Not supported: raises UnsupportedError."""
    unsupported("octrees of points to prepare", "call fast_winding_number(P, N, A, Q)")


class FastWindingNumberBVH:
    """Winding numbers of one mesh at many sets of points.

    >>> from littoral.examples import cube
    >>> bvh = FastWindingNumberBVH()
    >>> bvh.init(cube().points, cube().faces)
    >>> bvh.winding_number([[.5, .5, .5]]).round(3).tolist()
    [1.0]
    """

    def __init__(self) -> None:
        self._sdf: SDF | None = None

    def init(self, V: Any, F: Any, order: int = 2) -> None:
        """Prepares V, vertices x 3, and F, faces x 3. order has no effect."""
        self._sdf = SDF(triangle_mesh(V, F), method="winding")

    def winding_number(self, Q: Any, accuracy_scale: float = 2.0) -> Floats:
        """At points x 3. accuracy_scale has no effect."""
        if self._sdf is None:
            raise InputError("FastWindingNumberBVH: call init(V, F) first")
        return own(self._sdf.winding_number(floats(Q, "Q", 3)))


class HeatGeodesicsData:
    """What `heat_geodesics_precompute` prepares.

    use_intrinsic_delaunay: on better triangles of the same surface; set it before.
    """

    def __init__(self) -> None:
        self.use_intrinsic_delaunay = False
        self._solver: DistanceSolver | None = None


def heat_geodesics_precompute(
    V: Any,
    F: Any,
    t: float | HeatGeodesicsData | None = None,
    data: HeatGeodesicsData | None = None,
) -> None:
    """Prepares `data`: (V, F, data), or (V, F, t, data) with a diffusion time [length^2].

    V: vertices x 3 (or x 2). F: faces x 3. Without t, it is the squared mean edge length.
    """
    if isinstance(t, HeatGeodesicsData):
        t, data = None, t
    if not isinstance(data, HeatGeodesicsData):
        raise ArgumentError(f"data: expected HeatGeodesicsData, got {type(data).__name__}")
    mesh = triangle_mesh(V, F, flat=True)
    a, b = mesh.points[mesh.edges[:, 0]], mesh.points[mesh.edges[:, 1]]
    h = float(np.linalg.norm(b - a, axis=1).mean())
    scale = 1.0 if t is None else positive(t, "t") / positive(h * h, "the mean edge length")
    data._solver = DistanceSolver(
        mesh,
        "unsigned-heat",
        time_scale=scale,
        intrinsic_delaunay=bool(data.use_intrinsic_delaunay),
    )


def heat_geodesics_solve(data: HeatGeodesicsData, gamma: Any) -> Floats:
    """Distance to the nearest of the vertices gamma by the heat method, at all vertices [length].

    >>> from littoral.examples import sphere
    >>> data = HeatGeodesicsData()
    >>> heat_geodesics_precompute(sphere().points, sphere().faces, data)
    >>> bool(abs(heat_geodesics_solve(data, [0]).max() - 3.14) < .1)
    True
    """
    if not isinstance(data, HeatGeodesicsData):
        raise ArgumentError(f"data: expected HeatGeodesicsData, got {type(data).__name__}")
    if data._solver is None:
        raise InputError("data: call heat_geodesics_precompute first")
    given = indices(gamma, data._solver.mesh.n_vertices, "gamma", "vertices")
    return answer(data._solver.solve(points=given))


def exact_geodesic(
    V: Any, F: Any, VS: Any = (), FS: Any = (), VT: Any = (), FT: Any = ()
) -> Floats:
    """Exact distance along triangles of targets to the nearest source: vertices VT, then faces FT.

    V: vertices x 3 (or x 2). F: faces x 3. VS, VT: vertices; FS, FT: faces, by their barycenters.

    >>> from littoral.examples import square
    >>> exact_geodesic(square(2).points, square(2).faces, VS=[0], VT=[2, 8]).round(6).tolist()
    [1.0, 1.414214]
    """
    mesh = triangle_mesh(V, F, flat=True)
    n, m = mesh.n_vertices, mesh.n_faces
    lists = []
    for value, name, count, of in (
        (VS, "VS", n, "vertices"),
        (FS, "FS", m, "faces"),
        (VT, "VT", n, "vertices"),
        (FT, "FT", m, "faces"),
    ):
        lists.append(ints(np.ravel(as_array(value, name)), name))
        check_range(lists[-1], count, name, of)
    vs, fs, vt, ft = lists
    if len(vs) + len(fs) == 0:
        raise InputError("VS, FS: expected at least one source, got none")
    split = np.unique(np.concatenate([fs, ft]))
    centers = {int(f): n + i for i, f in enumerate(split)}
    if len(split):
        mesh = _with_barycenters(mesh, split)
    sources = np.concatenate([vs, np.array([centers[int(f)] for f in fs], np.int32)])
    targets = np.concatenate([vt, np.array([centers[int(f)] for f in ft], np.int32)])
    return own(answer(distance(mesh, points=sources, method="exact"))[targets])


def _with_barycenters(mesh: Mesh, split: Ints) -> Mesh:
    """The same surface with a vertex at the barycenter of some faces, each cut in three."""
    F = np.asarray(mesh.faces)
    center = mesh.n_vertices + np.arange(len(split), dtype=np.int32)
    a, b, c = F[split].T
    parts = [np.column_stack([p, q, center]) for p, q in ((a, b), (b, c), (c, a))]
    points = np.concatenate([mesh.points, mesh.points[F[split]].mean(axis=1)])
    return Mesh(points, np.concatenate([np.delete(F, split, axis=0), *parts]))
