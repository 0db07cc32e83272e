"""Pseudonormals of a triangle mesh where points are nearest to it."""

from __future__ import annotations

import numpy as np

from .._arrays import Array, Floats
from .._space import Closest
from .._surfaces import Mesh

_ON_BORDER = 1e-12  # barycentric coordinates at most that small are 0


def _unit(vectors: Array) -> Floats:
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    out: Floats = vectors / np.where(length > 0, length, 1)
    return out


def pseudonormals(mesh: Mesh, closest: Closest) -> Floats:
    """Unit vectors, points x 3: the normal of a face inside it, the mean of its faces' on an edge,
    the mean weighted by angles at a vertex; 0 where these cancel.

    Source: Baerentzen, Aanaes, Signed Distance Computation Using the Angle Weighted Pseudonormal
    (2005).
    """
    P, F = mesh.points, np.asarray(mesh.faces)
    a, b, c = P[F[:, 0]], P[F[:, 1]], P[F[:, 2]]
    normals = _unit(np.cross(b - a, c - a))
    out = normals[closest.face]
    inside = closest.barycentric > _ON_BORDER
    on_edge = np.flatnonzero(inside.sum(axis=1) == 2)
    if len(on_edge):
        sides = closest.corners[on_edge][inside[on_edge]].reshape(-1, 2)
        out[on_edge] = _edge_normals(mesh, F, normals, sides)
    at_vertex = np.flatnonzero(inside.sum(axis=1) == 1)
    if len(at_vertex):
        vertices = closest.corners[at_vertex][inside[at_vertex]]
        out[at_vertex] = _vertex_normals(P, F, normals)[vertices]
    return out


def _edge_normals(mesh: Mesh, F: Array, normals: Floats, sides: Array) -> Floats:
    """Of the edges between pairs of vertices."""
    n = mesh.n_vertices
    ends = np.concatenate([F[:, [0, 1]], F[:, [1, 2]], F[:, [2, 0]]]).astype(np.int64)
    keys, number = np.unique(ends.min(axis=1) * n + ends.max(axis=1), return_inverse=True)
    sums = np.zeros((len(keys), 3))
    np.add.at(sums, number.ravel(), np.tile(normals, (3, 1)))
    wanted = sides.astype(np.int64)
    return _unit(sums[np.searchsorted(keys, wanted.min(axis=1) * n + wanted.max(axis=1))])


def _vertex_normals(P: Floats, F: Array, normals: Floats) -> Floats:
    sums = np.zeros((len(P), 3))
    for k in range(3):
        to_next = _unit(P[F[:, (k + 1) % 3]] - P[F[:, k]])
        to_last = _unit(P[F[:, (k + 2) % 3]] - P[F[:, k]])
        angle = np.arccos(np.clip(np.einsum("ij,ij->i", to_next, to_last), -1, 1))
        np.add.at(sums, F[:, k], angle[:, None] * normals)
    return _unit(sums)
