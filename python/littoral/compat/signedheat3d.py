"""The solvers of the package signedheat3d by littoral.

    from littoral.compat.signedheat3d import SignedHeatGridSolver, SignedHeatTetSolver

Signs are signedheat3d's: negative on the side that normals point away from, so NEGATIVE INSIDE a
surface oriented outward. Lengths are in the unit of the input. Where no box is given it is the cube
about the vertices' mean whose half side is twice their largest distance from it.

Options are a dict of: t_coef (1), diffusion time over h^2, h as in littoral's `time_scale`;
bbox_min and bbox_max, 3 each; resolution, nodes by axis (32); level_set_constraint, "ZeroSet" (the
default), "Multiple" (one value along each part of the input) or "None". A box or a resolution that
is not positive counts as not given, as there. Without a resolution the previous one stays. Unknown
options and bad input raise ValueError, TypeError or IndexError.

The grid solver has the same nodes as signedheat3d's, and zero in every cell that the input meets,
whatever level_set_constraint says, as there.
The tet solver differs in its tets: signedheat3d cuts the box by tetgen along the input, whose
vertices and faces are then some of the tets'; here tets are about as small as the input's faces
near it, or as `resolution[0]` nodes along the box's longest side are apart, and larger far from it.
So vertices differ in number and place, `get_vertices` says where they are, and the zero set is met
up to a part of a tet. In a box that is no cube they reach beyond its shorter sides by less than a
tet.

A solver keeps its grid while box and resolution stay, its tets and what it made of the input while
that stays as well. verbose: a line on the standard error for every distance.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from .._arguments import number
from .._arrays import Array, Floats, Ints, as_array, floats
from .._errors import InputError
from .._report import Report
from .._space import SDF
from .._surfaces import Mesh, PointCloud, Polygons, Surface
from .._tets import TetDistanceSolver, TetMesh
from .._volumes import Volume

_KNOWN = ("level_set_constraint", "t_coef", "bbox_min", "bbox_max", "resolution", "verbose")
_DEFAULTS: Mapping[str, Any] = MappingProxyType({})
_MOST_PIECES = 12_000  # that tets are made for: some hundred thousands of them
_CONSTRAINTS = {"zeroset": "zero-set", "multiple": "level-sets", "none": "none"}


def _surface(V: Any, F: Any) -> Surface:
    """Of an array of faces, or of a list of lists."""
    if not isinstance(F, (list, tuple)):
        return Mesh(V, F)
    faces = [list(face) for face in F]
    if faces and all(len(face) == 3 for face in faces):
        return Mesh(V, np.array(faces))
    return Polygons(V, faces)


class _Options:
    """The options of one call, checked; `box` and `resolution` are None where not given."""

    def __init__(self, given: Mapping[str, Any], t_coef: float = 1.0) -> None:
        for name in given:
            if name not in _KNOWN:
                raise InputError(f"options: {name!r} is unknown; there are {', '.join(_KNOWN)}")
        self.time_scale = number(given.get("t_coef", t_coef), "t_coef")
        if not 0 < self.time_scale < np.inf:
            raise InputError(f"t_coef: expected a positive number, got {self.time_scale}")
        self._level_set = str(given.get("level_set_constraint", "ZeroSet"))
        low = self._triple(given.get("bbox_min", (1, 1, 1)), "bbox_min")
        high = self._triple(given.get("bbox_max", (-1, -1, -1)), "bbox_max")
        self.box = np.stack([low, high]) if (high > low).all() else None
        nodes = self._triple(given.get("resolution", (0, 0, 0)), "resolution")
        if (nodes != np.floor(nodes)).any():
            raise InputError(f"resolution: expected integers, got {nodes.tolist()}")
        self.resolution = nodes.astype(int) if (nodes > 0).all() else None
        if self.resolution is not None and (self.resolution < 2).any():
            raise InputError(f"resolution: expected at least 2 nodes, got {nodes.tolist()}")

    @property
    def constraint(self) -> str:
        """In littoral's words."""
        name = self._level_set
        if name.lower() not in _CONSTRAINTS:
            raise InputError(
                f'level_set_constraint: expected "ZeroSet", "Multiple" or "None", got {name!r}'
            )
        return _CONSTRAINTS[name.lower()]

    @staticmethod
    def _triple(value: Any, name: str) -> Floats:
        numbers = floats(np.ravel(as_array(value, name)), name)
        if numbers.shape != (3,):
            raise InputError(f"{name}: expected 3 numbers, got {numbers.size}")
        return numbers


def _box_around(points: Floats) -> Floats:
    """2 x 3: the default box."""
    centre = points.mean(axis=0)
    reach = 2 * float(np.linalg.norm(points - centre, axis=1).max())
    if not reach > 0:
        raise InputError("expected points that differ, or bbox_min and bbox_max")
    return np.stack([centre - reach, centre + reach])


class _Kept:
    """What was made last, for as long as it is asked for with the same surface and words."""

    def __init__(self) -> None:
        self._surface: Surface | None = None
        self._words: Any = None
        self._made: Any = None

    def get(self, surface: Surface, words: Any, make: Callable[[], Any]) -> Any:
        names = ("points", "corners", "face_offsets", "normals")
        if (
            self._surface is None
            or self._words != words
            or not all(
                np.array_equal(getattr(surface, n), getattr(self._surface, n)) for n in names
            )
        ):
            self._made = make()
            self._surface, self._words = surface, words
        return self._made


def _tell(verbose: bool, report: Report | None, values: Floats) -> None:
    if not verbose:
        return
    seconds = sum(report.timings.values()) if report is not None else 0.0
    took = f"{seconds:.3g} s, " if report is not None else ""
    print(
        f"signed heat: {len(values)} nodes, {took}{values.min():.6g} to {values.max():.6g}",
        file=sys.stderr,
    )


class SignedHeatGridSolver:
    """Signed distance at the nodes of a grid, from meshes and oriented clouds.

    >>> import littoral
    >>> solver = SignedHeatGridSolver(verbose=False)
    >>> cube = littoral.examples.cube()
    >>> phi = solver.compute_distance_to_mesh(cube.points, cube.faces, {"resolution": [9, 9, 9]})
    >>> phi.shape, solver.get_grid_resolution()
    ((729,), [9, 9, 9])
    >>> bool(solver.to_grid_array(phi)[4, 4, 4] < 0)
    True
    """

    def __init__(self, verbose: bool = True) -> None:
        self._verbose = bool(verbose)
        self._resolution = np.array([32, 32, 32])
        self._box: Floats = np.zeros((2, 3))
        self._kept = _Kept()

    def get_grid_resolution(self) -> list[int]:
        """Nodes along x, y and z."""
        return [int(n) for n in self._resolution]

    def get_bbox(self) -> tuple[Floats, Floats]:
        """The first and the last node: 3, 3; 0 before the first distance."""
        return self._box[0].copy(), self._box[1].copy()

    def to_grid_array(self, phi: Array) -> Array:
        """Values of nodes as nx x ny x nz; node i, j, k is number i + nx (j + ny k)."""
        values = as_array(phi, "phi")
        if values.shape != (int(np.prod(self._resolution)),):
            raise InputError(
                f"phi: expected {int(np.prod(self._resolution))} values, got shape {values.shape}"
            )
        return values.reshape(self.get_grid_resolution(), order="F").copy()

    def compute_distance_to_mesh(
        self, V: Any, F: Any, options: Mapping[str, Any] = _DEFAULTS
    ) -> Floats:
        """nx ny nz values: distance from V (vertices x 3) and F (faces x corners) [length]."""
        return self._solve(_surface(V, F), _Options(options))

    def compute_distance_to_point_cloud(
        self, P: Any, N: Any, t_coef: float = 1.0, options: Mapping[str, Any] = _DEFAULTS
    ) -> Floats:
        """nx ny nz values: distance from points x 3 with normals x 3 [length].

        t_coef: where the options have none; signedheat3d does not use this argument.
        """
        return self._solve(PointCloud(P, N), _Options(options, t_coef))

    def _solve(self, surface: Surface, options: _Options) -> Floats:
        box = _box_around(surface.points) if options.box is None else options.box
        if options.resolution is not None:
            self._resolution = options.resolution
        self._box = box
        sdf = self._kept.get(
            surface,
            options.time_scale,
            lambda: SDF(
                surface,
                method="signed-heat",
                constraint="zero-set",
                time_scale=options.time_scale,
            ),
        )
        spacing = (box[1] - box[0]) / (self._resolution - 1)
        grid = Volume(np.zeros(self._resolution), spacing.tolist(), box[0].tolist())
        values: Floats = sdf.sample(grid=grid).values.ravel(order="F").copy()
        _tell(self._verbose, None, values)
        return values


def _tets_about(surface: Surface, box: Floats, longest: int) -> TetMesh:
    """Tets that meet the box, near the surface about as small as its faces.

    So the zero set follows the input whatever the resolution is, as with tets cut along it.
    """
    low, high = surface.points.min(axis=0), surface.points.max(axis=0)
    x, y, z = high - low
    pieces = len(surface.points) if isinstance(surface, PointCloud) else surface.n_faces
    # A square for each two pieces on the box about the input.
    side = np.sqrt(4 * (x * y + y * z + z * x) / min(pieces, _MOST_PIECES))
    spacing = min(side, (box[1] - box[0]).max() / (longest - 1))
    tets = TetMesh.around(surface, spacing=float(spacing), bounds=box.ravel().tolist())
    within = ((tets.points >= box[0]) & (tets.points <= box[1])).all(axis=1)
    if within.all():
        return tets
    kept = tets.tets[within[tets.tets].any(axis=1)]
    used, T = np.unique(kept, return_inverse=True)
    return TetMesh(tets.points[used], T.reshape(-1, 4))


class SignedHeatTetSolver:
    """Signed distance at the vertices of tets, from meshes and oriented clouds.

    >>> import littoral
    >>> solver = SignedHeatTetSolver(verbose=False)
    >>> cube = littoral.examples.cube()
    >>> phi = solver.compute_distance_to_mesh(cube.points, cube.faces, {"resolution": [7, 7, 7]})
    >>> phi.shape, solver.get_vertices().shape
    ((415,), (415, 3))
    """

    def __init__(self, verbose: bool = True) -> None:
        self._verbose = bool(verbose)
        self._longest = 32
        self._tets: TetMesh | None = None
        self._kept = _Kept()
        self._solvers: dict[tuple[float, str], TetDistanceSolver] = {}

    def get_vertices(self) -> Floats:
        """vertices x 3 [length]; none before the first distance."""
        return np.zeros((0, 3)) if self._tets is None else np.array(self._tets.points)

    def get_tets(self) -> Ints:
        """tets x 4, by vertex; none before the first distance."""
        return np.zeros((0, 4), np.int32) if self._tets is None else np.array(self._tets.tets)

    def compute_distance_to_mesh(
        self, V: Any, F: Any, options: Mapping[str, Any] = _DEFAULTS
    ) -> Floats:
        """One value a vertex: distance from V (vertices x 3) and F (faces x corners) [length]."""
        return self._solve(_surface(V, F), _Options(options))

    def compute_distance_to_point_cloud(
        self, P: Any, N: Any, options: Mapping[str, Any] = _DEFAULTS
    ) -> Floats:
        """One value a vertex: distance from points x 3 with normals x 3 [length]."""
        return self._solve(PointCloud(P, N), _Options(options))

    def _solve(self, surface: Surface, options: _Options) -> Floats:
        box = _box_around(surface.points) if options.box is None else options.box
        longest = self._longest if options.resolution is None else int(options.resolution[0])
        self._longest = longest
        tets = self._kept.get(
            surface, (longest, *box.ravel()), lambda: _tets_about(surface, box, longest)
        )
        if tets is not self._tets:
            self._tets, self._solvers = tets, {}
        choice = options.time_scale, options.constraint
        if choice not in self._solvers:
            self._solvers[choice] = TetDistanceSolver(
                self._tets, "signed-heat", time_scale=choice[0], constraint=choice[1]
            )
        field = self._solvers[choice].solve(surface)
        values: Floats = np.array(field.values, np.float64)
        _tell(self._verbose, field.report, values)
        return values

    def isosurface(self, phi: Any, isoval: float = 0.0) -> tuple[Floats, list[list[int]]]:
        """Where values at the vertices take one of them: vertices x 3 and triangles.

        Larger values are outside. Raises ValueError where the value is taken nowhere.
        """
        values = floats(phi, "phi")
        if self._tets is None or len(values) != self._tets.n_vertices:
            count = 0 if self._tets is None else self._tets.n_vertices
            raise InputError(f"phi: expected {count} values, one per vertex, got {len(values)}")
        surface = self._tets.isosurface(values, isoval)
        return np.array(surface.points), np.asarray(surface.faces).tolist()
