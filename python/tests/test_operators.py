"""Matrices and factorizations."""

from __future__ import annotations

import numpy as np
import pytest

import littoral

sparse = pytest.importorskip("scipy.sparse")


def test_operators_of_a_triangle_mesh(sphere):
    ops = littoral.operators(sphere)
    V, F = sphere.points, sphere.faces
    assert abs(ops.L - ops.L.T).max() < 1e-14
    np.testing.assert_allclose(ops.L @ np.ones(len(V)), 0, atol=1e-12)
    a, b, c = (V[F[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    np.testing.assert_allclose(ops.A, areas, rtol=1e-12)
    np.testing.assert_allclose(ops.M.sum(), areas.sum(), rtol=1e-12)
    # The gradient of a linear function is its direction, projected to the face.
    direction = np.array([0.3, -0.5, 0.7])
    normal = np.cross(b - a, c - a) / (2 * areas[:, None])
    expected = direction - (normal @ direction)[:, None] * normal
    np.testing.assert_allclose((ops.G @ (V @ direction)).reshape(-1, 3), expected, atol=1e-12)
    difference = ops.D @ ops.G - ops.L
    assert abs(difference).max() < 1e-12
    assert abs(ops.connection - ops.connection.conj().T).max() < 1e-14
    assert ops.connection.shape == (sphere.n_edges, sphere.n_edges)
    np.testing.assert_array_equal(ops.vector_at, sphere.edges)
    scaled = littoral.operators(littoral.Mesh(3 * V, F))
    np.testing.assert_allclose(scaled.M, 9 * ops.M, rtol=1e-12)
    np.testing.assert_allclose((scaled.L - ops.L).data, 0, atol=1e-12)
    np.testing.assert_allclose((3 * scaled.G - ops.G).data, 0, atol=1e-12)


def test_operators_of_other_surfaces():
    quads = littoral.operators(littoral.examples.quads(4))
    assert quads.G.shape[0] == 0 and quads.connection.shape == (25, 25)
    np.testing.assert_allclose(quads.M.sum(), 1, rtol=1e-12)


def test_factorizations_solve(sphere):
    ops = littoral.operators(sphere)
    rng = np.random.default_rng(3)
    A = ops.L + sparse.diags(ops.M)
    factor = littoral.Factorization(A)
    for b in (rng.normal(size=len(ops.M)), rng.normal(size=(len(ops.M), 3))):
        x = factor.solve(b)
        assert x.shape == b.shape
        np.testing.assert_allclose(A @ x, b, atol=1e-10)
    H = ops.connection + sparse.diags(ops.connection_mass)
    b = rng.normal(size=H.shape[0]) + 1j * rng.normal(size=H.shape[0])
    np.testing.assert_allclose(H @ littoral.Factorization(H).solve(b), b, atol=1e-10)
    two = sparse.block_diag([ops.L, ops.L]).tocsc()
    b = rng.normal(size=two.shape[0])
    b[: len(ops.M)] -= b[: len(ops.M)].mean()
    b[len(ops.M) :] -= b[len(ops.M) :].mean()
    x = littoral.Factorization(two, laplacian=np.bool_(True)).solve(b)
    np.testing.assert_allclose(two @ x, b, atol=1e-9)
    assert abs(x[: len(ops.M)].mean()) < 1e-10
    with pytest.raises(littoral.SolveError):
        littoral.Factorization(-A)
    with pytest.raises(ValueError, match="square"):
        littoral.Factorization(sparse.csc_matrix((3, 2)))
    with pytest.raises(ValueError, match="rows"):
        factor.solve(np.zeros(3))
    with pytest.raises(ValueError, match="finite"):
        factor.solve(np.full(len(ops.M), np.nan))
