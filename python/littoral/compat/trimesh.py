"""trimesh.proximity and mesh.contains by littoral; trimesh itself is not needed.

    from littoral.compat.trimesh import ProximityQuery, closest_point, contains, signed_distance

Signs are trimesh's: positive INSIDE, negative outside, and positive within 1e-8 of the surface.
Lengths are in the unit of the mesh. A mesh is a `trimesh.Trimesh` or anything else that
`littoral.as_surface` takes; it is prepared when it is first seen and kept until four others were.

Inside is where the generalized winding number is beyond 1/2, either way round. On closed meshes
whose faces are oriented alike that is what trimesh finds. It differs where trimesh has no sound
answer: next to holes, where trimesh takes the side of the nearest face, and in overlaps of closed
parts, which count as inside here and by `trimesh.Trimesh.contains` as outside. Where several
triangles are equally near, another one of them may be named. Bad input raises TypeError or
ValueError.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from .._arrays import Floats, as_array, floats
from .._space import SDF
from .._surfaces import PointCloud
from ._arguments import missing
from ._nearest import Nearest, prepared

_MERGE = 1e-8  # trimesh.tol.merge

Ids = npt.NDArray[np.int64]


_INSTEAD = {
    "NearestQueryResult": "closest_point returns points, distances and triangles",
    "closest_point_naive": "closest_point has the same answers",
}


def __getattr__(name: str) -> Any:
    raise missing(__name__, "trimesh", _INSTEAD, name)


def _points(points: Any) -> Floats:
    """m x 3 of double precision, as trimesh computes whatever it is given."""
    array = as_array(points, "points")
    if array.ndim != 2:
        array = array.reshape(-1, 3) if array.size == 0 else array
    return floats(array, "points", 3)


def _closest(near: Nearest, points: Any) -> tuple[Floats, Floats, Ids]:
    found = near.sdf.closest(_points(points))
    return found.point, found.distance, found.face.astype(np.int64)


def _signed(near: Nearest, points: Any) -> Floats:
    outward: Floats = near.signed(_points(points))
    return np.where(np.abs(outward) <= _MERGE, np.abs(outward), -outward)


def closest_point(mesh: Any, points: Any) -> tuple[Floats, Floats, Ids]:
    """The nearest points of a mesh: closest m x 3, distance m [length], triangle_id m.

    points: m x 3. Raises ValueError and TypeError for points of another shape or kind.

    >>> import littoral
    >>> closest, distance, triangle = closest_point(littoral.examples.cube(), [[.2, .3, 3]])
    >>> closest.tolist(), distance.tolist()
    ([[0.2, 0.3, 1.0]], [2.0])
    """
    return _closest(prepared(mesh), points)


def signed_distance(mesh: Any, points: Any) -> Floats:
    """m: distance from a mesh to points (m x 3), positive INSIDE [length].

    >>> import littoral
    >>> signed_distance(littoral.examples.cube(), [[.5, .5, .5], [.5, .5, 3]]).tolist()
    [0.5, -2.0]
    """
    return _signed(prepared(mesh), points)


def contains(mesh: Any, points: Any) -> npt.NDArray[np.bool_]:
    """m: whether points (m x 3) are inside; the mesh need not be watertight.

    >>> import littoral
    >>> contains(littoral.examples.cube(), [[.5, .5, .5], [.5, .5, 3]]).tolist()
    [True, False]
    """
    return prepared(mesh).inside(_points(points))


class ProximityQuery:
    """A mesh prepared once for many queries; the arguments and results of trimesh's class.

    The mesh is taken as it is at the first query: changes made to it later are not seen. `sdf` is
    the `littoral.SDF` behind it, which is negative inside.

    >>> import littoral
    >>> ProximityQuery(littoral.examples.cube()).signed_distance([[.5, .5, .5]]).tolist()
    [0.5]
    """

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh

    @cached_property
    def _near(self) -> Nearest:
        return Nearest(self._mesh)

    @property
    def sdf(self) -> SDF:
        """Negative inside, as everywhere else in littoral."""
        return self._near.sdf

    def on_surface(self, points: Any) -> tuple[Floats, Floats, Ids]:
        """As `closest_point`: m x 3, m, m."""
        return _closest(self._near, points)

    def signed_distance(self, points: Any) -> Floats:
        """As the function: m, positive inside [length]."""
        return _signed(self._near, points)

    def contains(self, points: Any) -> npt.NDArray[np.bool_]:
        """As the function: m."""
        return self._near.inside(_points(points))

    @cached_property
    def _vertices(self) -> SDF:
        points = self._near.surface.points
        return SDF(PointCloud(points, np.tile([0.0, 0.0, 1.0], (len(points), 1))), method="winding")

    def vertex(self, points: Any) -> tuple[Floats, Ids]:
        """The nearest vertices of points (m x 3): distance m [length], vertex_id m."""
        found = self._vertices.closest(_points(points))
        return found.distance, found.face.astype(np.int64)
