"""Values at the nodes of grids."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import number, number_or_none, path_to_write, truth, whole
from ._arrays import Floats, as_array, contiguous, floats
from ._errors import InputError
from ._results import Shown, method_takes_kind
from ._settings import settings
from ._surfaces import Mesh, Surface, spacings, triple

# x0 y0 z0 x1 y1 z1, or the two corners, 2 x 3, as `SDF.bounds` is.
Bounds: TypeAlias = Sequence[float] | Sequence[Sequence[float]] | npt.NDArray[Any]


def resolved(resolution: Any, spacing: Any) -> tuple[int | None, float | None]:
    """How fine a grid is, checked: nodes along the longest side, or the length between nodes."""
    nodes = None if resolution is None else whole(resolution, "resolution", " of nodes")
    return nodes, number_or_none(spacing, "spacing")


def box_of(bounds: Any) -> list[float] | None:
    """A box as x0 y0 z0 x1 y1 z1; InputError for other numbers of numbers."""
    if bounds is None:
        return None
    given = as_array(bounds, "bounds")
    if given.shape == (2, 3):
        given = given.ravel()
    if given.shape != (6,) and given.dtype.kind in "fiub":
        raise InputError(
            f"bounds: expected x0 y0 z0 x1 y1 z1, or corners 2 x 3, got shape {given.shape}"
        )
    box: list[float] = floats(given, "bounds").tolist()
    return box


class Volume(Shown):
    """Values at the nodes of a grid, linear along each axis between them.

    `show` and `plot` draw its zero set and the layer of nodes in the middle of z.

    values: nx x ny x nz. Node i, j, k lies at origin + (i, j, k) * spacing [length]. Raises
    InputError for what is no such array, and for spacings that are not positive.

    >>> Volume(np.zeros((2, 3, 4)), spacing=.5).nodes()[1, 2, 3].tolist()
    [0.5, 1.0, 1.5]
    """

    _handle: _core.Volume

    def __init__(
        self,
        values: Any,
        spacing: float | Sequence[float] = 1.0,
        origin: Sequence[float] = (0.0, 0.0, 0.0),
    ) -> None:
        array = as_array(values, "values")
        if array.ndim != 3 or array.dtype.kind not in "fiub":
            raise InputError(
                f"values: expected nx x ny x nz numbers, got {array.dtype} {array.shape}"
            )
        if array.size == 0:
            raise InputError(f"values: there are none, the shape is {array.shape}")
        steps = spacings(spacing)
        grid = _core.Grid(array.shape, triple(origin, "origin"), steps)
        self._handle = _core.Volume(grid, contiguous(array.ravel(order="F"), np.float64))

    @classmethod
    def _of(cls, core: _core.Volume) -> Volume:
        self = cls.__new__(cls)
        self._handle = core
        return self

    @property
    def values(self) -> Floats:
        """nx x ny x nz, read-only, not copied."""
        return self._handle.values.reshape(tuple(self._handle.grid.n), order="F")

    @property
    def shape(self) -> tuple[int, int, int]:
        """Nodes along x, y and z."""
        nx, ny, nz = self._handle.grid.n
        return nx, ny, nz

    @property
    def spacing(self) -> Floats:
        """Between nodes, by axis [length]."""
        return self._handle.grid.spacing

    @property
    def origin(self) -> Floats:
        """Where node 0, 0, 0 lies."""
        return self._handle.grid.origin

    def nodes(self) -> Floats:
        """Where the nodes lie: nx x ny x nz x 3 [length]."""
        axes = [
            o + s * np.arange(n)
            for o, s, n in zip(self.origin, self.spacing, self.shape, strict=True)
        ]
        return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)

    @method_takes_kind
    def isosurface(
        self, level: float = 0.0, *, close_at_box: bool = False, threads: int | None = None
    ) -> Surface:
        """The surface on which the volume takes the level, larger values outside.

        Closed unless it meets the box, or with close_at_box. as_: "pyvista", "trimesh" or "meshio"
        for that library's object. InputError where the level is met nowhere, ArgumentError for
        several levels.
        """
        core = _core.isosurface(
            self._handle, number(level, "level"), truth(close_at_box, "close_at_box"),
            settings(threads),
        )  # fmt: skip
        return Mesh._of(core)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes by extension: .vti .vdb .nrrd .npy .npz, and .html .png as `show` and `plot`.

        Raises UnsupportedError for others, IoError.
        """
        self._handle.write(path_to_write(path))

    def _parts(self) -> tuple[Any, ...]:
        return "grid", self.values, self.spacing, self.origin

    def __reduce__(self) -> tuple[Any, ...]:
        return Volume, (np.array(self.values), tuple(self.spacing), tuple(self.origin))

    def __repr__(self) -> str:
        return f"<littoral.Volume: {' x '.join(str(n) for n in self.shape)} nodes>"
