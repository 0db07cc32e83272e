"""Shortest paths between vertices of a triangle mesh, from exact distances."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from .._arrays import Floats, Ints
from .._distance import DistanceSolver
from .._errors import SolveError
from .._surfaces import Mesh
from ._arguments import answer

Point2 = tuple[float, float]

_WINDOWS = 1_000_000  # on the way to one vertex; a path through a thousand edges needs thousands


class _Window(NamedTuple):
    """What is seen of an edge from the vertex the search began at, unfolded into the plane.

    The vertex is at the origin, the edge goes from A to B, B to the left of A. Seen is the part
    from `low` to `high`, as shares of the edge.
    """

    a: int
    b: int
    A: Point2
    B: Point2
    low: float
    high: float
    face: int  # that the sight came through
    before: _Window | None


def _cross(a: Point2, b: Point2) -> float:
    return a[0] * b[1] - a[1] * b[0]


def _at(A: Point2, B: Point2, s: float) -> Point2:
    return A[0] + s * (B[0] - A[0]), A[1] + s * (B[1] - A[1])


def _share(A: Point2, B: Point2, ray: Point2) -> float:
    """Where a ray from the origin meets the line through A and B, as a share of AB."""
    across = _cross(ray, (B[0] - A[0], B[1] - A[1]))
    return -_cross(ray, A) / across if across != 0 else 0.0


class _Neighbours:
    """Faces by vertex and by edge."""

    def __init__(self, F: Ints, n_vertices: int) -> None:
        self.faces: list[list[int]] = F.tolist()
        self.vertex_faces: list[list[int]] = [[] for _ in range(n_vertices)]
        self.edge_faces: dict[tuple[int, int], list[int]] = defaultdict(list)
        for f, face in enumerate(self.faces):
            for k in range(3):
                a, b = face[k], face[(k + 1) % 3]
                self.edge_faces[min(a, b), max(a, b)].append(f)
                self.vertex_faces[a].append(f)


class ShortestPaths:
    """Exact distances on one mesh, and the shortest paths that have these lengths.

    A shortest path to a vertex t is straight, once the triangles it crosses are unfolded, up to the
    last vertex c it passes before t, and d(t) = |ct| + d(c). So from t everything in sight is
    searched for such a vertex, leaving out edges of which no point x can have |tx| + d(x) = d(t).
    """

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh
        self.solver = DistanceSolver(mesh, "exact")
        self._last: tuple[int, Floats] = (-1, np.empty(0))
        self._made: _Neighbours | None = None

    def distance(self, source: int) -> Floats:
        """Exact distance from a vertex, at all vertices; the last one is kept. Not to write to."""
        kept, values = self._last
        if source != kept:
            values = answer(self.solver.solve(points=[source]))
            self._last = source, values
        return values

    def trace(self, source: int, target: int) -> Floats:
        """A shortest path from target to source: nodes x 3, one node a crossed edge or vertex.

        Empty where there is no path. Raises SolveError where none has the exact length to nine
        digits, which faces near zero area can cause.
        """
        d = self.distance(source)
        points = self.mesh.points
        if not np.isfinite(d[target]):
            return np.empty((0, 3))
        path = [points[target]]
        visited = {target}
        at = target
        while at != source:
            at, nodes = self._last_vertex(at, d, visited, 1e-9 * float(d[target]))
            visited.add(at)
            path += [*nodes, points[at]]
        kept = [path[0]]
        for node in path[1:]:
            if np.linalg.norm(node - kept[-1]) > 1e-12 * d[target]:
                kept.append(node)
        if len(kept) > 1:
            kept[-1] = points[source]
        return np.array(kept)

    @property
    def _near(self) -> _Neighbours:
        if self._made is None:
            self._made = _Neighbours(np.asarray(self.mesh.faces), self.mesh.n_vertices)
        return self._made

    def _length(self, a: int, b: int) -> float:
        x, y, z = (self.mesh.points[a] - self.mesh.points[b]).tolist()
        return float((x * x + y * y + z * z) ** 0.5)

    def _last_vertex(
        self, start: int, d: Floats, visited: set[int], tolerance: float
    ) -> tuple[int, list[Floats]]:
        """A vertex a shortest path to `start` passes last, and where it crosses edges after it."""
        reach = float(d[start]) + tolerance
        around = self._near.vertex_faces[start]
        for f in around:
            for c in self._near.faces[f]:
                if c not in visited and self._length(start, c) + d[c] <= reach:
                    return c, []
        stack = [w for f in around for w in self._first(start, f) if _may_hold(w, d, reach)]
        for _ in range(_WINDOWS):
            if not stack:
                break
            window = stack.pop()
            for c, C, f in self._beyond(window):
                seen = window.low - 1e-9 <= _share(window.A, window.B, C) <= window.high + 1e-9
                length = (C[0] * C[0] + C[1] * C[1]) ** 0.5
                if seen and c not in visited and length + d[c] <= reach:
                    return c, self._crossings(window, C)
                stack += [w for w in _split(window, c, C, f) if _may_hold(w, d, reach)]
        raise SolveError(
            f"no path to vertex {start} has the length {float(d[start])!r} of its distance; "
            "distances alone are exact"
        )

    def _first(self, start: int, f: int) -> Iterator[_Window]:
        """The side of a face opposite to the vertex."""
        face = self._near.faces[f]
        k = face.index(start)
        a, b = face[(k + 1) % 3], face[(k + 2) % 3]
        la, lb, side = self._length(start, a), self._length(start, b), self._length(a, b)
        if la == 0 or side == 0:
            return
        x = (la * la + lb * lb - side * side) / (2 * la)
        y = max(lb * lb - x * x, 0.0) ** 0.5
        if y > 0:
            yield _Window(a, b, (la, 0.0), (x, y), 0.0, 1.0, f, None)

    def _beyond(self, w: _Window) -> Iterator[tuple[int, Point2, int]]:
        """The vertices across the edge, and where they lie in the plane."""
        side = self._length(w.a, w.b)
        along = ((w.B[0] - w.A[0]) / side, (w.B[1] - w.A[1]) / side)
        away = (along[1], -along[0])  # from the origin, which is left of AB
        for f in self._near.edge_faces[min(w.a, w.b), max(w.a, w.b)]:
            if f == w.face:
                continue
            for c in self._near.faces[f]:
                if c in (w.a, w.b):
                    continue
                la, lb = self._length(w.a, c), self._length(w.b, c)
                x = (la * la + side * side - lb * lb) / (2 * side)
                y = max(la * la - x * x, 0.0) ** 0.5
                yield (
                    c,
                    (w.A[0] + x * along[0] + y * away[0], w.A[1] + x * along[1] + y * away[1]),
                    f,
                )

    def _crossings(self, window: _Window, C: Point2) -> list[Floats]:
        """Where the straight way to C crosses edges, those near the origin first."""
        nodes: list[Floats] = []
        w: _Window | None = window
        while w is not None:
            s = min(max(_share(w.A, w.B, C), 0.0), 1.0)
            nodes.append((1 - s) * self.mesh.points[w.a] + s * self.mesh.points[w.b])
            w = w.before
        return nodes[::-1]


def _may_hold(w: _Window, d: Floats, reach: float) -> bool:
    """Whether a point x in sight may have |x| + d(x) <= reach.

    d(x) is at least d(a) - |ax| and at least d(b) - |bx|. The sum with the first falls towards b,
    that with the second towards a, so the larger is least where both are the same, or at an end.
    """
    side = ((w.B[0] - w.A[0]) ** 2 + (w.B[1] - w.A[1]) ** 2) ** 0.5
    if side == 0 or w.low > w.high:
        return False
    da, db = float(d[w.a]), float(d[w.b])
    s = min(max((da - db + side) / (2 * side), w.low), w.high)
    x = _at(w.A, w.B, s)
    least = max(da - s * side, db - (1 - s) * side)
    return bool((x[0] * x[0] + x[1] * x[1]) ** 0.5 + least <= reach)


def _split(w: _Window, c: int, C: Point2, f: int) -> Iterator[_Window]:
    """What is seen through the window of the two other sides of the face behind it."""
    first, last = _at(w.A, w.B, w.low), _at(w.A, w.B, w.high)
    if _cross(first, C) > 0:  # C is left of the right border of the sight
        high = 1.0 if _cross(C, last) >= 0 else min(_share(w.A, C, last), 1.0)
        yield _Window(w.a, c, w.A, C, max(_share(w.A, C, first), 0.0), high, f, w)
    if _cross(C, last) > 0:
        low = 0.0 if _cross(first, C) >= 0 else max(_share(C, w.B, first), 0.0)
        yield _Window(c, w.b, C, w.B, low, min(_share(C, w.B, last), 1.0), f, w)
