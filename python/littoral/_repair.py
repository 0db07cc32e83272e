"""Closed surfaces made of broken ones."""

from __future__ import annotations

from typing import Any

from . import _core
from ._arguments import name_of_method, number, truth
from ._foreign import as_cloud_or_surface
from ._methods import option_texts
from ._report import Report
from ._results import Reported
from ._settings import Progress, settings
from ._surfaces import Mesh, Surface
from ._volumes import resolved


class Repaired(Reported):
    """What `repair` returns: `surface`, closed, and the `report` of what was changed.

    >>> import littoral
    >>> littoral.repair(littoral.examples.cube())
    <littoral.Repaired: <littoral.Mesh: 8 vertices, 12 faces>, converged>
    """

    def __init__(self, surface: Surface, report: Report) -> None:
        self.surface = surface
        self.report = report

    def __repr__(self) -> str:
        return f"<littoral.Repaired: {self.surface!r}, {self.report.status}>"


def repair(
    V: Any,
    F: Any = None,
    *,
    resolution: int | None = None,
    spacing: float | None = None,
    error: float = 0.0,
    thicken: float = 0.0,
    smallest_part: float = 0.0,
    cavities: bool = True,
    remesh: bool = False,
    fit: bool = True,
    method: str | None = None,
    flip: bool = False,
    estimate_normals: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Repaired:
    """A closed, manifold surface that does not cross itself, from a broken one or a cloud.

    V, F and method as for `SDF`. Where orientation, doubled faces and parts within others are all
    that is wrong, the input's triangles are kept where they are, unless remesh is True. Otherwise
    the surface is taken from a grid (resolution: nodes along the longest side, 128 without, or up
    to 256 where parts are thin; or spacing [length]) and fitted to the input with its creases,
    unless fit is False.
    error: refine the grid, up to 512 nodes, until no point of the result is farther than that from
    the input or what closes it. thicken: sheets and thin parts that the surface leaves out or tears
    become walls that thick; without it, where all is sheets, three spacings. smallest_part:
    parts whose boxes have shorter diagonals go [all lengths]. cavities: keep holes inside of parts.
    The report's status is "uncertain" where the result is not sound or misses some of the input.
    InputError for a cloud without an inside and for bad values, UnsupportedError for thicken and
    error of a cloud.

    >>> import littoral
    >>> cube = littoral.examples.cube()
    >>> open_cube = littoral.Mesh(cube.points, cube.faces[:-1])
    >>> closed = repair(open_cube, resolution=24)
    >>> closed.report.sizes["input: boundary edges"], closed.report.sizes["result: boundary edges"]
    (3.0, 0.0)
    """
    nodes, step = resolved(resolution, spacing)
    core, report = _core.repair(
        as_cloud_or_surface(V, F)._handle,
        name_of_method(method),
        option_texts(options),
        truth(flip, "flip"),
        truth(estimate_normals, "estimate_normals"),
        nodes,
        step,
        number(error, "error"),
        number(thicken, "thicken"),
        number(smallest_part, "smallest_part"),
        truth(cavities, "cavities"),
        truth(remesh, "remesh"),
        truth(fit, "fit"),
        settings(threads, progress),
    )
    return Repaired(Mesh._of(core), Report(**report))
