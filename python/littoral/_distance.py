"""Distance on surfaces: once, for many sources, between many points; and what it is drawn from."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import Any, ParamSpec, Protocol, TypeVar, cast, overload

import numpy as np

from . import _core
from ._arguments import name_of_method, path_to_write
from ._arrays import Array, Floats, as_array, floats
from ._errors import ArgumentError, InputError, UnsupportedError
from ._foreign import as_surface
from ._methods import option_texts
from ._report import Report, counted
from ._results import Reported, Shown, method_takes_kind, takes_kind
from ._settings import Progress, part, settings
from ._sources import make_sources, point_arrays, sources_from, sources_state
from ._surfaces import Surface
from ._tets import TetDistanceSolver, TetField, TetMesh, tet_distance

P = ParamSpec("P")
R = TypeVar("R")
R_co = TypeVar("R_co", covariant=True)


class OnSurfaceOrTets(Protocol[P, R_co]):
    """A function of a surface whose result on a `TetMesh` is a `TetField`, with `as_`."""

    @overload
    def __call__(self, *arguments: Any, as_: str, **keywords: Any) -> Any: ...
    @overload
    def __call__(self, mesh: TetMesh, *arguments: Any, **keywords: Any) -> TetField: ...
    @overload
    def __call__(self, *arguments: P.args, **keywords: P.kwargs) -> R_co: ...


def on_surface_or_tets(call: Callable[P, R]) -> OnSurfaceOrTets[P, R]:
    """For the type checker; what is called is the same."""
    return cast("OnSurfaceOrTets[P, R]", takes_kind(call))


class Field(Reported, Shown):
    """Distance at the vertices of a surface, and what the computation says about itself.

    `values`: vertices [length], signed for signed curves, +inf where no source reaches.
    `confidence`: vertices, 0 to 1, how sure each sign is; empty unless option `confidence` was on.
    `report`: the method's `Report`. numpy takes a field for its values.

    >>> import numpy as np, littoral
    >>> field = littoral.distance(littoral.examples.square(4), points=0)
    >>> len(field), float(np.max(field).round(6)), field.warnings
    (25, 1.414214, [])
    """

    _handle: _core.Field

    def __init__(self, core: _core.Field, mesh: Surface) -> None:
        self._handle = core
        self.mesh = mesh
        self.values: Array = mesh._values(core.values)
        self.report = Report(**core.report())

    @property
    def confidence(self) -> Floats:
        """vertices, 0 to 1: how sure each sign is; empty unless asked for."""
        return self._handle.confidence

    @property
    def refined(self) -> tuple[Surface, Array] | None:
        """The surface the field lives on where that is finer or cut, and its values there."""
        soup = self._handle.refined()
        if soup is None:
            return None
        surface = Surface._of(_core.Mesh.from_soup(soup), self.mesh._dtype)
        return surface, self.mesh._values(soup[5]["distance"])

    def at(self, points: Any) -> Array:
        """n: values at points of the surface, linear between the vertices [length].

        points: vertices, (element, [barycentric]) pairs or `SurfacePoint`s; IndexOutOfRange else.

        >>> import littoral
        >>> littoral.distance(littoral.examples.square(4), points=0).at([(0, [.5])]).tolist()
        [0.125]
        """
        at = point_arrays(points, self.mesh, "points")
        return self.mesh._values(self.mesh._handle.interpolate(self._handle.values, at))

    @method_takes_kind
    def isolines(self, level: float | Iterable[float] = 0.0) -> list[Floats]:
        """The lines on which the field takes a value (or several): nodes x 3 each.

        A closed line repeats its first node; larger values are on the left. as_ and errors as for
        `littoral.isolines`.
        """
        return isolines(self.mesh, self._handle.values, level)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes by extension: .ply .obj .glb .vtp .csv .tsv .npy .npz .txt, .html .png as `show`.

        Raises UnsupportedError for other extensions, IoError where it cannot be written.
        """
        self._handle.write(path_to_write(path))

    def _parts(self) -> tuple[Any, ...]:
        return "surface", self.mesh, {"distance": self.values}, {}

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        return np.array(self.values, dtype=dtype, copy=True if copy is None else copy)

    def __len__(self) -> int:
        return len(self.values)

    def __reduce__(self) -> tuple[Any, ...]:
        state = (
            sources_state(self._handle.sources),
            np.array(self._handle.values),
            np.array(self._handle.confidence),
            self._handle.refined(),
            self._handle.report(),
        )
        return _field_from, (self.mesh, state)

    def __repr__(self) -> str:
        finite = self.values[np.isfinite(self.values)]
        span = f"{finite.min():.6g} to {finite.max():.6g}" if finite.size else "nowhere finite"
        doubts = f", {counted(len(self.warnings), 'warning')}" if self.warnings else ""
        return (
            f"<littoral.Field: {len(self.values)} vertices, {span}, by {self.report.method}, "
            f"{self.report.status}{doubts}>"
        )


def _field_from(mesh: Surface, state: tuple[Any, ...]) -> Field:
    sources, values, confidence, refined, report = state
    core = _core.Field.of(mesh._handle, sources_from(sources), values, confidence, refined, report)
    return Field(core, mesh)


class DistanceSolver:
    """A method prepared for one surface: what does not depend on the sources is computed once.

    mesh: a littoral surface, or what `as_surface` takes (pyvista, trimesh, open3d, meshio, (V, F));
    of a `TetMesh` a `TetDistanceSolver` is made. method: a name of `littoral.methods()`, None for
    the library's choice; options as keywords. May be used from several threads at once. Raises
    InputError for an unknown method or option, naming the nearest known one, and UnsupportedError
    for a method that does not run on such a surface.

    >>> import littoral
    >>> solver = DistanceSolver(littoral.examples.square(8), method="signed-heat", time_scale=1)
    >>> near, far = (solver.solve(points=v).values.max() for v in (40, 0))
    >>> bool(near < far)
    True
    """

    def __new__(cls, mesh: Any, method: str | None = None, **keywords: Any) -> Any:
        if isinstance(mesh, TetMesh):
            return TetDistanceSolver(mesh, method, **keywords)
        return super().__new__(cls)

    def __init__(
        self,
        mesh: Any,
        method: str | None = None,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
        **options: Any,
    ) -> None:
        self.mesh = as_surface(mesh)
        self._choice = (method, options)
        self._handle = _core.DistanceSolver(
            self.mesh._handle,
            name_of_method(method),
            option_texts(options),
            settings(threads, progress),
        )

    @property
    def report(self) -> Report:
        """Of the preparation."""
        return Report(**self._handle.report())

    @method_takes_kind
    def solve(
        self,
        curves: Any = None,
        points: Any = None,
        *,
        signed: Any = None,
        values: Any = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Field:
        """Distance from curves and points [length]; all arguments and errors as for `distance`."""
        sources = make_sources(self.mesh, curves, points, signed, values)
        return Field(self._handle.solve(sources, settings(threads, progress)), self.mesh)

    def __reduce__(self) -> tuple[Any, ...]:
        return _solver_from, (self.mesh, *self._choice)

    def __repr__(self) -> str:
        return f"<littoral.DistanceSolver: {self._choice[0] or 'default method'} on {self.mesh!r}>"


def _solver_from(mesh: Surface, method: str | None, options: dict[str, Any]) -> DistanceSolver:
    return DistanceSolver(mesh, method, **options)


def _through_tets(
    mesh: TetMesh, curves: Any, points: Any, signed: Any, values: Any, **keywords: Any
) -> TetField:
    """`tet_distance` with the arguments of `distance`: what stands second is the surface."""
    if signed is not None:
        raise UnsupportedError(
            "signed: distance through tets is signed from surfaces and clouds and unsigned from "
            "vertices; leave it out"
        )
    if curves is not None:
        if isinstance(curves, (list, np.ndarray)):
            raise InputError(
                "curves: distance through tets is from a surface, from vertices (points=) or from "
                "the boundary (boundary=True)"
            )
        if "surface" in keywords:
            raise ArgumentError("surface: given twice, by position and by name")
        keywords["surface"] = curves
    if points is not None:
        if "vertices" in keywords:
            raise ArgumentError("points and vertices: give one of them; here they mean the same")
        keywords["vertices"] = points
    field: TetField = tet_distance(mesh, values=values, **keywords)
    return field


@on_surface_or_tets
def distance(
    mesh: Any,
    curves: Any = None,
    points: Any = None,
    *,
    signed: Any = None,
    values: Any = None,
    method: str | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Field:
    """Distance along a surface from curves and points, at its vertices [length].

    curves: one or several of: vertices by number; (element, [barycentric]) pairs as potpourri3d has
    them; points in space (n x 3 floats), which are projected; `Curve`, `FaceChain`. They may be
    broken. signed: one truth value for all curves or one for each; signed curves (the default) have
    positive distances to the left of travel. points: vertices, pairs or `SurfacePoint`s.
    values: what distance is counted from, one number or one for each curve and then each point.
    as_: "pyvista", "trimesh" or "meshio" for the surface as that library's object, with
    "distance" at its vertices, instead of a `Field`; InputError for another name.
    Raises what `DistanceSolver` does, InputError without a source, IndexOutOfRange for one that is
    not there, ArgumentError for what is none. `littoral.methods()` names each method's paper. On a
    `TetMesh` it is `tet_distance`: the second argument is a surface, `points` are vertices and the
    result is a `TetField`.

    >>> import littoral
    >>> field = littoral.distance(littoral.examples.square(4), curves=[2, 7, 12, 17, 22])
    >>> field.values[:5].tolist()
    [0.5, 0.25, 0.0, -0.25, -0.5]
    """
    if isinstance(mesh, TetMesh):
        options.update(method=method, threads=threads, progress=progress)
        of_tets: Any = _through_tets(mesh, curves, points, signed, values, **options)
        return cast(Field, of_tets)
    surface = as_surface(mesh)
    sources = make_sources(surface, curves, points, signed, values)
    core = _core.distance(
        surface._handle,
        sources,
        name_of_method(method),
        option_texts(options),
        settings(threads, progress),
    )
    return Field(core, surface)


def distance_matrix(
    mesh: Any,
    sources: Any,
    targets: Any = None,
    *,
    method: str | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> Array:
    """Distances between points of a surface: sources x targets, or x vertices without targets.

    Both are vertices, (element, [barycentric]) pairs or `SurfacePoint`s; one solve for each source
    on shared factors, sixteen at once by the heat methods. +inf between components [length]. On a
    `TetMesh` both are vertices. Raises IndexOutOfRange for points that are not there,
    UnsupportedError and InputError as `DistanceSolver`.

    >>> import littoral
    >>> littoral.distance_matrix(littoral.examples.square(4), [0, 4], [4, 20]).round(6).tolist()
    [[1.0, 1.0], [0.0, 1.414214]]
    """
    if isinstance(mesh, TetMesh):
        prepared = 0.1  # share of the work
        solver = TetDistanceSolver(
            mesh, method, threads=threads, progress=part(progress, 0, prepared), **options
        )

        def tell(begin: float, end: float) -> Progress | None:
            scale = 1 - prepared
            return part(progress, prepared + scale * begin, prepared + scale * end)

        return solver._matrix(sources, targets, threads, tell)
    surface = as_surface(mesh)
    values, _ = _core.distance_matrix(
        surface._handle,
        point_arrays(sources, surface, "sources"),
        None if targets is None else point_arrays(targets, surface, "targets"),
        name_of_method(method),
        option_texts(options),
        settings(threads, progress),
    )
    return surface._values(values)


@takes_kind
def isolines(mesh: Any, values: Any, level: float | Iterable[float] = 0.0) -> list[Floats]:
    """Where a function given at the vertices takes a value, or several: lines, nodes x 3 each.

    A closed line repeats its first node; larger values are on the left, seen from the normals.
    values: vertices. as_: "pyvista" or "meshio" for one object of that library with all lines.
    Raises InputError for another number of values, UnsupportedError for a cloud.

    >>> import littoral
    >>> square = littoral.examples.square(4)
    >>> (line,) = littoral.isolines(square, square.points[:, 0], .3)
    >>> line.shape, line[0].round(6).tolist()
    ((9, 3), [0.3, 1.0, 0.0])
    """
    surface = as_surface(mesh)
    if surface.n_faces == 0:
        raise UnsupportedError("isolines need faces; a point cloud has none")
    given = floats(values, "values", finite=False)
    if len(given) != surface.n_vertices:
        raise InputError(f"values: expected {surface.n_vertices}, one per vertex, got {len(given)}")
    out: list[Floats] = []
    for each in floats(np.atleast_1d(as_array(level, "level")), "level"):
        out.extend(_core.isolines(surface._handle, given, float(each)))
    return out


@takes_kind
def offset_curves(
    mesh: Any,
    curves: Any,
    distances: float | Iterable[float],
    *,
    signed: Any = None,
    method: str | None = None,
    **options: Any,
) -> list[Floats]:
    """Curves at signed distances from curves on a surface, nodes x 3 each [length].

    distances: one number or several. Arguments, `as_` and errors as for `distance`, `isolines`.

    >>> import littoral
    >>> (line,) = littoral.offset_curves(littoral.examples.square(4), [2, 7, 12, 17, 22], .1)
    >>> line[:, 0].round(6).tolist()[0]
    0.4
    """
    field: Field = distance(as_surface(mesh), curves, signed=signed, method=method, **options)
    return field.isolines(distances)
