"""What distance on a surface is measured from: points and curves in any of the usual forms."""

from __future__ import annotations

import copyreg
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _core
from ._arguments import integer, number, truth
from ._arrays import (
    Floats,
    as_array,
    check_range,
    floats,
    ints,
    is_vertex_list,
    narrowed,
    unwrapped,
)
from ._errors import ArgumentError, InputError, coded
from ._report import counted

_VERTEX, _EDGE, _FACE = 0, 1, 2


@dataclass(frozen=True)
class SurfacePoint:
    """A point of a surface: a vertex, a point of an edge, or of a face by barycentric coordinates.

    Make one of `vertex`, `edge` or `face`; ArgumentError for what is no number. What takes it
    raises IndexOutOfRange if it is not there.

    >>> SurfacePoint.vertex(3)
    SurfacePoint.vertex(3)
    >>> SurfacePoint.face(7, .5, .25, .25)
    SurfacePoint.face(7, 0.5, 0.25, 0.25)
    """

    on: int
    element: int
    b: tuple[float, float, float]

    def __post_init__(self) -> None:
        is_triple = isinstance(self.b, tuple) and len(self.b) == 3
        if self.on not in (_VERTEX, _EDGE, _FACE) or not is_triple:
            raise InputError(
                f"SurfacePoint: on is {self.on!r}, b is {self.b!r}; make one by vertex, edge, face"
            )

    @staticmethod
    def vertex(v: int) -> SurfacePoint:
        """A vertex by number."""
        return SurfacePoint(_VERTEX, integer(v, "v"), (1.0, 0.0, 0.0))

    @staticmethod
    def edge(e: int, t: float) -> SurfacePoint:
        """(1 - t) A + t B of the edge from A to B, which is `mesh.edges[e]`."""
        along = number(t, "t")
        return SurfacePoint(_EDGE, integer(e, "e"), (1 - along, along, 0.0))

    @staticmethod
    def face(f: int, a: float, b: float, c: float) -> SurfacePoint:
        """a A + b B + c C of the triangle A, B, C; a + b + c = 1."""
        at = number(a, "a"), number(b, "b"), number(c, "c")
        return SurfacePoint(_FACE, integer(f, "f"), at)

    def __repr__(self) -> str:
        if self.on == _VERTEX:
            return f"SurfacePoint.vertex({self.element})"
        if self.on == _EDGE:
            return f"SurfacePoint.edge({self.element}, {self.b[1]})"
        return f"SurfacePoint.face({self.element}, {self.b[0]}, {self.b[1]}, {self.b[2]})"


@dataclass(frozen=True)
class Curve:
    """A curve on a surface with what it is to its sides.

    `nodes`: vertices by number, surface points, potpourri3d's (element, [barycentric]) pairs, or
    points in space (n x 3), which are projected. Consecutive nodes need not share a face. A signed
    curve has positive distances to the left of travel. A closed one repeats its first node.
    Distance is counted from `value` [length]. What takes the curve checks the nodes, and raises as
    `distance`.

    >>> import littoral
    >>> line = littoral.Curve([2, 7, 12, 17, 22], signed=False)
    >>> littoral.distance(littoral.examples.square(4), line).values[:5].tolist()
    [0.5, 0.25, 0.0, 0.25, 0.5]
    """

    nodes: Any
    signed: bool = True
    value: float = 0.0


@dataclass(frozen=True)
class FaceChain:
    """Faces, neighbours in this order, each inside one more than the last; for winding numbers.

    faces: integers, by number. `distance` raises UnsupportedError for it.

    >>> import littoral
    >>> regions = littoral.winding(littoral.examples.square(4), littoral.FaceChain([0, 1]))
    >>> regions.region[:2].tolist()
    [0, 1]
    """

    faces: Any


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.integer, np.floating)) and not isinstance(value, bool)


def _is_node(value: Any) -> bool:
    """A SurfacePoint or a pair (element, [barycentric])."""
    if isinstance(value, SurfacePoint):
        return True
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        return False
    element, b = value
    if not isinstance(element, (int, np.integer)) or isinstance(element, bool):
        return False
    if isinstance(b, (tuple, list)):
        return all(_is_number(each) for each in b)
    return getattr(b, "ndim", None) == 1


def _node(value: Any, name: str) -> SurfacePoint:
    if isinstance(value, SurfacePoint):
        return value
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
        return SurfacePoint.vertex(integer(value, name))
    if not _is_node(value):
        raise ArgumentError(
            f"{name}: expected a vertex, a SurfacePoint or (element, [barycentric]), got {value!r}"
        )
    element, b = value
    b = floats(b, f"{name}'s barycentric coordinates")
    if len(b) == 0:
        return SurfacePoint.vertex(element)
    if len(b) == 1:
        return SurfacePoint.edge(element, b[0])
    if len(b) == 3:
        return SurfacePoint.face(element, b[0], b[1], b[2])
    raise InputError(
        f"{name}: expected no barycentric coordinate (a vertex), one (an edge) or three (a face), "
        f"got {len(b)}"
    )


def point_arrays(value: Any, mesh: Any, name: str) -> _core.Points:
    """Points of a surface in any of the ways, checked against it.

    Raises IndexOutOfRange for elements that do not exist.
    """
    value = unwrapped(value, name)
    if is_vertex_list(value):
        vertices = np.atleast_1d(as_array(value, name))
        vertices = vertices.reshape(-1)
        if vertices.size == 0:
            vertices = vertices.astype(np.int32)
        if vertices.dtype.kind not in "iuO":  # spans of time are integers to numpy
            raise ArgumentError(f"{name}: expected vertices, got {vertices.dtype}")
        check_range(vertices, mesh.n_vertices, name, "vertices")
        b = np.zeros((len(vertices), 3))
        b[:, 0] = 1
        return _core.Points(np.zeros(len(vertices), np.int32), narrowed(vertices, name), b)
    if _is_node(value):
        value = [value]
    is_one = isinstance(value, str) or getattr(value, "ndim", 1) == 0
    if is_one or not isinstance(value, Iterable):
        raise ArgumentError(f"{name}: expected vertices or surface points, got {value!r}")
    nodes = [_node(v, f"{name}[{i}]") for i, v in enumerate(value)]
    on = np.array([p.on for p in nodes], np.int32)
    counts = {
        _VERTEX: (mesh.n_vertices, "vertices"),
        _EDGE: (mesh.n_edges, "edges"),
        _FACE: (mesh.n_faces, "faces"),
    }
    for i, p in enumerate(nodes):  # before numpy, which has no room for any integer
        count, of = counts[p.on]
        if not 0 <= p.element < count:
            check_range(np.array([p.element]), count, f"{name}[{i}]", of)
    element = np.array([p.element for p in nodes], np.int32)
    b = np.array([p.b for p in nodes], np.float64).reshape(-1, 3)
    floats(b, f"{name}'s barycentric coordinates", 3)
    return _core.Points(on, element, b)


def _space_points(value: Any) -> Floats | None:
    """n x 3 real numbers, or None where the value is something else."""
    if isinstance(value, (list, tuple)) and value and (_is_node(value[0]) or _is_number(value[0])):
        return None
    try:
        array = as_array(value, "curve")
    except (InputError, TypeError):
        return None
    if array.dtype.kind == "f" and array.ndim == 2:
        return floats(array, "a curve in space", 3)
    return None


def _is_one_curve(value: Any) -> bool:
    if isinstance(value, (Curve, FaceChain)) or is_vertex_list(value):
        return True
    if isinstance(value, Sequence) and not isinstance(value, str):
        return len(value) > 0 and (_is_node(value[0]) or _is_mixed(value))
    return not isinstance(value, np.ndarray) or (value.dtype.kind == "f" and value.ndim == 2)


def _is_mixed(value: Sequence[Any]) -> bool:
    """Vertices and other nodes together."""
    return any(isinstance(v, (int, np.integer)) for v in value)


def _curves(value: Any) -> list[Any]:
    """One or several curves as a list of them."""
    if value is None or (isinstance(value, (list, tuple)) and not value):
        return []
    value = unwrapped(value, "curves")
    if isinstance(value, np.ndarray) and value.dtype.kind == "f" and value.ndim not in (2, 3):
        raise ArgumentError(
            "curves: expected vertices (integers) or points in space (n x 3), "
            f"got {value.dtype} of shape {value.shape}"
        )
    if not isinstance(value, (Curve, FaceChain, Iterable, int, np.integer)):
        raise ArgumentError(f"curves: expected one or several, got {value!r}")
    if isinstance(value, (list, tuple)) and _space_points(value) is not None:
        return [np.asarray(value, np.float64)]
    if _is_one_curve(value) or not isinstance(value, Iterable):
        return [value]
    return list(value)


def make_sources(
    mesh: Any, curves: Any = None, points: Any = None, signed: Any = None, values: Any = None
) -> _core.Sources:
    """The sources on a mesh; `signed` is one truth value for all curves or one for each.

    `values`: one number for all sources, or one for each curve and then for each point.
    """
    if isinstance(curves, _core.Sources):
        _check_alone(points=points, signed=signed, values=values)
        return curves
    out = _core.Sources()
    given = _curves(curves)
    signs = _signs(signed, len(given))
    on_mesh = None if points is None else point_arrays(points, mesh, "points")
    n_points = 0 if on_mesh is None else len(on_mesh)
    counts = None if values is None else _values(values, len(given), n_points)
    for i, (curve, sign) in enumerate(zip(given, signs, strict=True)):
        name = f"curves[{i}]"
        if isinstance(curve, FaceChain):
            faces = ints(np.atleast_1d(as_array(curve.faces, name)), name)
            check_range(faces, mesh.n_faces, name, "faces")
            out.add_chain(faces)
            continue
        is_signed = True if sign is None else bool(sign)
        value = 0.0 if counts is None else float(counts[i])
        if isinstance(curve, Curve):
            is_signed = truth(curve.signed, f"{name}.signed") if sign is None else bool(sign)
            value = number(curve.value, f"{name}.value") if counts is None else value
            curve = curve.nodes
        in_space = _space_points(curve)
        if in_space is not None:
            out.add_space_curve(in_space, is_signed, value)
        else:
            nodes = point_arrays(curve, mesh, name)
            if len(nodes) == 1:
                raise InputError(f"{name}: a curve needs at least two nodes; points= takes points")
            out.add_curve(nodes, is_signed, value)
    if on_mesh is not None:
        out.add_points(on_mesh, np.zeros(n_points) if counts is None else counts[len(given) :])
    return out


def _check_alone(**given: Any) -> None:
    """Raises InputError for the first of the words that curves with their own do not go with."""
    for name, value in given.items():
        if value is not None:
            message = f"{name}: curves of a file or of regions come with their own; leave it out"
            raise coded(InputError(message), "options-conflict")


def _signs(signed: Any, n_curves: int) -> list[Any]:
    """Of each curve whether it is signed, None where that is not said."""
    if signed is None or isinstance(signed, (bool, np.bool_)):
        return [signed] * n_curves
    if isinstance(signed, str) or not isinstance(signed, Iterable):
        raise ArgumentError(
            f"signed: expected True, False or one of these for each curve, got {signed!r}"
        )
    signs = list(signed)
    if len(signs) != n_curves:
        raise InputError(
            f"signed: there are {counted(len(signs), 'truth value')} for "
            f"{counted(n_curves, 'curve')}"
        )
    return signs


def _values(values: Any, n_curves: int, n_points: int) -> Floats:
    """What distance is counted from: curves, then points."""
    out = floats(np.atleast_1d(as_array(values, "values")), "values")
    if as_array(values, "values").ndim == 0:
        return np.full(n_curves + n_points, out[0])
    if len(out) != n_curves + n_points:
        raise InputError(
            f"values: expected one number or one for each of {counted(n_curves, 'curve')} and "
            f"{counted(n_points, 'point')}, got {len(out)}"
        )
    return out


def sources_state(sources: _core.Sources) -> tuple[Any, ...]:
    """Sources as plain data."""
    n_curves, _, n_space, n_chains = sources.sizes()
    curves = [sources.curve(i) for i in range(n_curves)]
    return (
        [(points.arrays(), signed, value) for points, signed, value in curves],
        (sources.points().arrays(), sources.point_values()),
        [sources.space_curve(i) for i in range(n_space)],
        [sources.chain(i) for i in range(n_chains)],
    )


def sources_from(state: tuple[Any, ...]) -> _core.Sources:
    """The sources of such data."""
    out = _core.Sources()
    curves, points, space, chains = state
    for arrays, signed, value in curves:
        out.add_curve(_core.Points(*arrays), signed, value)
    arrays, values = points
    out.add_points(_core.Points(*arrays), values)
    for nodes, signed, value in space:
        out.add_space_curve(nodes, signed, value)
    for faces in chains:
        out.add_chain(np.asarray(faces, np.int32))
    return out


def _reduced(sources: _core.Sources) -> tuple[Any, ...]:
    return sources_from, (sources_state(sources),)


copyreg.pickle(_core.Sources, _reduced)
