"""Inside and outside on surfaces: the regions that (broken) curves bound."""

from __future__ import annotations

import os
from typing import Any

from . import _core
from ._arguments import name_of_method, path_to_write
from ._arrays import Array, Floats, Ints
from ._errors import InputError
from ._foreign import as_surface
from ._methods import option_texts
from ._report import Report
from ._results import Reported, Shown, takes_kind
from ._settings import Progress, settings
from ._sources import make_sources, sources_state
from ._surfaces import Surface


class Regions(Reported, Shown):
    """Winding numbers on a surface, and which curves bound.

    `region`: faces, integers: the winding number of the larger part of each face. `bounding`,
    `nonbounding`, `completed`: polylines, nodes x 3 each: the parts of the curves that bound, those
    that do not, and what was added to close them [length]. `report`: the method's `Report`.

    >>> import littoral
    >>> regions = littoral.winding(littoral.examples.square(4), [6, 8, 18, 16, 6])
    >>> regions, len(regions.bounding), len(regions.nonbounding)
    (<littoral.Regions: 32 faces, winding numbers 0, 1>, 1, 0)
    """

    _handle: _core.Regions

    def __init__(self, core: _core.Regions, mesh: Surface) -> None:
        self._handle = core
        self.mesh = mesh
        self.region: Ints = core.region
        self.bounding: list[Floats] = core.bounding
        self.nonbounding: list[Floats] = core.nonbounding
        self.completed: list[Floats] = core.completed
        self.report = Report(**core.report())

    @property
    def surface(self) -> tuple[Surface, dict[str, Array]]:
        """The surface cut along the curves, split where values jump, with its functions by name.

        Within a triangle the winding number function is sum(b winding weight) / sum(b weight).
        """
        soup = self._handle.surface()
        return Surface._of(_core.Mesh.from_soup(soup)), soup[5]

    @property
    def bounding_sources(self) -> _core.Sources:
        """The curves that bound something, for `distance(mesh, curves=...)`."""
        return self._handle.bounding_sources

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes by extension: .ply .obj .glb .vtp the cut surface, .csv .tsv .npy .npz .txt labels
        of faces, .html .png as `show` and `plot`.

        Raises UnsupportedError for other extensions, IoError where it cannot be written.
        """
        self._handle.write(path_to_write(path))

    def _parts(self) -> tuple[Any, ...]:
        return "surface", self.mesh, {}, {"winding": self.region}

    def __reduce__(self) -> tuple[Any, ...]:
        core = self._handle
        return _regions_from, (
            self.mesh,
            self.region.copy(),
            core.surface(),
            (self.bounding, self.nonbounding, self.completed),
            sources_state(core.bounding_sources),
            core.report(),
        )

    def __repr__(self) -> str:
        labels = sorted(set(self.region.tolist()))
        shown = ", ".join(str(label) for label in labels[:8]) + (" ..." if len(labels) > 8 else "")
        return f"<littoral.Regions: {len(self.region)} faces, winding numbers {shown}>"


def _regions_from(mesh: Surface, *state: Any) -> Regions:
    from ._sources import sources_from

    region, surface, (bounding, nonbounding, completed), curves, report = state
    sources = sources_from(curves)
    core = _core.Regions.of(
        mesh._handle,
        region,
        surface,
        bounding,
        nonbounding,
        completed,
        sources,
        report,
    )
    return Regions(core, mesh)


@takes_kind
def winding(
    mesh: Any,
    curves: Any,
    *,
    method: str | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Regions:
    """Winding numbers of signed curves on a triangle mesh; curves as for `distance`.

    Components without a curve are one region, 0. as_: "pyvista", "trimesh" or "meshio" for the
    mesh as that library's object, with "winding" at its faces.
    Raises UnsupportedError for other surfaces, IndexOutOfRange and InputError as `distance`.
    Source: Feng, Gillespie, Crane, Winding Numbers on Discrete Surfaces (2023).

    >>> import littoral
    >>> square = littoral.examples.square(4)
    >>> littoral.winding(square, [6, 8, 18, 16, 6]).region.tolist().count(1)
    8
    """
    surface = as_surface(mesh)
    if curves is None:
        raise InputError("curves: expected one or several, got None")
    sources = make_sources(surface, curves)
    core = _core.winding(
        surface._handle,
        sources,
        name_of_method(method),
        option_texts(options),
        settings(threads, progress),
    )
    return Regions(core, surface)
