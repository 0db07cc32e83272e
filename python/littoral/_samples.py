"""Samples of a shape for learning."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from typing import Any

from . import _core
from ._arrays import Floats, Ints
from ._errors import InputError
from ._foreign import as_cloud_or_surface
from ._methods import option_texts
from ._report import Report
from ._settings import Progress, settings
from ._surfaces import Mesh
from ._volumes import whole


class Samples:
    """Points on and around a shape, in the cube [-1, 1]^3, and what is known of them.

    A point x of the input is at (x - centre) / half_side. Lengths are in half sides of the cube.

    >>> import littoral
    >>> made = littoral.samples(littoral.examples.cube(), surface=10, space=20, resolution=16)
    >>> made.points.shape, made.surface_normals.shape, round(made.half_side, 3)
    ((20, 3), (10, 3), 0.6)
    """

    def __init__(self, handle: _core.Samples) -> None:
        self._handle = handle
        self.points: Floats = handle.points  #: n x 3
        self.distances: Floats = handle.distances  #: n: negative inside
        self.confidence: Floats = handle.confidence  #: n: 0 to 1, of inside and outside
        self.kinds: Ints = handle.kinds  #: n: 0 uniform, 2 near the surface, 3 where normals turn
        self.deviations: Floats = handle.deviations  #: n: how far from the surface, as a scale
        self.surface_points: Floats = handle.surface_points  #: m x 3
        self.surface_normals: Floats = handle.surface_normals  #: m x 3, outward
        self.surface_confidence: Floats = handle.surface_confidence  #: m
        self.surface_kinds: Ints = handle.surface_kinds  #: m: 0 uniform, 1 where normals turn
        self.centre: Floats = handle.centre  #: 3: of the input's box [length]
        self.half_side: float = handle.half_side  #: of the cube [length]

    @property
    def surface(self) -> Mesh:
        """A closed surface of the shape, in the cube."""
        return Mesh._of(self._handle.surface)

    @property
    def report(self) -> Report:
        """Method, warnings and figures of quality."""
        return Report(**self._handle.report())

    def card(self, name: str = "") -> dict[str, Any]:
        """Version, options, normalisation, quality and warnings; TypeError for no text."""
        return dict(json.loads(self._handle.card(name)))

    def save(self, path: str | os.PathLike[str], name: str = "") -> None:
        """Writes .npz, .zarr or .tar, and the card as .json; UnsupportedError, IoError."""
        self._handle.write(os.fspath(path), name)

    def __repr__(self) -> str:
        return f"<littoral.Samples: {len(self.points)} in space, {len(self.surface_points)} on it>"


def samples(
    V: Any,
    F: Any = None,
    *,
    resolution: int = 64,
    surface: int = 8192,
    space: int = 8192,
    sharp: float = 0.5,
    uniform: float = 0.25,
    curvature: float = 0.25,
    scales: Sequence[float] = (0.005, 0.02, 0.08),
    margin: float = 0.1,
    seed: int = 0,
    numbers: str = "float32",
    method: str | None = None,
    flip: bool = False,
    estimate_normals: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Samples:
    """Points on a shape with normals, and in space with distances, for learning.

    V, F, method, flip, estimate_normals and options as for `SDF`; the same bits on every machine.
    resolution: of the grid from which the closed surface comes. sharp: share of the surface's
    points that are where normals turn; uniform, curvature: shares of space's points that are
    anywhere, and near where normals turn; the rest are near the surface, at the scales, which are
    deviations in half sides of the cube. numbers: "float16", "float32" or "float64", to which
    positions are rounded before distances are taken. Raises InputError for values out of range.

    >>> import littoral
    >>> made = littoral.samples(littoral.examples.sphere(), surface=100, space=100, resolution=16)
    >>> bool(abs(made.distances[made.kinds == 2]).max() < 0.6)
    True
    """
    how = _core.SampleOptions()
    if numbers not in ("float16", "float32", "float64"):
        raise InputError(f"numbers: expected float16, float32 or float64, got {numbers!r}")
    how.numbers = getattr(_core.SampleNumbers, numbers)
    how.resolution = whole(resolution, "resolution", " of nodes")
    how.surface, how.space = whole(surface, "surface", ""), whole(space, "space", "")
    how.sharp, how.uniform, how.curvature = float(sharp), float(uniform), float(curvature)
    how.scales, how.margin = [float(x) for x in scales], float(margin)
    how.seed = whole(seed, "seed", " from 0 on", 0, 2**64 - 1)
    shape = as_cloud_or_surface(V, F)
    return Samples(
        _core.sample(
            shape._handle,
            how,
            method or "",
            option_texts(options),
            bool(flip),
            bool(estimate_normals),
            settings(threads, progress),
        )
    )
