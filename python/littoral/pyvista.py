"""`mesh.littoral` on pyvista.PolyData: distance, winding numbers, signed distance and offsets.

    import littoral.pyvista
    mesh.littoral.distance(curves=[[0, 1, 2]]).plot(scalars="distance")

PyVista 0.48 and later import this module by themselves when `littoral` is first asked of a mesh;
with earlier versions importing it is enough. Lengths are in the unit of the mesh.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
import pyvista

from ._arrays import Array
from ._distance import DistanceSolver
from ._errors import InputError
from ._foreign import as_surface
from ._regions import winding
from ._space import SDF, offset
from ._surfaces import Surface


def _words(what: str, options: dict[str, Any]) -> tuple[Any, ...]:
    """What is prepared with these options; arrays and lists by their numbers."""
    words: list[Any] = [what]
    for name, value in sorted(options.items()):
        if isinstance(value, (list, tuple, np.ndarray)):
            array = np.asarray(value)
            value = array.dtype.str, array.shape, array.tobytes()
        words.append((name, value))
    return tuple(words)


class Accessor:
    """What littoral computes on one `pyvista.PolyData`.

    What is prepared for the mesh is kept until its points or faces change.
    """

    def __init__(self, mesh: Any) -> None:
        self._mesh = mesh
        self._surface: Surface | None = None
        self._prepared: dict[Any, Any] = {}

    @property
    def surface(self) -> Surface:
        """The mesh as a littoral surface: a point cloud where it has no faces."""
        now = as_surface(self._mesh)
        names = ("points", "corners", "face_offsets", "normals")
        if self._surface is None or not all(
            np.array_equal(getattr(now, name), getattr(self._surface, name)) for name in names
        ):
            self._surface, self._prepared = now, {}
        return self._surface

    def distance(self, curves: Any = None, points: Any = None, **options: Any) -> Any:
        """A copy of the mesh with point data "distance" from curves and points [length].

        Arguments as for `littoral.distance`, `signed`, `values`, `method` and its options among
        them.
        """
        surface = self.surface
        signed, values = options.pop("signed", None), options.pop("values", None)
        words = _words("distance", options)
        if words not in self._prepared:
            self._prepared[words] = DistanceSolver(surface, **options)
        field = self._prepared[words].solve(curves, points, signed=signed, values=values)
        out = self._mesh.copy()
        out.point_data["distance"] = np.array(field.values)
        return out

    def winding(self, curves: Any, **options: Any) -> Any:
        """A copy of the mesh with cell data "winding", an integer a face; as `littoral.winding`."""
        surface = self.surface
        if surface.n_faces != self._mesh.n_cells:
            raise InputError(
                f"mesh: expected faces only, got {self._mesh.n_cells} cells of which "
                f"{surface.n_faces} are faces"
            )
        regions = winding(surface, curves, **options)
        out = self._mesh.copy()
        out.cell_data["winding"] = np.array(regions.region)
        return out

    def sdf(self, points: Any, **options: Any) -> Array:
        """n: signed distance in space at points (n x 3), negative inside; as `littoral.SDF`."""
        return self._sdf(options)(points)

    def _sdf(self, options: dict[str, Any]) -> SDF:
        surface = self.surface
        words = _words("sdf", options)
        if words not in self._prepared:
            self._prepared[words] = SDF(surface, **options)
        made: SDF = self._prepared[words]
        return made

    def offset(self, distances: float | Iterable[float], **options: Any) -> Any:
        """PolyData at a signed distance, or a list at several, outward positive [length].

        Options as for `littoral.offset`: resolution, spacing, open, close.
        """
        single = isinstance(distances, (int, float, np.number)) or (
            isinstance(distances, np.ndarray) and distances.ndim == 0
        )
        wanted = [float(distances)] if single else list(distances)  # type: ignore[arg-type]
        found = offset(self._sdf({}), wanted, as_="pyvista", **options)
        return found[0] if single else found


def _register() -> None:
    if hasattr(pyvista, "register_dataset_accessor"):
        pyvista.register_dataset_accessor("littoral", pyvista.PolyData)(Accessor)
    else:
        pyvista.PolyData.littoral = property(Accessor)  # type: ignore[attr-defined, unused-ignore]


_register()
