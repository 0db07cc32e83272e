"""Areas, edges and the cotan Laplacian with the arguments of potpourri3d."""

from __future__ import annotations

from typing import Any

import numpy as np

from .._arguments import number
from .._arrays import Floats, floats
from .._surfaces import Mesh
from ._arguments import Indices, triangle_mesh


def cotan_laplacian(V: Any, F: Any, denom_eps: float = 0.0) -> Any:
    """The weak -Laplacian of linear elements: `scipy.sparse.csr_matrix`, vertices x vertices.

    Symmetric, rows sum to 0, positive semidefinite. Each corner's cotangent is dot / (cross +
    denom_eps) of its sides [length^2]; without denom_eps degenerate faces give numbers that are not
    finite. Needs scipy.
    """
    from scipy.sparse import csr_matrix

    mesh = triangle_mesh(V, F)
    P, corners = mesh.points, np.asarray(mesh.faces)
    shape = (mesh.n_vertices, mesh.n_vertices)
    off_diagonal = csr_matrix(shape)
    for k in range(3):
        apex, a, b = (corners[:, (k + i) % 3] for i in range(3))
        to_a, to_b = P[a] - P[apex], P[b] - P[apex]
        crossed = np.linalg.norm(np.cross(to_a, to_b), axis=1) + number(denom_eps, "denom_eps")
        with np.errstate(divide="ignore", invalid="ignore"):
            half_cotan = 0.5 * np.einsum("ij,ij->i", to_a, to_b) / crossed
        off_diagonal = off_diagonal + csr_matrix((half_cotan, (a, b)), shape)
    weights = off_diagonal + off_diagonal.T
    sums = np.asarray(weights.sum(axis=1)).ravel()
    at = np.arange(mesh.n_vertices)
    return csr_matrix(csr_matrix((sums, (at, at)), shape) - weights)


def face_areas(V: Any, F: Any) -> Floats:
    """Area of each face: faces [length^2].

    >>> face_areas([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).tolist()
    [0.5]
    """
    mesh = triangle_mesh(V, F)
    a, b, c = (mesh.points[np.asarray(mesh.faces)[:, k]] for k in range(3))
    doubled: Floats = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    return 0.5 * doubled


def vertex_areas(V: Any, F: Any) -> Floats:
    """A third of the areas of the faces around each vertex: vertices [length^2]."""
    mesh = triangle_mesh(V, F)
    thirds = np.repeat(face_areas(V, F) / 3, 3)
    out: Floats = np.bincount(mesh.corners, thirds, mesh.n_vertices).astype(np.float64)
    return out


def edges(V: Any, F: Any) -> Indices:
    """The vertices of each edge, edges x 2, int64; points of edges count edges in this order."""
    return Mesh(floats(V, "V", 3, finite=False), F).edges.astype(np.int64)
