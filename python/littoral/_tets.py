"""Distance through tet meshes."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

import numpy as np

from . import _core, _display
from ._arguments import name_of_method, number, number_or_none, path_to_write, truth
from ._arrays import (
    Array,
    Floats,
    Ints,
    as_array,
    check_range,
    floats,
    ints,
    like,
    narrowed,
    result_type,
)
from ._errors import ArgumentError, InputError, coded
from ._foreign import as_cloud_or_surface
from ._methods import option_texts
from ._report import Report
from ._results import Reported, Shown, method_takes_kind, takes_kind
from ._settings import Progress, part, settings
from ._surfaces import Mesh, Surface
from ._volumes import Bounds, box_of, resolved


class TetMesh:
    """Tetrahedra: V vertices x 3 [length], T tets x 4 by vertex.

    Either orientation will do. Raises ArgumentError, InputError and IndexOutOfRange as `Mesh`.

    >>> TetMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
    <littoral.TetMesh: 4 vertices, 1 tets>
    """

    def __init__(self, V: Any, T: Any) -> None:
        points = floats(V, "V", 3)
        tets = ints(T, "T", 4)
        if len(tets) == 0:
            raise InputError("T: there are no tets")
        check_range(tets, len(points), "T", "vertices")
        self._handle = _core.TetMesh(points, tets)
        self._dtype: Any = result_type(V)

    @classmethod
    def around(
        cls,
        surface: Any,
        *,
        resolution: int | None = None,
        spacing: float | None = None,
        bounds: Bounds | None = None,
        padding: float = 0.25,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> TetMesh:
        """Tets that fill a cube about a surface or cloud, small near it and larger far from it.

        resolution: cells along the cube's side if all were as small as near the surface, to a power
        of two (64), or spacing, their side [length]. bounds: x0 y0 z0 x1 y1 z1, or corners 2 x 3,
        of a box whose longest side is the cube's; without, a margin of `padding` longest sides.
        Thesis 4.5. Raises InputError for a box without extent and for more than 2^26 tets, IoError
        where memory will not do.

        >>> import littoral
        >>> cube = littoral.examples.cube()
        >>> tets = littoral.TetMesh.around(cube, resolution=17)
        >>> phi = littoral.distance(tets, cube)
        >>> phi.isosurface(-0.25).points.min(axis=0).round(3).tolist()
        [0.25, 0.25, 0.25]
        """
        nodes, step = resolved(resolution, spacing)
        margin = number(padding, "padding")
        handle = as_cloud_or_surface(surface)._handle
        how = settings(threads, progress)
        return cls._of(_core.tets_around(handle, nodes, step, box_of(bounds), margin, how))

    @classmethod
    def _of(cls, core: _core.TetMesh) -> TetMesh:
        self = cls.__new__(cls)
        self._handle = core
        self._dtype = np.float64
        return self

    @property
    def points(self) -> Floats:
        """vertices x 3, read-only, not copied [length]."""
        return self._handle.points

    @property
    def tets(self) -> Ints:
        """tets x 4, by vertex, read-only, not copied."""
        return self._handle.tets

    @property
    def n_vertices(self) -> int:
        """Vertices."""
        return len(self.points)

    @property
    def n_tets(self) -> int:
        """Tets."""
        return len(self.tets)

    @method_takes_kind
    def isosurface(self, values: Any, level: float = 0.0, *, threads: int | None = None) -> Surface:
        """The surface on which values at the vertices are the level, larger ones outside.

        Closed unless it meets the boundary of the tets. as_: "pyvista", "trimesh" or "meshio" for
        that library's object. Raises InputError where the level is met nowhere and for values that
        are not finite.

        >>> import littoral
        >>> tets = littoral.TetMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
        >>> tets.isosurface([0, 1, 1, 1], 0.5)
        <littoral.Mesh: 3 vertices, 1 faces>
        """
        numbers = floats(np.ravel(as_array(values, "values")), "values", finite=False)
        at = number(level, "level")
        return Mesh._of(self._handle.isosurface(numbers, at, settings(threads)))

    def _vertices(self, chosen: Any, name: str) -> Ints:
        """Vertices by number, checked; none for None."""
        if chosen is None:
            return np.empty(0, np.int32)
        try:
            array = np.atleast_1d(as_array(chosen, name))
        except InputError:
            raise ArgumentError(f"{name}: expected vertices of the tets, got {chosen!r}") from None
        if array.dtype.kind not in "iu" and array.size:
            raise ArgumentError(
                f"{name}: expected vertices of the tets, as integers, got {array.dtype}"
            )
        check_range(array, self.n_vertices, name, "vertices")
        return narrowed(array.ravel().astype(np.int64), name)

    def __reduce__(self) -> tuple[Any, ...]:
        return TetMesh, (like(np.array(self.points), self._dtype), np.array(self.tets))

    def __repr__(self) -> str:
        return f"<littoral.TetMesh: {self.n_vertices} vertices, {self.n_tets} tets>"


class TetField(Reported, Shown):
    """Distance at the vertices of a tet mesh: `values` [length], +inf where no source reaches.

    `report`: the method's `Report`.

    >>> import littoral
    >>> tets = littoral.TetMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
    >>> littoral.tet_distance(tets, vertices=0)
    <littoral.TetField: 4 vertices, by auto, converged>
    """

    def __init__(self, core: _core.TetField, mesh: TetMesh) -> None:
        self._handle = core
        self.mesh = mesh
        self.values: Array = like(core.values, mesh._dtype)
        self.report = Report(**core.report())

    @method_takes_kind
    def isosurface(self, level: float = 0.0, *, threads: int | None = None) -> Surface:
        """The surface on which the distance is the level; raises as `TetMesh.isosurface`."""
        return self.mesh.isosurface(self.values, level, threads=threads)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes by extension: .vtk .vtu the tets, .ply .obj .glb .vtp their boundary, .csv .tsv
        .npy .npz .txt values, .html .png as `show`; UnsupportedError for others, IoError.
        """
        self._handle.write(path_to_write(path))

    def show(
        self,
        path: str | os.PathLike[str] | None = None,
        *,
        axis: str = "z",
        slice: float | None = None,
    ) -> Any:
        """The page of the boundary, as `littoral.show`.

        Cut open at the coordinate `slice` across an axis "x", "y" or "z"; without one in the middle
        of z if the boundary has one value all over, as distance from it has, else nowhere. Raises
        InputError for another axis, and for a plane that misses the tets.
        """
        return _display.show(_Cut(self, axis, slice), path)

    def plot(self, ax: Any = None, *, axis: str = "z", slice: float | None = None) -> Any:
        """The same as a picture in matplotlib axes: in `ax` or new ones, returned; raises as it."""
        return _display.plot(_Cut(self, axis, slice), ax)

    def _write_page(self, path: str) -> None:
        _Cut(self)._write_page(path)

    def _write_picture(self, path: str) -> None:
        _Cut(self)._write_picture(path)

    def _parts(self) -> tuple[Any, ...]:
        return "tets", self.mesh.points, self.mesh.tets, {"distance": self.values}

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> Array:
        return np.array(self.values, dtype=dtype, copy=True if copy is None else copy)

    def __reduce__(self) -> tuple[Any, ...]:
        return _tet_field_from, (self.mesh, np.array(self._handle.values), self._handle.report())

    def __repr__(self) -> str:
        return (
            f"<littoral.TetField: {len(self.values)} vertices, by {self.report.method}, "
            f"{self.report.status}>"
        )


class _Cut(Shown):
    """A field cut open, to be shown."""

    def __init__(self, field: TetField, axis: str = "z", slice: float | None = None) -> None:
        if axis not in ("x", "y", "z"):
            raise InputError(f"axis: expected 'x', 'y' or 'z', got {axis!r}")
        self._handle = field._handle
        self._at = "xyz".index(axis), number_or_none(slice, "slice")

    def _write_page(self, path: str) -> None:
        self._handle.write_page(path, *self._at)

    def _write_picture(self, path: str) -> None:
        self._handle.write_picture(path, *self._at)


def _tet_field_from(mesh: TetMesh, values: Floats, report: dict[str, Any]) -> TetField:
    return TetField(_core.TetField.of(mesh._handle, values, report), mesh)


class TetDistanceSolver:
    """A method prepared for one tet mesh; may be used from several threads.

    method: a name of `littoral.methods()["Distance through tets"]`; without one "auto": signed from
    surfaces, unsigned from vertices, exact where the source is in sight. Raises ArgumentError for
    another mesh, InputError for an unknown method or option.

    >>> import littoral
    >>> tets = littoral.TetMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
    >>> solver = littoral.TetDistanceSolver(tets, "quadratic")
    >>> solver.solve(vertices=0).values.round(2).tolist()
    [0.0, 1.0, 1.0, 1.0]
    """

    def __init__(
        self,
        mesh: TetMesh,
        method: str | None = None,
        *,
        threads: int | None = None,
        progress: Progress | None = None,
        **options: Any,
    ) -> None:
        if not isinstance(mesh, TetMesh):
            raise ArgumentError(f"mesh: expected a littoral.TetMesh, got {type(mesh).__name__}")
        self.mesh = mesh
        self._choice = (method, options)
        self._handle = _core.TetDistanceSolver(
            mesh._handle,
            name_of_method(method),
            option_texts(options),
            settings(threads, progress),
        )

    @method_takes_kind
    def solve(
        self,
        surface: Any = None,
        vertices: Any = None,
        *,
        boundary: bool = False,
        flip: bool = False,
        estimate_normals: bool = False,
        points: Any = None,
        values: Any = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> TetField:
        """Distance from a surface or cloud (signed), from vertices, or from the boundary.

        points: `vertices` by the name that `DistanceSolver` has for them. flip reverses the
        normals; estimate_normals makes those of a cloud. values: what distance is counted from
        [length], one number or one for each vertex and then the boundary, for each face of the
        surface or for each point of the cloud. as_: "pyvista" or "meshio" for the tets as that
        library's object, with "distance". Raises InputError where no source lies in a tet,
        IndexOutOfRange.
        """
        if points is not None and vertices is not None:
            raise ArgumentError("points and vertices: give one of them; here they mean the same")
        if surface is None and (flip or estimate_normals):
            word = "flip" if flip else "estimate_normals"
            message = f"{word}: there is no surface or cloud whose normals that means; leave it out"
            raise coded(InputError(message), "options-conflict")
        given = self.mesh._vertices(points if vertices is None else vertices, "vertices")
        shape = None if surface is None else as_cloud_or_surface(surface)._handle
        counted: list[float] = []
        if values is not None:
            counted = floats(np.atleast_1d(as_array(values, "values")), "values").tolist()
        sources = _core.TetSources(
            shape,
            given.tolist(),
            truth(boundary, "boundary"),
            truth(flip, "flip"),
            truth(estimate_normals, "estimate_normals"),
            counted,
        )
        return TetField(self._handle.solve(sources, settings(threads, progress)), self.mesh)

    def _matrix(
        self, sources: Any, targets: Any, threads: int | None, tell: Callable[..., Any]
    ) -> Array:
        """sources x targets, or x vertices: one solve for each source [length].

        tell(begin, end): whom a solve tells that is this share of the work.
        """
        rows = self.mesh._vertices(sources, "sources")
        chosen = range(self.mesh.n_vertices) if targets is None else targets
        columns = self.mesh._vertices(chosen, "targets")
        out = np.empty((len(rows), len(columns)), self.mesh._dtype)
        for i, (row, source) in enumerate(zip(out, rows, strict=True)):
            progress = tell(i / len(rows), (i + 1) / len(rows))
            row[:] = self.solve(vertices=source, threads=threads, progress=progress).values[columns]
        return out

    def __reduce__(self) -> tuple[Any, ...]:
        return _tet_solver_from, (self.mesh, *self._choice)

    def __repr__(self) -> str:
        name = self._choice[0] or "default method"
        return f"<littoral.TetDistanceSolver: {name} on {self.mesh!r}>"


def _tet_solver_from(
    mesh: TetMesh, method: str | None, options: dict[str, Any]
) -> TetDistanceSolver:
    return TetDistanceSolver(mesh, method, **options)


@takes_kind
def tet_distance(
    mesh: TetMesh,
    surface: Any = None,
    vertices: Any = None,
    *,
    boundary: bool = False,
    flip: bool = False,
    estimate_normals: bool = False,
    values: Any = None,
    method: str | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> TetField:
    """Distance through tets, once: `TetDistanceSolver` and its `solve` in one call; raises as they.

    >>> import littoral
    >>> tets = littoral.TetMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 1, 2, 3]])
    >>> littoral.tet_distance(tets, vertices=0, method="quadratic").values.round(2).tolist()
    [0.0, 1.0, 1.0, 1.0]
    >>> littoral.tet_distance(tets, vertices=[0, 1], values=[0, 0.5]).values.round(2).tolist()
    [0.0, 0.5, 1.0, 1.0]
    """
    prepared = 0.2  # share of the work
    solver = TetDistanceSolver(
        mesh, method, threads=threads, progress=part(progress, 0, prepared), **options
    )
    return solver.solve(
        surface,
        vertices,
        boundary=boundary,
        flip=flip,
        estimate_normals=estimate_normals,
        values=values,
        threads=threads,
        progress=part(progress, prepared, 1),
    )
