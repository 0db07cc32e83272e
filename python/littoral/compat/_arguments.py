"""What the modules of this folder share: reading arguments as the other packages take them."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from typing import Any, NoReturn

import numpy as np
import numpy.typing as npt

from .._arguments import integer, number
from .._arrays import Floats, Ints, as_array, check_range, floats, ints
from .._distance import Field
from .._errors import ArgumentError, InputError, UnsupportedError
from .._sources import Curve, SurfacePoint
from .._surfaces import Mesh, Surface

Indices = npt.NDArray[np.int64]


def missing(module: str, package: str, instead: dict[str, str], name: str) -> AttributeError:
    """What a module's `__getattr__` raises: which name it lacks, and what to use for it."""
    use = instead.get(name, f"what {package} has of that name, {package} itself offers")
    return AttributeError(f"{module} has no {name}; {use}", name=name)


def unsupported(what: str, instead: str) -> NoReturn:
    """Raises UnsupportedError: what is missing, and what to use."""
    raise UnsupportedError(f"littoral has no {what}; {instead}")


def triangle_mesh(V: Any, F: Any, flat: bool = False) -> Mesh:
    """V vertices x 3 (or x 2 where `flat`), F faces x 3, with results of double precision."""
    faces = as_array(F, "F")
    if faces.ndim != 2 or faces.shape[1] != 3:
        raise InputError(f"F: expected shape faces x 3, got {faces.shape}")
    return Mesh(space_points(V, "V") if flat else floats(V, "V", 3, finite=False), faces)


def space_points(value: Any, name: str) -> Floats:
    """n x 3 real numbers; points of the plane get z = 0."""
    array = as_array(value, name)
    if array.ndim == 2 and array.shape[1] == 2:
        flat = floats(array, name, 2)
        return np.column_stack([flat, np.zeros(len(flat))])
    return floats(array, name, 3)


def one_index(value: Any, count: int, name: str, of: str) -> int:
    """An integer below `count`; raises ArgumentError or IndexOutOfRange."""
    index = integer(value, name)
    check_range(np.array([index]), count, name, of)
    return index


def indices(value: Any, count: int, name: str, of: str) -> Ints:
    """At least one integer, all below `count`."""
    out = ints(np.atleast_1d(as_array(value, name)), name)
    if len(out) == 0:
        raise InputError(f"{name}: expected at least one of the {of}, got none")
    check_range(out, count, name, of)
    return out


def surface_point(value: Any, name: str) -> SurfacePoint:
    """potpourri3d's (element, barycentric): none for a vertex, t for an edge, two or three numbers
    for a face. A plain integer is a vertex."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
        return SurfacePoint.vertex(integer(value, name))
    if not isinstance(value, (tuple, list)) or len(value) != 2:
        raise ArgumentError(f"{name}: expected (element, [barycentric]), got {value!r}")
    element = integer(value[0], name)
    b = floats(value[1], f"{name}'s barycentric coordinates")
    if len(b) == 0:
        return SurfacePoint.vertex(element)
    if len(b) == 1:
        return SurfacePoint.edge(element, b[0])
    if len(b) == 2:
        return SurfacePoint.face(element, b[0], b[1], 1 - b[0] - b[1])
    if len(b) == 3:
        return SurfacePoint.face(element, b[0], b[1], b[2])
    raise InputError(f"{name}: expected at most three barycentric coordinates, got {len(b)}")


def surface_curves(curves: Any) -> list[list[SurfacePoint]]:
    """A list of curves, each a list of such points."""
    if not isinstance(curves, Iterable) or isinstance(curves, str):
        raise ArgumentError(f"curves: expected a list of curves, got {curves!r}")
    return [
        [surface_point(node, f"curves[{i}][{j}]") for j, node in enumerate(curve)]
        for i, curve in enumerate(curves)
    ]


def vertex_curves(curves: Any, surface: Surface, of: str) -> list[Curve]:
    """A list of curves, each a list of vertices or points of a cloud."""
    if not isinstance(curves, Iterable) or isinstance(curves, str):
        raise ArgumentError(f"curves: expected a list of curves, got {curves!r}")
    n = surface.n_vertices
    return [Curve(indices(c, n, f"curves[{i}]", of)) for i, c in enumerate(curves)]


def positive(value: Any, name: str) -> float:
    """A finite number above 0."""
    found = number(value, name)
    if not (np.isfinite(found) and found > 0):
        raise InputError(f"{name}: expected a positive number, got {found}")
    return found


def answer(field: Field, leave_out: str | None = None) -> Floats:
    """The values of a field, `own`; what it warns of becomes Python's warnings, but for texts with
    some words in them."""
    for text in field.warnings:
        if leave_out is None or leave_out not in text:
            warnings.warn(text, RuntimeWarning, stacklevel=3)
    return own(field.values)


def own(values: Any) -> Floats:
    """A copy in double precision that the caller may write to."""
    return np.array(values, dtype=np.float64)
