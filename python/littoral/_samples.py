"""Samples of a shape for learning."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Sequence
from typing import Any

import numpy as np

from . import _core
from ._arguments import name_of_method, number, path_to_write, text, truth, whole
from ._arrays import Floats, Ints, as_array, floats
from ._errors import InputError
from ._foreign import as_cloud_or_surface
from ._methods import Options, option_texts
from ._report import Report
from ._results import Reported
from ._settings import Progress, settings
from ._surfaces import Mesh, Surface


class _Made:
    """The library's samples. They never change; unpickled, they are made again when asked for."""

    def __init__(
        self,
        shape: Surface,
        method: str,
        options: Options,
        oriented: tuple[bool, bool],
        how: dict[str, Any],
    ) -> None:
        self._state = (shape, method, options, oriented, how)
        self._core: _core.Samples | None = None

    def core(self, settings: _core.Settings | None = None) -> _core.Samples:
        if self._core is None:
            shape, method, options, oriented, how = self._state
            all_how = _core.SampleOptions()
            for name, value in how.items():
                in_words = name == "numbers"
                setattr(all_how, name, _core.SampleNumbers[value] if in_words else value)
            self._core = _core.sample(shape._handle, all_how, method, options, *oriented, settings)
        return self._core

    def __deepcopy__(self, memo: Any) -> _Made:
        return self

    def __reduce__(self) -> tuple[Any, ...]:
        return _Made, self._state


class Samples(Reported):
    """Points on and around a shape, in the cube [-1, 1]^3, and what is known of them.

    A point x of the input is at (x - centre) / half_side. Lengths are in half sides of the cube.
    Unpickled ones make the samples again, the same bits, when they are first saved.

    >>> import littoral
    >>> made = littoral.samples(littoral.examples.cube(), surface=10, space=20, resolution=16)
    >>> made.points.shape, made.surface_normals.shape, round(made.half_side, 3)
    ((20, 3), (10, 3), 0.6)
    """

    def __init__(self, made: _Made) -> None:
        self._made = made
        core = made.core()
        self.points: Floats = core.points  #: n x 3
        self.distances: Floats = core.distances  #: n: negative inside
        self.confidence: Floats = core.confidence  #: n: 0 to 1, of inside and outside
        self.kinds: Ints = core.kinds  #: n: 0 uniform, 2 near the surface, 3 where normals turn
        self.deviations: Floats = core.deviations  #: n: how far from the surface, as a scale
        self.surface_points: Floats = core.surface_points  #: m x 3
        self.surface_normals: Floats = core.surface_normals  #: m x 3, outward
        self.surface_confidence: Floats = core.surface_confidence  #: m
        self.surface_kinds: Ints = core.surface_kinds  #: m: 0 uniform, 1 where normals turn
        self.centre: Floats = core.centre  #: 3: of the input's box [length]
        self.half_side: float = core.half_side  #: of the cube [length]
        self.report = Report(**core.report())  #: method, warnings and figures of quality
        self._card = core.card("")

    @functools.cached_property
    def surface(self) -> Mesh:
        """A closed surface of the shape, in the cube."""
        return Mesh._of(self._made.core().surface)

    def card(self, name: str = "") -> dict[str, Any]:
        """Version, options, normalisation, quality and warnings; ArgumentError for no text."""
        return {**json.loads(self._card), "input": text(name, "name")}

    def save(self, path: str | os.PathLike[str], name: str = "") -> None:
        """Writes .npz, .zarr or .tar, and the card as .json; UnsupportedError, IoError."""
        to = path_to_write(path)
        self._made.core().write(to, text(name, "name"))

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "surface": self.surface}  # also where nobody has asked for it

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
    if numbers not in ("float16", "float32", "float64"):
        raise InputError(f"numbers: expected float16, float32 or float64, got {numbers!r}")
    how = {
        "resolution": whole(resolution, "resolution", " of nodes"),
        "surface": whole(surface, "surface", ""),
        "space": whole(space, "space", ""),
        "sharp": number(sharp, "sharp"),
        "uniform": number(uniform, "uniform"),
        "curvature": number(curvature, "curvature"),
        "scales": floats(np.atleast_1d(as_array(scales, "scales")), "scales").tolist(),
        "margin": number(margin, "margin"),
        "seed": whole(seed, "seed", " from 0 on", 0, 2**64 - 1),
        "numbers": numbers,
    }
    shape = as_cloud_or_surface(V, F)
    oriented = truth(flip, "flip"), truth(estimate_normals, "estimate_normals")
    made = _Made(shape, name_of_method(method), option_texts(options), oriented, how)
    made.core(settings(threads, progress))
    return Samples(made)
