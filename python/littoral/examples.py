"""Small shapes to try things on. Lengths are in the unit of the square's, cube's or sphere's size.

>>> import littoral
>>> littoral.examples.square(2), littoral.examples.sphere(0)
(<littoral.Mesh: 9 vertices, 8 faces>, <littoral.Mesh: 12 vertices, 20 faces>)
"""

from __future__ import annotations

import numpy as np

from ._arguments import whole
from ._surfaces import Mesh, Polygons


def square(n: int) -> Mesh:
    """The unit square, n x n cells of two triangles; vertex i + (n + 1) j lies at (i, j) / n.

    Raises InputError unless n is positive.
    """
    n = whole(n, "n", " of cells, at least one", 1)
    i, j = np.meshgrid(np.arange(n + 1), np.arange(n + 1))
    V = np.column_stack([i.ravel() / n, j.ravel() / n, np.zeros((n + 1) ** 2)])
    a = (np.arange(n)[None, :] + (n + 1) * np.arange(n)[:, None]).ravel()
    F = np.stack([a, a + 1, a + n + 2, a, a + n + 2, a + n + 1], axis=1).reshape(-1, 3)
    return Mesh(V, F)


def cube() -> Mesh:
    """The unit cube, two triangles a side, normals outward."""
    v = np.arange(8)
    V = np.column_stack([v % 2, v // 2 % 2, v // 4]).astype(float)
    quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    F = [[q[0], q[k], q[k + 1]] for q in quads for k in (1, 2)]
    return Mesh(V, F)


def sphere(subdivisions: int = 3) -> Mesh:
    """The unit sphere: an icosahedron whose triangles are cut in four that many times.

    Raises InputError for fewer than none.
    """
    subdivisions = whole(subdivisions, "subdivisions", ", none or more", 0)
    golden = (1 + 5**0.5) / 2
    corners = [(0, s, t * golden) for s in (-1, 1) for t in (-1, 1)]
    V = np.array([np.roll(c, k) for c in corners for k in range(3)], float)
    V /= np.linalg.norm(V, axis=1, keepdims=True)
    near = np.linalg.norm(V[:, None] - V[None], axis=2) < 1.2
    F = np.array(
        [
            (a, b, c) if np.linalg.det(V[[a, b, c]]) > 0 else (a, c, b)
            for a in range(12)
            for b in range(a + 1, 12)
            for c in range(b + 1, 12)
            if near[a, b] and near[b, c] and near[a, c]
        ]
    )
    for _ in range(subdivisions):
        sides = np.sort(np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]), axis=1)
        edges, number = np.unique(sides, axis=0, return_inverse=True)
        middle = V[edges].mean(axis=1)
        ab, bc, ca = (number.ravel() + len(V)).reshape(3, -1)
        V = np.concatenate([V, middle / np.linalg.norm(middle, axis=1, keepdims=True)])
        a, b, c = F.T
        F = np.concatenate(
            [np.stack(t, 1) for t in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        )
    return Mesh(V, F)


def quads(n: int) -> Polygons:
    """The unit square of n x n squares; raises as `square`."""
    mesh, n = square(n), int(n)
    a = (np.arange(n)[None, :] + (n + 1) * np.arange(n)[:, None]).ravel()
    return Polygons(mesh.points, np.stack([a, a + 1, a + n + 2, a + n + 1], axis=1).tolist())
