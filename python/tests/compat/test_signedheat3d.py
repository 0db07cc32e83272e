"""The solvers of signedheat3d."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import littoral
from littoral.compat.signedheat3d import SignedHeatGridSolver, SignedHeatTetSolver

SMALL = {"resolution": np.array([14, 14, 14])}


@pytest.fixture
def grid():
    return SignedHeatGridSolver(verbose=False)


@pytest.fixture
def tets():
    return SignedHeatTetSolver(verbose=False)


def nodes_of(solver):
    low, high = solver.get_bbox()
    axes = [
        np.linspace(a, b, n)
        for a, b, n in zip(low, high, solver.get_grid_resolution(), strict=True)
    ]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def test_grid_around_a_sphere(grid, sphere):
    phi = grid.compute_distance_to_mesh(sphere.points, np.asarray(sphere.faces).tolist())
    assert phi.shape == (32**3,) and phi.dtype == np.float64
    assert grid.get_grid_resolution() == [32, 32, 32]
    low, high = grid.get_bbox()
    np.testing.assert_allclose(low, -2, atol=1e-9)
    np.testing.assert_allclose(high, 2, atol=1e-9)
    values = grid.to_grid_array(phi)
    assert values.shape == (32, 32, 32)
    exact = np.linalg.norm(nodes_of(grid), axis=-1) - 1
    assert np.abs(values - exact).mean() < 0.05
    assert (np.sign(values) == np.sign(exact))[np.abs(exact) > 0.06].all()


def test_nodes_go_x_first(grid):
    cube = littoral.examples.cube()
    options = {"resolution": [12, 18, 24], "bbox_min": [-1, -1, -1], "bbox_max": [2, 3, 4]}
    phi = grid.compute_distance_to_mesh(cube.points, cube.faces, options)
    assert phi.shape == (12 * 18 * 24,) and grid.get_grid_resolution() == [12, 18, 24]
    assert [a.tolist() for a in grid.get_bbox()] == [[-1, -1, -1], [2, 3, 4]]
    values = grid.to_grid_array(phi)
    assert values[4, 5, 6] == phi[4 + 12 * (5 + 18 * 6)]
    x = nodes_of(grid).reshape(-1, 3)
    exact = littoral.SDF(cube)(x).reshape(12, 18, 24)
    assert np.abs(values - exact).mean() < 0.2
    far = np.abs(exact) > 0.3
    assert (np.sign(values) == np.sign(exact))[far].all()
    with pytest.raises(ValueError, match="5184"):
        grid.to_grid_array(phi[:-1])


def test_grid_solver_agrees_with_the_formula(grid, sphere):
    """Normals diffused by exp(-r / sqrt(t)) / r from the faces' centres, then integrated."""
    sparse = pytest.importorskip("scipy.sparse")
    linalg = pytest.importorskip("scipy.sparse.linalg")
    V, F = np.array(sphere.points), np.array(sphere.faces)
    phi = grid.compute_distance_to_mesh(V, F, SMALL)
    n = 14
    x = nodes_of(grid).transpose(2, 1, 0, 3).reshape(-1, 3)
    corners = V[F]
    centres = corners.mean(axis=1)
    areas = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2
    edges = np.unique(np.sort(F[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    h = np.linalg.norm(V[edges[:, 0]] - V[edges[:, 1]], axis=1).mean()
    r = np.linalg.norm(x[:, None] - centres[None], axis=2)
    Y = (np.exp(-(r - r.min(axis=1, keepdims=True)) / h) / r) @ areas
    Y /= np.linalg.norm(Y, axis=1, keepdims=True)
    spacing = (grid.get_bbox()[1] - grid.get_bbox()[0])[0] / (n - 1)
    one = sparse.diags([-np.ones(n - 1), np.ones(n - 1)], [0, 1], shape=(n - 1, n)) / spacing
    half = sparse.diags([np.full(n - 1, 0.5)] * 2, [0, 1], shape=(n - 1, n))
    eye = sparse.identity(n)
    kron = [
        (sparse.kron(eye, sparse.kron(eye, m[0])), sparse.kron(eye, sparse.kron(eye, m[1])))
        for m in [(one, half)]
    ]
    kron.append((sparse.kron(eye, sparse.kron(one, eye)), sparse.kron(eye, sparse.kron(half, eye))))
    kron.append((sparse.kron(one, sparse.kron(eye, eye)), sparse.kron(half, sparse.kron(eye, eye))))
    D = sparse.vstack([d for d, _ in kron])
    rhs = np.concatenate([average @ Y[:, a] for a, (_, average) in enumerate(kron)])
    other = linalg.lsqr(D, rhs, atol=1e-10, btol=1e-10)[0]
    near = np.argsort(np.abs(np.linalg.norm(x, axis=1) - 1))[:200]
    other -= (other - (np.linalg.norm(x, axis=1) - 1))[near].mean()
    assert np.abs(phi - other).mean() < 0.06
    assert np.corrcoef(phi, other)[0, 1] > 0.995


def test_a_hole_is_bridged(grid, sphere):
    V, F = np.array(sphere.points), np.array(sphere.faces)
    opened = F[V[F].mean(axis=1)[:, 2] < 0.85]
    options = {"resolution": [20, 20, 20], "bbox_min": [-2] * 3, "bbox_max": [2] * 3}
    values = grid.to_grid_array(grid.compute_distance_to_mesh(V, opened, options))
    exact = np.linalg.norm(nodes_of(grid), axis=-1) - 1
    assert (np.sign(values) == np.sign(exact))[np.abs(exact) > 0.25].all()


def test_clouds(grid, tets, sphere):
    P = np.array(sphere.points)
    phi = grid.compute_distance_to_point_cloud(P, P, options=SMALL)
    exact = np.linalg.norm(nodes_of(grid), axis=-1) - 1
    values = grid.to_grid_array(phi)
    assert np.abs(values - exact).mean() < 0.1
    turned = grid.to_grid_array(grid.compute_distance_to_point_cloud(P, -P, options=SMALL))
    np.testing.assert_allclose(turned, -values, atol=0.02)
    smooth = grid.compute_distance_to_point_cloud(P, P, 25.0, options=SMALL)
    assert np.abs(smooth - phi).max() > 1e-4
    same = grid.compute_distance_to_point_cloud(P, P, options={**SMALL, "t_coef": 25.0})
    np.testing.assert_array_equal(smooth, same)
    through = tets.compute_distance_to_point_cloud(P, P, SMALL)
    assert np.abs(through - (np.linalg.norm(tets.get_vertices(), axis=1) - 1)).mean() < 0.12


def test_tets_around_a_sphere(tets, sphere):
    assert tets.get_vertices().shape == (0, 3) and tets.get_tets().shape == (0, 4)
    phi = tets.compute_distance_to_mesh(sphere.points, sphere.faces, SMALL)
    V, T = tets.get_vertices(), tets.get_tets()
    assert V.dtype == np.float64 and T.dtype == np.int32
    assert np.unique(T).tolist() == list(range(len(V)))
    volumes = np.linalg.det(V[T[:, 1:]] - V[T[:, :1]]) / 6
    assert (volumes > 0).all()
    np.testing.assert_allclose(volumes.sum(), 4.0**3, rtol=1e-6)
    assert phi.shape == (len(V),)
    exact = np.linalg.norm(V, axis=1) - 1
    assert np.abs(phi - exact).mean() < 0.05
    assert (np.sign(phi) == np.sign(exact))[np.abs(exact) > 0.2].all()
    free = tets.compute_distance_to_mesh(
        sphere.points, sphere.faces, {**SMALL, "level_set_constraint": "None"}
    )
    assert np.abs(free - exact).mean() < 0.15 and np.abs(free - phi).max() > 1e-6


@pytest.mark.slow
def test_the_zero_set_follows_the_input_at_any_resolution(tets, spot):
    for nodes in (4, 8):
        phi = tets.compute_distance_to_mesh(*spot, {"resolution": [nodes] * 3})
        V, F = tets.isosurface(phi)
        away = littoral.SDF(V, F).closest(spot[0]).distance
        assert away.mean() < 0.002 * np.ptp(spot[0], axis=0).max()


def values_at(tets, phi, x):
    """Linear in each tet."""
    corners = tets.get_vertices()[tets.get_tets()]
    weights = np.linalg.inv(np.swapaxes(corners[:, 1:] - corners[:, :1], 1, 2))
    out = []
    for place in x:
        inner = np.einsum("tij,tj->ti", weights, place - corners[:, 0])
        each = np.column_stack([1 - inner.sum(axis=1), inner])
        tet = each.min(axis=1).argmax()
        out.append(each[tet] @ phi[tets.get_tets()[tet]])
    return np.array(out)


def test_each_part_may_have_a_value_of_its_own(tets):
    """A small cube within another, off its middle."""
    cube = littoral.examples.cube()
    V = np.vstack([cube.points, [0.55, 0.52, 0.6] + 0.4 * (cube.points - 0.5)])
    F = np.vstack([cube.faces, np.asarray(cube.faces) + len(cube.points)])
    middles = V[F].mean(axis=1).reshape(2, -1, 3)

    def means_and_spreads(constraint):
        options = {"resolution": [16] * 3, "level_set_constraint": constraint}
        phi = tets.compute_distance_to_mesh(V, F, options)
        values = np.array([values_at(tets, phi, part) for part in middles])
        return values.mean(axis=1), values.std(axis=1)

    means, spreads = means_and_spreads("Multiple")
    assert (spreads < 0.005).all()
    assert 0.2 < means[0] - means[1] < 0.4  # they are 0.2 to 0.4 apart
    assert (means_and_spreads("None")[1] > 0.01).all()
    assert (np.abs(means_and_spreads("ZeroSet")[0]) < 0.005).all()


def test_isosurface_of_tets(tets, sphere):
    tets.compute_distance_to_mesh(sphere.points, sphere.faces, SMALL)
    phi = np.linalg.norm(tets.get_vertices(), axis=1)
    V, F = tets.isosurface(phi, 1.2)
    assert V.shape[1] == 3 and isinstance(F, list) and {len(f) for f in F} == {3}
    np.testing.assert_allclose(np.linalg.norm(V, axis=1), 1.2, atol=0.03)
    corners = V[np.array(F)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((normals * corners.mean(axis=1)).sum(axis=1) > 0).all()
    with pytest.raises(ValueError):
        tets.isosurface(phi, 100.0)
    with pytest.raises(ValueError, match="one per vertex"):
        tets.isosurface(phi[1:])


def test_boxes_need_not_be_cubes(tets):
    cube = littoral.examples.cube()
    options = {"resolution": [9, 9, 9], "bbox_min": [-1, -0.5, -0.5], "bbox_max": [3, 1.5, 1.5]}
    phi = tets.compute_distance_to_mesh(cube.points, cube.faces, options)
    V = tets.get_vertices()
    assert V.min(axis=0).tolist() == [-1, -0.5, -0.5]
    assert (V.max(axis=0) >= [3, 1.5, 1.5]).all() and (V.max(axis=0) <= [3, 2.5, 2.5]).all()
    T = tets.get_tets()
    assert np.unique(T).tolist() == list(range(len(V)))
    assert ((V[T] <= [3, 1.5, 1.5]).all(axis=2).any(axis=1)).all(), "each reaches into the box"
    assert phi[np.argmin(np.linalg.norm(V - 0.5, axis=1))] < 0 < phi.max()


def test_what_is_made_is_kept(grid, tets, monkeypatch):
    made = []
    real_tets = littoral.TetMesh.around
    monkeypatch.setattr(
        littoral.TetMesh, "around", lambda *a, **k: (made.append("TetMesh"), real_tets(*a, **k))[1]
    )
    for name in ("SDF", "TetDistanceSolver"):
        real = getattr(littoral, name).__init__

        def counted(self, *args, _real=real, _name=name, **words):
            made.append(_name)
            _real(self, *args, **words)

        monkeypatch.setattr(getattr(littoral, name), "__init__", counted)
    cube = littoral.examples.cube()
    options = {"resolution": [7, 7, 7]}
    for _ in range(2):
        first = grid.compute_distance_to_mesh(cube.points, cube.faces, options)
        tets.compute_distance_to_mesh(cube.points, cube.faces, options)
    assert sorted(made) == ["SDF", "TetDistanceSolver", "TetMesh"]
    again = grid.compute_distance_to_mesh(cube.points, cube.faces)  # the resolution stays
    np.testing.assert_array_equal(first, again)
    grid.compute_distance_to_mesh(cube.points * 2, cube.faces, options)
    assert made.count("SDF") == 2


def test_verbose_tells(capfd):
    cube = littoral.examples.cube()
    SignedHeatGridSolver().compute_distance_to_mesh(
        cube.points, cube.faces, {"resolution": [5] * 3}
    )
    assert "125 nodes" in capfd.readouterr().err


def test_what_raises(grid, tets):
    cube = littoral.examples.cube()
    V, F = cube.points, cube.faces
    for options, match in (
        ({"resolutions": [8, 8, 8]}, "'resolutions' is unknown"),
        ({"t_coef": 0}, "t_coef"),
        ({"resolution": [8, 8]}, "3 numbers"),
        ({"resolution": [8.5, 8, 8]}, "integers"),
        ({"resolution": [1, 8, 8]}, "at least 2"),
        ({"bbox_min": [np.nan, 0, 0]}, "bbox_min"),
    ):
        for solver in (grid, tets):
            with pytest.raises(ValueError, match=match):
                solver.compute_distance_to_mesh(V, F, options)
    with pytest.raises(ValueError, match="level_set_constraint"):
        tets.compute_distance_to_mesh(V, F, {"level_set_constraint": "Most"})
    with pytest.raises(IndexError):
        grid.compute_distance_to_mesh(V, [[0, 1, 99]])
    with pytest.raises(ValueError, match="one normal per point"):
        grid.compute_distance_to_point_cloud(V, V[1:])


def test_signatures():
    theirs = pytest.importorskip("signedheat3d", exc_type=ImportError)
    for ours in (SignedHeatGridSolver, SignedHeatTetSolver):
        real = getattr(theirs, ours.__name__)
        for name in [n for n in dir(real) if not n.startswith("_")] + ["__init__"]:
            one, other = (inspect.signature(getattr(c, name)).parameters for c in (ours, real))
            assert [(p.name, p.default) for p in one.values()] == [
                (p.name, p.default) for p in other.values()
            ]


def test_grids_side_by_side(grid, spot):
    theirs = pytest.importorskip("signedheat3d", exc_type=ImportError)
    V, F = spot
    options = {"resolution": np.array([24, 24, 24])}
    real = theirs.SignedHeatGridSolver(False)
    expected = real.compute_distance_to_mesh(V, F.tolist(), options)
    got = grid.compute_distance_to_mesh(V, F, options)
    assert got.shape == expected.shape and got.dtype == expected.dtype
    assert grid.get_grid_resolution() == list(real.get_grid_resolution())
    np.testing.assert_allclose(grid.get_bbox(), real.get_bbox(), atol=1e-9)
    assert np.corrcoef(got, expected)[0, 1] > 0.99
    assert (np.sign(got) == np.sign(expected)).mean() > 0.99
    np.testing.assert_array_equal(grid.to_grid_array(got), real.to_grid_array(got))
