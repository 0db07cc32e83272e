"""Lines on which a function on a triangle mesh takes a value, as points of edges and vertices."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from .._arrays import Array, Floats
from .._surfaces import Mesh

# A vertex (0, v) or a point of an edge (1, e).
Node = tuple[int, int]


def level_lines(mesh: Mesh, u: Floats, level: float) -> list[list[tuple[int, list[float]]]]:
    """Curves of (vertex, []) and (edge, [t]), smaller values on the left; closed ones repeat their
    first node. Faces on which u is the level everywhere have none inside."""
    F = np.asarray(mesh.faces)
    E = mesh.edges
    side = np.sign(u - level).astype(int)
    numbers = _edge_numbers(E, F, mesh.n_vertices)
    corner = side[F]
    cut = (corner.min(axis=1) < 0) & (corner.max(axis=1) > 0)
    along = (corner == 0).sum(axis=1) == 2
    following: dict[Node, list[Node]] = defaultdict(list)
    seen: set[tuple[Node, Node]] = set()
    for f in np.flatnonzero(cut | along):
        segment = _segment(F[f], corner[f], numbers[f])
        a, b = segment
        if segment in seen or (a[0] == 0 and b[0] == 0 and (b, a) in seen):
            continue  # along an edge, whose other face was there first
        seen.add(segment)
        following[a].append(b)
    t = np.zeros(len(E))
    crossed = side[E[:, 0]] * side[E[:, 1]] < 0
    low, high = u[E[crossed, 0]], u[E[crossed, 1]]
    t[crossed] = (level - low) / (high - low)
    return [
        [(n, []) if kind == 0 else (n, [float(t[n])]) for kind, n in line]
        for line in _chained(following)
    ]


def _edge_numbers(E: Array, F: Array, n_vertices: int) -> Array:
    """faces x 3: the edge from corner k to corner k + 1."""
    keys = E.min(axis=1).astype(np.int64) * n_vertices + E.max(axis=1)
    order = np.argsort(keys)
    a, b = F.astype(np.int64), np.roll(F, -1, axis=1).astype(np.int64)
    wanted = np.minimum(a, b) * n_vertices + np.maximum(a, b)
    at = np.searchsorted(keys[order], wanted.ravel())
    out: Array = order[np.minimum(at, len(order) - 1)].reshape(F.shape)
    return out


def _segment(face: Array, side: Array, edges: Array) -> tuple[Node, Node]:
    """The piece of the line within a face, smaller values on the left, seen from its normal."""
    enters: Node | None = None
    leaves: Node | None = None
    zeros = [k for k in range(3) if side[k] == 0]
    if len(zeros) == 2:
        k = next(k for k in range(3) if side[k] != 0)
        ahead, back = (0, int(face[(k + 1) % 3])), (0, int(face[(k + 2) % 3]))
        return (ahead, back) if side[k] < 0 else (back, ahead)
    for k in range(3):
        if side[k] * side[(k + 1) % 3] < 0:  # going around, values rise where the line enters
            node = (1, int(edges[k]))
            if side[k] < 0:
                enters = node
            else:
                leaves = node
    if zeros:
        node = (0, int(face[zeros[0]]))
        if leaves is None:
            leaves = node
        else:
            enters = node
    assert enters is not None and leaves is not None
    return enters, leaves


def _chained(following: dict[Node, list[Node]]) -> list[list[Node]]:
    """Every segment in one line; lines from their ends first, then closed ones."""
    arrives: dict[Node, int] = defaultdict(int)
    for nexts in following.values():
        for node in nexts:
            arrives[node] += 1
    nodes = list(following)
    starts = [n for n in nodes if len(following[n]) > arrives[n]]
    lines: list[list[Node]] = []
    for start in starts + nodes:
        while following[start]:
            line = [start]
            while following.get(line[-1]):
                line.append(following[line[-1]].pop())
            lines.append(line)
    return lines
