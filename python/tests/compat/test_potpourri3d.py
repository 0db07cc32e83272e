"""littoral.compat.potpourri3d: known answers, and side by side with potpourri3d where it is."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import littoral
import littoral.compat.potpourri3d as pp3d

pytestmark = pytest.mark.filterwarnings("ignore::RuntimeWarning")


@pytest.fixture(scope="module")
def real():
    return pytest.importorskip("potpourri3d")


@pytest.fixture(scope="module")
def broken(spot) -> tuple[np.ndarray, np.ndarray]:
    """The cow with every tenth face missing."""
    V, F = spot
    return V, np.delete(F, np.arange(0, len(F), 10), axis=0)


def arrays(mesh: littoral.Surface) -> tuple[np.ndarray, np.ndarray]:
    return np.array(mesh.points), np.array(mesh.faces)


def circle(V: np.ndarray, F: np.ndarray, radius: float) -> list:
    """A closed line at a distance from vertex 7, which lies to its left, and the distance to 7."""
    d = littoral.distance((V, F), points=[7], method="exact").values
    return pp3d.marching_triangles(V, F, d, radius), d


UP = [(9 * j + 4, []) for j in range(9)]  # of the square of 8 x 8, where x = 1/2


# ------------------------------------------------------------------ without the real package


def test_signs_and_values_on_a_square(square):
    V, F = arrays(square)
    left = 0.5 - V[:, 0]
    signed = pp3d.MeshSignedHeatSolver(V, F)
    for word in ("ZeroSet", "None", "Multiple", "zeroset"):
        d = signed.compute_distance([UP], level_set_constraint=word)
        np.testing.assert_allclose(d, left, atol=1e-12)
    np.testing.assert_allclose(signed.compute_distance([UP[::-1]]), -left, atol=1e-12)
    np.testing.assert_allclose(
        signed.compute_distance([UP], preserve_source_normals=True), left, atol=1e-12
    )
    soft = signed.compute_distance([UP], soft_level_set_weight=10.0)
    np.testing.assert_allclose(soft, left, atol=1e-2)
    marching = pp3d.MeshFastMarchingDistanceSolver(V, F)
    np.testing.assert_allclose(marching.compute_distance([UP], sign=True), -left, atol=1e-12)
    shifted = marching.compute_distance([UP], [[0.25] * 9], sign=True)
    np.testing.assert_allclose(shifted, 0.25 - left, atol=1e-12)
    np.testing.assert_allclose(marching.compute_distance([UP]), abs(left), atol=1e-12)
    line = [v for v, _ in UP]
    polygons = pp3d.PolygonMeshHeatSolver(V, F.tolist())
    np.testing.assert_allclose(polygons.compute_signed_distance([line]), -left, atol=1e-12)
    cloud = pp3d.PointCloudHeatSolver(V)
    N = np.tile([0.0, 0.0, 2.0], (len(V), 1))
    np.testing.assert_allclose(cloud.compute_signed_distance([line], N), -left, atol=1e-9)
    np.testing.assert_allclose(cloud.compute_signed_distance([line], -N), left, atol=1e-9)


def test_distance_to_points_on_a_sphere(sphere):
    V, F = arrays(sphere)
    exact = np.arccos(np.clip(V @ V[7], -1, 1))
    solver = pp3d.MeshHeatMethodDistanceSolver(V, F)
    for d in (
        solver.compute_distance(7),
        pp3d.compute_distance(V, F, np.int64(7)),
        pp3d.compute_distance_multisource(V, F, [7]),
        pp3d.MeshHeatMethodDistanceSolver(V, F, 1.0, False).compute_distance(7),
        pp3d.PolygonMeshHeatSolver(V, F).compute_distance([7]),
        pp3d.PointCloudHeatSolver(V).compute_distance(7),
        pp3d.MeshFastMarchingDistanceSolver(V, F).compute_distance([[(7, [])]]),
        pp3d.MeshSignedHeatSolver(V, F).compute_distance([], points=[(7, [])]),
    ):
        assert d.shape == (len(V),) and d.dtype == np.float64 and d.flags.writeable
        np.testing.assert_allclose(d, exact, atol=0.03 * np.pi)


def test_initial_distances(spot):
    V, F = spot
    solver = pp3d.MeshFastMarchingDistanceSolver(V, F)
    near, far = (solver.compute_distance([[(v, [])]]) for v in (7, 1000))
    both = solver.compute_distance([[(7, [])], [(1000, [])]], [[0.0], [0.3]])
    np.testing.assert_allclose(both, np.minimum(near, far + 0.3), atol=1e-12)
    with pytest.raises(littoral.UnsupportedError, match="same number"):
        solver.compute_distance([[(0, []), (1, [])]], [[0.0, 0.1]], sign=True)


def test_lines_of_a_function(square):
    V, F = arrays(square)
    ((*line,),) = pp3d.marching_triangles(V, F, V[:, 0], 0.5)
    assert sorted(line) == UP and line[0] in (UP[0], UP[-1])
    assert line == UP[::-1] or line == UP
    assert line[0] == UP[0]  # smaller values on the left of travel upwards
    r = np.hypot(V[:, 0] - 0.5, V[:, 1] - 0.5)
    (circle,) = pp3d.marching_triangles(V, F, r[:, None], 0.3)
    assert circle[0] == circle[-1] and len(set(map(str, circle))) == len(circle) - 1
    E = pp3d.edges(V, F)
    x, y, _ = np.array([(1 - t[0]) * V[E[e, 0]] + t[0] * V[E[e, 1]] for e, t in circle]).T
    assert 0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1]) == pytest.approx(np.pi * 0.09, rel=0.04)
    assert pp3d.marching_triangles(V, F, V[:, 0], 7.0) == []
    assert pp3d.marching_triangles(V, F, 0 * V[:, 0], 0.0) == []


def test_matrices_and_areas(square):
    pytest.importorskip("scipy")
    V, F = arrays(square)
    L = pp3d.cotan_laplacian(V, F)
    assert L.format == "csr" and L.shape == (81, 81)
    assert V[:, 0] @ (L @ V[:, 0]) == pytest.approx(1)  # the energy of x on the unit square
    assert abs(L.sum(axis=1)).max() < 1e-12 and abs(L - L.T).max() < 1e-12
    np.testing.assert_allclose(pp3d.face_areas(V, F), 1 / 128, atol=1e-15)
    assert pp3d.vertex_areas(V, F).sum() == pytest.approx(1)
    assert pp3d.edges(V, F).dtype == np.int64 and pp3d.edges(V, F).shape == (square.n_edges, 2)


def test_files(tmp_path, square):
    V, F = arrays(square)
    for name in ("a.obj", "a.ply"):
        pp3d.write_mesh(V, F, str(tmp_path / name))
        W, G = pp3d.read_mesh(str(tmp_path / name))
        np.testing.assert_array_equal(W, V)
        np.testing.assert_array_equal(G, F)
        assert (W.dtype, G.dtype) == (np.float64, np.int64)
        pp3d.write_point_cloud(V, str(tmp_path / name))
        np.testing.assert_array_equal(pp3d.read_point_cloud(str(tmp_path / name)), V)
    quads = littoral.examples.quads(2)
    quads.save(tmp_path / "q.obj")
    assert pp3d.read_mesh(tmp_path / "q.obj")[1].shape == (4, 4)
    assert pp3d.read_polygon_mesh(tmp_path / "q.obj")[1][0] == [0, 1, 4, 3]
    (tmp_path / "mixed.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n")
    with pytest.raises(ValueError, match="different numbers of corners"):
        pp3d.read_mesh(tmp_path / "mixed.obj")
    for kind, n in (("per-vertex", len(V)), ("per-face", len(F)), ("per-corner", 3 * len(F))):
        pp3d.write_mesh(V, F, tmp_path / "uv.obj", np.zeros((n, 2)), kind)
        text = (tmp_path / "uv.obj").read_text().splitlines()
        assert sum(line.startswith("vt ") for line in text) == n
        np.testing.assert_array_equal(pp3d.read_mesh(tmp_path / "uv.obj")[1], F)
        with pytest.raises(ValueError, match="UV_coords"):
            pp3d.write_mesh(V, F, tmp_path / "uv.obj", np.zeros((n + 1, 2)), kind)
    with pytest.raises(littoral.UnsupportedError):
        pp3d.write_mesh(V, F, tmp_path / "uv.ply", np.zeros((len(V), 2)), "per-vertex")


def test_solvers_are_prepared_once(square, monkeypatch):
    made = []
    init = littoral.DistanceSolver.__init__
    monkeypatch.setattr(
        littoral.DistanceSolver, "__init__", lambda *a, **k: (made.append(k), init(*a, **k))[1]
    )
    V, F = arrays(square)
    signed = pp3d.MeshSignedHeatSolver(V, F, t_coef=2.0)
    for _ in range(3):
        signed.compute_distance([UP])
    assert len(made) == 1 and made[0]["time_scale"] == 2.0
    signed.compute_distance([UP], level_set_constraint="None")
    assert len(made) == 2
    heat = pp3d.MeshHeatMethodDistanceSolver(V, F)
    heat.compute_distance(0)
    heat.compute_distance_multisource([1, 2])
    assert len(made) == 3 and made[2]["intrinsic_delaunay"] is True


def test_doubts_are_warnings(square, recwarn):
    V, F = arrays(square)
    signed = pp3d.MeshSignedHeatSolver(V, F)
    with pytest.warns(RuntimeWarning, match="segment of curve 1"):
        signed.compute_distance([[0, 1, 2, 3, 80]])
    recwarn.clear()
    signed.compute_distance([UP])
    pp3d.PointCloudHeatSolver(V).compute_distance(0)
    assert not [str(w.message) for w in recwarn]


def test_wrong_arguments(square):
    V, F = arrays(square)
    heat = pp3d.MeshHeatMethodDistanceSolver(V, F)
    for bad, error in ((81, IndexError), (-1, IndexError), (1.5, TypeError), (True, TypeError)):
        with pytest.raises(error):
            heat.compute_distance(bad)
    with pytest.raises(ValueError, match="at least one"):
        heat.compute_distance_multisource([])
    for t in (0, -1, np.nan):
        with pytest.raises(ValueError, match="t_coef"):
            pp3d.MeshSignedHeatSolver(V, F, t)
    with pytest.raises(ValueError, match="faces x 3"):
        pp3d.MeshSignedHeatSolver(V, np.zeros((2, 4), int))
    signed = pp3d.MeshSignedHeatSolver(V, F)
    for curves, error in (
        ([[(0, []), (99, [])]], IndexError),
        ([[(0, [0.1] * 4), (1, [])]], ValueError),
        ([["a", "b"]], TypeError),
        ([[]], ValueError),
        (7, TypeError),
    ):
        with pytest.raises(error):
            signed.compute_distance(curves)
    with pytest.raises(ValueError, match="level_set_constraint"):
        signed.compute_distance([UP], level_set_constraint="All")
    with pytest.raises(ValueError):
        pp3d.MeshFastMarchingDistanceSolver(V, F).compute_distance([])
    with pytest.raises(ValueError, match="one per vertex"):
        pp3d.marching_triangles(V, F, V[:5, 0])
    two = littoral.Mesh(np.concatenate([V, V + 5]), np.concatenate([F, F + 81]))
    assert np.isinf(pp3d.compute_distance(two.points, two.faces, 0)[81:]).all()


def test_what_is_missing_says_so(square):
    V, F = arrays(square)
    cloud, polygons = pp3d.PointCloudHeatSolver(V), pp3d.PolygonMeshHeatSolver(V, F)
    flips = pp3d.EdgeFlipGeodesicSolver(V, F)
    for call in (
        lambda: pp3d.MeshVectorHeatSolver(V, F),
        lambda: pp3d.GeodesicTracer(V, F),
        lambda: pp3d.PointCloudLocalTriangulation(V),
        lambda: cloud.extend_scalar([0], [1.0]),
        lambda: cloud.get_tangent_frames(),
        lambda: cloud.transport_tangent_vector(0, [1, 0]),
        lambda: cloud.transport_tangent_vectors([0], [[1, 0]]),
        lambda: cloud.compute_log_map(0),
        lambda: polygons.extend_scalar([0], [1.0]),
        lambda: polygons.get_tangent_frames(),
        lambda: polygons.transport_tangent_vectors([0], [[1, 0]]),
        lambda: flips.find_geodesic_path_poly([0, 1, 2]),
        lambda: flips.find_geodesic_loop([0, 1, 2]),
    ):
        with pytest.raises(littoral.UnsupportedError, match=r"littoral has no .*; "):
            call()
    path = flips.find_geodesic_path(v_start=0, v_end=80)
    limited = flips.find_geodesic_path(0, 80, max_iterations=3, max_relative_length_decrease=0.5)
    np.testing.assert_array_equal(limited, path)
    np.testing.assert_allclose(path[[0, -1]], V[[0, 80]])
    assert np.linalg.norm(np.diff(path, axis=0), axis=1).sum() == pytest.approx(2**0.5)


# ------------------------------------------------------------------ side by side


def test_the_names_and_arguments_are_the_same(real):
    missing = {n for n in dir(real) if callable(getattr(real, n)) and not n.startswith("_")}
    missing -= set(pp3d.__all__) | {"validate_mesh", "validate_points"}
    assert not missing
    for name in pp3d.__all__:
        theirs, ours = getattr(real, name), getattr(pp3d, name)
        pairs = [(name, theirs, ours)]
        if inspect.isclass(theirs):
            methods = [m for m in vars(theirs) if not m.startswith("_")]
            if "Tracer" in name or "Vector" in name or "Local" in name:
                methods = []
            pairs = [(m, getattr(theirs, m), getattr(ours, m)) for m in ["__init__", *methods]]
        for what, a, b in pairs:
            a, b = (inspect.signature(f).parameters.values() for f in (a, b))
            assert [p.name for p in a] == [p.name for p in b], (name, what)
            for p, q in zip(a, b, strict=True):
                empty = isinstance(p.default, list) and len(q.default) == 0
                assert p.default == q.default or empty, (name, what)


@pytest.mark.parametrize("shape", ["spot", "broken", "ball"])
def test_points_side_by_side(real, request, shape, sphere):
    V, F = arrays(sphere) if shape == "ball" else request.getfixturevalue(shape)
    reach = littoral.distance((V, F), points=[7], method="exact").values.max()
    P = F.tolist()
    for name, tolerance, ours, theirs in (
        ("robust", 0.02, pp3d.compute_distance(V, F, 7), real.compute_distance(V, F, 7)),
        (
            "plain",
            0.02,
            pp3d.MeshHeatMethodDistanceSolver(V, F, 4.0, False).compute_distance(7),
            real.MeshHeatMethodDistanceSolver(V, F, 4.0, False).compute_distance(7),
        ),
        (
            "several",
            0.04,
            pp3d.compute_distance_multisource(V, F, [7, 100]),
            real.compute_distance_multisource(V, F, [7, 100]),
        ),
        (
            "polygons",
            0.04,
            pp3d.PolygonMeshHeatSolver(V, P).compute_distance([7, 100]),
            real.PolygonMeshHeatSolver(V, P).compute_distance([7, 100]),
        ),
        (
            "cloud",
            0.05,
            pp3d.PointCloudHeatSolver(V).compute_distance(7),
            real.PointCloudHeatSolver(V).compute_distance(7),
        ),
    ):
        assert (ours.shape, ours.dtype, type(ours)) == (theirs.shape, theirs.dtype, type(theirs))
        error = abs(ours - theirs).max() / reach
        print(f"{shape}, {name}: {error:.2g}")
        assert error < tolerance, name


@pytest.mark.parametrize("shape", ["spot", "ball"])
def test_curves_side_by_side(real, request, shape, sphere):
    V, F = arrays(sphere) if shape == "ball" else request.getfixturevalue(shape)
    curves, d = circle(V, F, 0.4)
    (longest,) = [sorted(curves, key=len)[-1:]]
    ours, theirs = pp3d.MeshSignedHeatSolver(V, F), real.MeshSignedHeatSolver(V, F)
    for options, tolerance in (
        ({}, 0.02),
        ({"level_set_constraint": "None"}, 1e-9),
        ({"level_set_constraint": "Multiple"}, 0.02),
        ({"soft_level_set_weight": 10.0}, 0.02),
        ({"preserve_source_normals": True}, 0.03),
        ({"curve_signs": [True]}, 0.02),
    ):
        error = abs(
            ours.compute_distance(longest, **options) - theirs.compute_distance(longest, **options)
        ).max()
        print(f"{shape}, {options}: {error / d.max():.2g}")
        assert error < tolerance * d.max(), options
    ours, theirs = (m.MeshFastMarchingDistanceSolver(V, F) for m in (pp3d, real))
    for options, tolerance in (({"sign": True}, 0.05), ({}, 0.05)):
        a, b = (s.compute_distance(longest, **options) for s in (ours, theirs))
        print(f"{shape}, fast marching {options}: {abs(a - b).max() / d.max():.2g}")
        assert abs(a - b).max() < tolerance * d.max()
        far = abs(b) > 0.1
        assert (np.sign(a[far]) == np.sign(b[far])).all()
    E = pp3d.edges(V, F)
    line = [int(v) for v in dict.fromkeys(E[e, 0] for e, _ in longest[0][:-1])]
    N = np.zeros_like(V)
    for k in range(3):
        a, b, c = (V[F[:, i]] for i in range(3))
        np.add.at(N, F[:, k], np.cross(b - a, c - a))
    a, b = (m.PolygonMeshHeatSolver(V, F.tolist()) for m in (pp3d, real))
    a, b = (s.compute_signed_distance([[*line, line[0]]]) for s in (a, b))
    c, e = (m.PointCloudHeatSolver(V) for m in (pp3d, real))
    c, e = (s.compute_signed_distance([[*line, line[0]]], N) for s in (c, e))
    for name, x, y in (("polygons", a, b), ("cloud", c, e)):
        print(f"{shape}, {name}: {abs(x - y).max() / d.max():.2g}")
        assert (x.shape, x.dtype) == (y.shape, y.dtype)
        far = abs(y) > 0.2
        assert (np.sign(x[far]) == np.sign(y[far])).mean() > 0.99


def test_lines_and_matrices_side_by_side(real, spot):
    V, F = spot
    d = littoral.distance((V, F), points=[7], method="exact").values
    ours, theirs = (m.marching_triangles(V, F, d, 0.41) for m in (pp3d, real))
    assert len(ours) == len(theirs)
    key = lambda line: [(e, [round(t[0], 9)]) for e, t in line]  # noqa: E731
    for a, b in zip(
        sorted(map(key, ours), key=len), sorted(map(key, theirs), key=len), strict=True
    ):
        assert len(a) == len(b) and sorted(a[1:]) == sorted(b[1:])
        turn = b[:-1].index(a[0])
        assert a[:-1] == b[turn:-1] + b[:turn]  # the same direction
    assert type(ours[0][0]) is type(theirs[0][0]) and type(ours[0][0][1]) is list
    np.testing.assert_array_equal(pp3d.edges(V, F), real.edges(V, F))
    assert pp3d.edges(V, F).dtype == real.edges(V, F).dtype
    a, b = pp3d.cotan_laplacian(V, F, 1e-12), real.cotan_laplacian(V, F, 1e-12)
    assert type(a) is type(b) and abs(a - b).max() < 1e-9
    np.testing.assert_allclose(pp3d.face_areas(V, F), real.face_areas(V, F), atol=1e-15)
    np.testing.assert_allclose(pp3d.vertex_areas(V, F), real.vertex_areas(V, F), atol=1e-15)


def test_files_side_by_side(real, tmp_path, spot):
    V, F = spot
    pp3d.write_mesh(V, F, tmp_path / "a.obj")
    real.write_mesh(V, F, str(tmp_path / "b.obj"))
    for module in (pp3d, real):
        for name in ("a.obj", "b.obj"):
            W, G = module.read_mesh(str(tmp_path / name))
            np.testing.assert_allclose(W, V, atol=1e-15)
            np.testing.assert_array_equal(G, F)
            assert (W.dtype, G.dtype) == (np.float64, np.int64)
            assert module.read_polygon_mesh(str(tmp_path / name))[1] == F.tolist()
    pp3d.write_mesh(V, F, tmp_path / "a.obj", V[:, :2], "per-vertex")
    real.write_mesh(V, F, str(tmp_path / "b.obj"), V[:, :2], "per-vertex")
    real.write_point_cloud(V, str(tmp_path / "b.ply"))
    pp3d.write_point_cloud(V, tmp_path / "a.ply")
    for module in (pp3d, real):
        for name in ("a.ply", "b.ply"):
            np.testing.assert_array_equal(module.read_point_cloud(str(tmp_path / name)), V)
        np.testing.assert_array_equal(module.read_mesh(str(tmp_path / "a.obj"))[1], F)
