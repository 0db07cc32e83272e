"""Signed distance and winding numbers in space, around surfaces and clouds that may be broken."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from . import _core
from ._arguments import name_of_method, number, truth
from ._arrays import Array, Floats, Ints, as_array, floats, like, result_type
from ._errors import ArgumentError, InputError, coded
from ._foreign import as_cloud_or_surface
from ._methods import option_texts
from ._report import Report
from ._results import Reported, method_takes_kind, takes_kind
from ._settings import Progress, part, settings
from ._surfaces import Mesh, PointCloud, Surface
from ._volumes import Bounds, Volume, box_of, resolved


class Closest(NamedTuple):
    """Where an input is nearest to n points."""

    point: Array  #: n x 3, on the input
    face: Ints  #: n: face of a surface, point of a cloud
    barycentric: Array  #: n x 3: of `corners`, in [0, 1]
    corners: Ints  #: n x 3: vertices; of a polygon those of the triangle cut from it
    distance: Array  #: n [length], >= 0


def _queries(points: Any) -> tuple[Floats, Any, bool]:
    """Points as n x 3, finite or not, the type that results have, and whether one was given."""
    array = as_array(points, "points")
    if array.shape == (3,):
        return floats(array.reshape(1, 3), "points", 3, finite=False), result_type(points), True
    return floats(array, "points", 3, finite=False), result_type(points), False


class SDF(Reported):
    """Signed distance around a surface, soup or oriented cloud: negative inside [length].

    `SDF(V, F)`: vertices x 3 and faces; `SDF(P, N)`: points x 3 and normals x 3; `SDF(mesh)`: what
    `as_surface` takes. method: of `littoral.methods()["Distance in space"]`; without one, "auto":
    what has holes is completed over them, then measured. values: what distance is counted from
    [length], one number, or one for each face or point; points without normals are then balls of
    radius -value, united. flip reverses all normals; estimate_normals makes those of a cloud,
    without which and without values there is an InputError. Callable at points, from several
    threads. Points that are not n x 3 or 3 finite real numbers raise InputError;
    values that the method cannot tell apart raise UnsupportedError.

    >>> import littoral
    >>> sdf = littoral.SDF(littoral.examples.cube())
    >>> sdf([[.5, .5, .5], [.5, .5, 2]]).tolist()
    [-0.5, 1.0]
    >>> littoral.SDF([[0, 0, 0], [3, 0, 0]], values=[-1, -0.5])([2, 0, 0]).item()
    0.5
    """

    def __init__(
        self,
        V: Any,
        F: Any = None,
        *,
        method: str | None = None,
        values: Any = None,
        flip: bool = False,
        estimate_normals: bool = False,
        threads: int | None = None,
        progress: Progress | None = None,
        **options: Any,
    ) -> None:
        self.input = as_cloud_or_surface(V, F)
        counted: list[float] = []
        if values is not None:
            counted = floats(np.atleast_1d(as_array(values, "values")), "values").tolist()
        self._made = (method, flip, estimate_normals, {**options, "values": values})
        self._handle = _core.Sdf.of(
            self.input._handle,
            name_of_method(method),
            option_texts(options),
            counted,
            truth(flip, "flip"),
            truth(estimate_normals, "estimate_normals"),
            settings(threads, progress),
        )

    @classmethod
    def _of(cls, core: _core.Sdf, made: tuple[Any, ...]) -> SDF:
        self = cls.__new__(cls)
        self._handle = core
        self._made = made
        return self

    def __call__(self, points: Any, *, threads: int | None = None) -> Array:
        """n: distance at points (n x 3, or one) [length]; UnsupportedError by methods for grids."""
        x, dtype, single = _queries(points)
        values = like(self._handle.at(x, settings(threads)), dtype)
        return values[0] if single else values

    def gradient(self, points: Any, *, threads: int | None = None) -> Array:
        """Gradient at points: n x 3; zero where there is none."""
        return self.with_gradient(points, threads=threads)[1]

    def with_gradient(self, points: Any, *, threads: int | None = None) -> tuple[Array, Array]:
        """Distance (n) and gradient (n x 3) at once [length, and without a unit]."""
        x, dtype, single = _queries(points)
        values, gradients = self._handle.with_gradients(x, settings(threads))
        values, gradients = like(values, dtype), like(gradients, dtype)
        return (values[0], gradients[0]) if single else (values, gradients)

    def closest(self, points: Any, *, threads: int | None = None) -> Closest:
        """Where the input itself is nearest to points (n x 3), without what a method adds to it."""
        x, dtype, single = _queries(points)
        point, face, corners, barycentric, distance = self._handle.closest(x, settings(threads))
        out = (like(point, dtype), face, like(barycentric, dtype), corners, like(distance, dtype))
        return Closest(*(each[0] for each in out)) if single else Closest(*out)

    def winding_number(self, points: Any, *, threads: int | None = None) -> Array:
        """n: generalized winding number of the input, 1 inside and 0 outside if it is closed."""
        x, dtype, single = _queries(points)
        values = like(self._handle.winding_number(x, settings(threads)), dtype)
        return values[0] if single else values

    def confidence(self, points: Any, *, threads: int | None = None) -> Array:
        """n, 0 to 1: how sure the side is; 1 as by a closed surface, 0 half way between."""
        x, dtype, single = _queries(points)
        values = like(self._handle.confidence(x, settings(threads)), dtype)
        return values[0] if single else values

    @method_takes_kind
    def sample(
        self,
        resolution: int | None = None,
        *,
        spacing: float | None = None,
        bounds: Bounds | None = None,
        padding: float = 0.25,
        grid: Volume | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Volume:
        """Distance at the nodes of a grid around the input.

        resolution: nodes along the longest side (64), or spacing [length]. bounds: x0 y0 z0 x1 y1
        z1, or corners 2 x 3, as `bounds` has them; without, a margin of `padding` longest sides.
        grid: a volume whose nodes to use instead. Raises InputError for a box without extent and
        for a grid beside these, IoError where there is no memory for the nodes.
        as_: "pyvista" for a `pyvista.ImageData` with "distance".

        >>> import littoral
        >>> sdf = littoral.SDF(littoral.examples.cube())
        >>> sdf.sample(5, bounds=sdf.bounds).spacing.tolist()
        [0.25, 0.25, 0.25]
        """
        if grid is None:
            longest, step = resolved(resolution, spacing)
            margin = number(padding, "padding")
            nodes = _core.Grid.around(self._handle, longest, step, box_of(bounds), margin)
        else:
            _nothing_beside("a grid", resolution=resolution, spacing=spacing, bounds=bounds)
            nodes = _volume(grid, "grid")._handle.grid
        return Volume._of(self._handle.sample(nodes, settings(threads, progress)))

    @property
    def bounds(self) -> Floats:
        """The corners of the box around the input: 2 x 3 [length]."""
        return self._handle.bounds()

    @property
    def report(self) -> Report:  # type: ignore[override]
        """Of the preparation."""
        return Report(**self._handle.report())

    def __or__(self, other: SDF) -> SDF:
        return unite(self, other)

    def __and__(self, other: SDF) -> SDF:
        return intersect(self, other)

    def __sub__(self, other: SDF) -> SDF:
        return subtract(self, other)

    def __reduce__(self) -> tuple[Any, ...]:
        if isinstance(self._made[0], str) and self._made[0] in _COMBINE:
            return _combined_from, self._made
        if isinstance(self._made[0], Volume):
            return sdf_of_volume, self._made
        return _sdf_from, (self.input, *self._made)

    def __repr__(self) -> str:
        what = repr(self.input) if hasattr(self, "input") else str(self._made[0])
        return f"<littoral.SDF: {self.report.method or 'volume'} around {what}>"


def _sdf_from(
    surface: Surface, method: str | None, flip: bool, estimate: bool, options: dict[str, Any]
) -> SDF:
    return SDF(surface, method=method, flip=flip, estimate_normals=estimate, **options)


_COMBINE = {"unite": _core.unite, "intersect": _core.intersect, "subtract": _core.subtract}


def _combined_from(how: str, a: SDF, b: SDF, blend: float) -> SDF:
    if not (isinstance(a, SDF) and isinstance(b, SDF)):
        raise ArgumentError(f"{how}: expected two SDFs, got {type(a).__name__}, {type(b).__name__}")
    rounding = number(blend, "blend")
    return SDF._of(_COMBINE[how](a._handle, b._handle, rounding), (how, a, b, rounding))


def unite(a: SDF, b: SDF, blend: float = 0.0) -> SDF:
    """What is in either shape; corners where they meet are rounded `blend` from them [length].

    Signs and zero set are right; the magnitude is a bound. Also `a | b`. Raises ArgumentError for
    what is no SDF.

    >>> from littoral.examples import cube, sphere
    >>> unite(SDF(cube()), SDF(sphere()))([[-2, 0, 0], [2, .5, .5]]).tolist()
    [1.0, 1.0]
    """
    return _combined_from("unite", a, b, blend)


def intersect(a: SDF, b: SDF, blend: float = 0.0) -> SDF:
    """What is in both shapes; values and errors as `unite`'s. Also `a & b`.

    >>> from littoral.examples import cube, sphere
    >>> (intersect(SDF(cube()), SDF(sphere()))([[.5, .5, .5], [-.5, 0, 0]]) < 0).tolist()
    [True, False]
    """
    return _combined_from("intersect", a, b, blend)


def subtract(a: SDF, b: SDF, blend: float = 0.0) -> SDF:
    """The first shape without the second; values and errors as `unite`'s. Also `a - b`.

    >>> from littoral.examples import cube, sphere
    >>> (subtract(SDF(sphere()), SDF(cube()))([[.5, .5, .5], [-.5, 0, 0]]) < 0).tolist()
    [False, True]
    """
    return _combined_from("subtract", a, b, blend)


def sdf_of_volume(volume: Volume) -> SDF:
    """A volume of signed distance as an SDF, linear between its nodes; outside its box a bound.

    Raises ArgumentError for anything but a `Volume`.

    >>> float(sdf_of_volume(Volume([[[0, 0], [0, 0]], [[1, 1], [1, 1]]]))([.25, .5, .5]))
    0.25
    """
    return SDF._of(_core.Sdf.of_volume(_volume(volume, "volume")._handle), (volume,))


def _volume(value: Any, name: str) -> Volume:
    if not isinstance(value, Volume):
        raise ArgumentError(f"{name}: expected a littoral.Volume, got {type(value).__name__}")
    return value


def _nothing_beside(what: str, **given: Any) -> None:
    """Raises InputError for the first word about nodes that is given with what has its own."""
    for name, value in given.items():
        if value is not None:
            message = f"{name}: {what} has its own nodes; leave out one of the two"
            raise coded(InputError(message), "options-conflict")


@takes_kind
def signed_heat_grid(
    V: Any,
    F: Any = None,
    resolution: int | None = None,
    *,
    spacing: float | None = None,
    bounds: Bounds | None = None,
    padding: float = 0.25,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Volume:
    """Signed distance on a grid by the signed heat method [length].

    V, F, options as for `SDF`, the rest as for `SDF.sample`, `as_` too; raises as they.
    Source: Feng, Crane, A Heat Method for Generalized Signed Distance (2024), section 8.2.

    >>> import littoral
    >>> littoral.signed_heat_grid(littoral.examples.cube(), resolution=9).shape
    (9, 9, 9)
    """
    prepared = 0.1  # share of the work
    told = part(progress, 0, prepared)
    sdf = SDF(V, F, method="signed-heat", threads=threads, progress=told, **options)
    return sdf.sample(
        resolution,
        spacing=spacing,
        bounds=bounds,
        padding=padding,
        threads=threads,
        progress=part(progress, prepared, 1),
    )


@takes_kind
def offset(
    shape: Any,
    distances: float | Iterable[float],
    *,
    open: float = 0.0,
    close: float = 0.0,
    resolution: int | None = None,
    spacing: float | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> list[Surface]:
    """The surfaces at signed distances from a shape, one each [length].

    shape: a volume of distance, an SDF, or what `SDF` takes; the latter are sampled (resolution,
    spacing), and where they can be asked anywhere, vertices lie exactly at the distances, however
    coarse the grid. A volume has its own nodes. open: erode by this, then dilate, so thin parts go;
    close: the reverse, so gaps fill. Raises InputError for no distances, for a distance at which
    there is nothing, and for resolution or spacing beside a volume.
    as_: "pyvista", "trimesh" or "meshio" for a list of that library's objects.

    >>> from littoral.examples import cube
    >>> round(float(offset(cube(), .1, resolution=24)[0].points.max()), 1)
    1.1
    """
    wanted = list(floats(np.atleast_1d(as_array(distances, "distances")), "distances"))
    if not wanted:
        raise coded(InputError("distances: expected at least one, got none"), "nothing-given")
    radii = number(open, "open"), number(close, "close")
    nodes, step = resolved(resolution, spacing)
    if isinstance(shape, Volume):
        _nothing_beside("a volume", resolution=resolution, spacing=spacing)
        cores = _core.offset(shape._handle, wanted, *radii, settings(threads, progress))
    else:
        prepared = 0.0 if isinstance(shape, SDF) else 0.2  # share of the work
        if isinstance(shape, SDF):
            sdf = shape
        else:
            sdf = SDF(shape, threads=threads, progress=part(progress, 0, prepared))
        side = float(np.ptp(sdf.bounds, axis=0).max())
        reach = max(abs(d) for d in wanted) / side if side > 0 else 0.0
        padding = max(0.25, 1.5 * reach)
        if padding > 1000:
            raise InputError(f"distances: {reach:.3g} times the size of the shape, {side:.6g}")
        grid = _core.Grid.around(sdf._handle, nodes, step, None, padding)
        how = settings(threads, part(progress, prepared, 1))
        cores = _core.offset(sdf._handle, grid, wanted, *radii, how)
    return [Mesh._of(core) for core in cores]


def winding_number(V: Any, F: Any, points: Any, *, threads: int | None = None) -> Array:
    """n: generalized winding number of a surface (V, F) or cloud (P, N) at points (n x 3).

    Within about 0.001. Raises as `SDF`.
    Source: Barill, Dickson, Schmidt, Levin, Jacobson, Fast Winding Numbers for Soups and Clouds
    (2018).

    >>> winding_number(np.eye(3), [[0, 1, 2]], [[0, 0, 0]]).round(3).tolist()
    [0.125]
    """
    return SDF(V, F, method="winding").winding_number(points, threads=threads)


def fit_tori(
    P: Any,
    N: Any = None,
    *,
    flip: bool = False,
    estimate_normals: bool = False,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> PointCloud:
    """The tori that fit a cloud (P, N: n x 3) best, as a cloud that `SDF` takes; it can be saved.

    Options as of the method "tori". Raises as `SDF`, without normals too.
    Source: Feng, Generalized Distance and Winding (2026), chapter 5.

    >>> from littoral.examples import sphere
    >>> SDF(fit_tori(sphere().points, sphere().points))([[0, 0, 0], [2, 0, 0]]).round(3).tolist()
    [-1.0, 1.0]
    """
    cloud = as_cloud_or_surface(P, N)
    soup = _core.fit_tori(
        cloud._handle,
        option_texts(options),
        truth(flip, "flip"),
        truth(estimate_normals, "estimate_normals"),
        settings(threads, progress),
    )
    return PointCloud._of(_core.Mesh.from_soup(soup))
