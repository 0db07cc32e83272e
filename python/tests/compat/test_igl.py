"""littoral.compat.igl: known answers, and side by side with libigl where it is."""

from __future__ import annotations

import numpy as np
import pytest

import littoral
import littoral.compat.igl as igl

TYPES = list(igl.SignedDistanceType)
PSEUDONORMAL = igl.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
UNSIGNED = igl.SIGNED_DISTANCE_TYPE_UNSIGNED
FAST = igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER


@pytest.fixture(scope="module")
def real():
    return pytest.importorskip("igl")


@pytest.fixture(scope="module")
def cube():
    mesh = littoral.examples.cube()
    return np.array(mesh.points), np.array(mesh.faces, np.int64)


def shape_of(name, shapes):
    """One of the shapes, and points around."""
    V, F = shapes[name]
    rng = np.random.default_rng(0)
    return V, F.astype(np.int64), rng.uniform(V.min(0) - 0.2, V.max(0) + 0.2, (400, 3))


def box_distance(x: np.ndarray) -> np.ndarray:
    q = np.abs(x - 0.5) - 0.5
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)


# ------------------------------------------------------------------ without the real package


@pytest.mark.parametrize("sign", TYPES)
def test_signed_distance_around_a_cube(cube, sign):
    x = np.random.default_rng(1).uniform(-0.5, 1.5, (500, 3))
    S, at, C, N = igl.signed_distance(x, *cube, sign_type=sign)
    exact = abs(box_distance(x)) if sign == UNSIGNED else box_distance(x)
    np.testing.assert_allclose(S, exact, atol=1e-5)
    np.testing.assert_allclose(np.linalg.norm(x - C, axis=1), abs(exact), atol=1e-12)
    corners = cube[0][cube[1][at]]
    np.testing.assert_allclose(np.clip(C, corners.min(axis=1), corners.max(axis=1)), C, atol=1e-12)
    assert (S.dtype, at.dtype, C.shape) == (np.float64, np.int64, (500, 3))
    assert N.shape == ((500, 3) if sign == PSEUDONORMAL else (0, 0))
    if sign == PSEUDONORMAL:
        np.testing.assert_allclose(np.linalg.norm(N, axis=1), 1, atol=1e-12)
        assert (np.sign(((x - C) * N).sum(axis=1)) == np.sign(S)).all()
        inside = box_distance(x) < 0
        np.testing.assert_allclose(((C - x) / -S[:, None])[inside], N[inside], atol=1e-9)


def test_bounds(cube):
    x = np.random.default_rng(1).uniform(-0.5, 1.5, (500, 3))
    d = box_distance(x)
    S, at, C, _ = igl.signed_distance(x, *cube, lower_bound=-0.1, upper_bound=0.2)
    out = abs(d) >= 0.2
    assert (np.isnan(S) == out).all() and (at[out] == 13).all() and (C[out] == 0).all()
    np.testing.assert_allclose(S[~out], d[~out], atol=1e-5)
    with pytest.raises(ValueError, match="lower_bound"):
        igl.signed_distance(x, *cube, lower_bound=1, upper_bound=-1)


def test_an_open_cube_scales_as_libigl_does(cube):
    V, F = cube
    x = np.array([[0.5, 0.5, 0.4], [0.5, 0.5, 3.0]])
    S, _, C, _ = igl.signed_distance(x, V, F[2:])
    w = igl.winding_number(V, F[2:], x)
    np.testing.assert_allclose(S, (1 - 2 * w) * np.linalg.norm(x - C, axis=1), atol=1e-12)
    assert igl.signed_distance(x, V, F[2:], FAST)[0].shape == (2,)


def test_winding_numbers(cube):
    V, F = cube
    x = np.array([[0.5, 0.5, 0.5], [2, 0, 0]])
    np.testing.assert_allclose(igl.winding_number(V, F, x), [1, 0], atol=1e-6)
    np.testing.assert_allclose(igl.fast_winding_number(V, F, x), [1, 0], atol=1e-6)
    np.testing.assert_allclose(igl.fast_winding_number(V=V, F=F, Q=x), [1, 0], atol=1e-6)
    one = igl.winding_number(V, F, x[0])
    assert isinstance(one, float) and one == pytest.approx(1)
    assert igl.winding_number(V, F, o=x[0]) == pytest.approx(1)
    bvh = igl.FastWindingNumberBVH()
    with pytest.raises(ValueError, match="init"):
        bvh.winding_number(x)
    bvh.init(V, F)
    np.testing.assert_allclose(bvh.winding_number(x), [1, 0], atol=1e-6)
    ball = littoral.examples.sphere(3)
    P = np.array(ball.points)
    A = np.full(len(P), 4 * np.pi / len(P))
    w = igl.fast_winding_number(P, P, A, [[0, 0, 0], [3, 0, 0], P[5]])
    np.testing.assert_allclose(w[:2], [1, 0], atol=1e-3)
    assert np.isfinite(w).all()
    np.testing.assert_array_equal(
        w, igl.fast_winding_number(P, P, A, Q=[[0, 0, 0], [3, 0, 0], P[5]])
    )


def test_squared_distance(cube):
    V, F = cube
    x = np.random.default_rng(1).uniform(-0.5, 1.5, (100, 3))
    D, at, C = igl.point_mesh_squared_distance(x, V, F)
    np.testing.assert_allclose(D, box_distance(x) ** 2, atol=1e-12)
    assert (D.dtype, at.dtype, C.shape) == (np.float64, np.int64, (100, 3))
    D, at, C = igl.point_mesh_squared_distance(x, V, np.arange(8)[::-1, None])
    every = ((x[:, None] - V[::-1]) ** 2).sum(axis=2)
    np.testing.assert_allclose(D, every.min(axis=1), atol=1e-12)
    assert (every.argmin(axis=1) == at).all()
    np.testing.assert_array_equal(C, V[::-1][at])
    flat = littoral.examples.square(4)
    D, _, C = igl.point_mesh_squared_distance(
        [[2, 0.5], [0.1, 0.2]], flat.points[:, :2], flat.faces
    )
    np.testing.assert_allclose(D, [1, 0], atol=1e-12)
    np.testing.assert_allclose(C, [[1, 0.5], [0.1, 0.2]], atol=1e-12)


def test_exact_geodesic(square):
    V, F = np.array(square.points), np.array(square.faces)
    VT, FT = np.arange(0, 81, 7), np.arange(0, 128, 5)
    to = np.concatenate([V[VT], V[F[FT]].mean(axis=1)])
    d = igl.exact_geodesic(V, F, VS=np.array([7]), VT=VT, FT=FT)
    np.testing.assert_allclose(d, np.linalg.norm(to - V[7], axis=1), atol=1e-12)
    d = igl.exact_geodesic(V[:, :2], F, FS=np.array([7, 100]), VT=VT, FT=FT)
    centers = V[F[[7, 100]]].mean(axis=1)
    nearest = np.linalg.norm(to[:, None] - centers, axis=2).min(axis=1)
    np.testing.assert_allclose(d, nearest, atol=1e-12)
    assert igl.exact_geodesic(V, F, VS=[7]).shape == (0,)


def test_heat_geodesics(sphere):
    V, F = np.array(sphere.points), np.array(sphere.faces)
    exact = np.arccos(np.clip(V @ V[7], -1, 1))
    h = np.linalg.norm(np.diff(V[sphere.edges], axis=1), axis=2).mean()
    first = None
    for arguments in ({}, {"t": h * h}, {"intrinsic": True}):
        data = igl.HeatGeodesicsData()
        assert data.use_intrinsic_delaunay is False
        data.use_intrinsic_delaunay = arguments.pop("intrinsic", False)
        igl.heat_geodesics_precompute(V, F, data=data, **arguments)
        d = igl.heat_geodesics_solve(data, np.array([7]))
        np.testing.assert_allclose(d, exact, atol=0.03)
        first = d if first is None else first
        np.testing.assert_allclose(d, first, atol=1e-9)
    data = igl.HeatGeodesicsData()
    igl.heat_geodesics_precompute(V, F, data)
    np.testing.assert_array_equal(igl.heat_geodesics_solve(data, [7]), first)


def test_wrong_arguments_and_what_is_missing(cube):
    V, F = cube
    data = igl.HeatGeodesicsData()
    for call, error in (
        (lambda: igl.signed_distance(V[0], V, F), ValueError),
        (lambda: igl.signed_distance(V, V, F[:, :2]), ValueError),
        (lambda: igl.signed_distance(V, V, F + 1), IndexError),
        (lambda: igl.signed_distance(V, V, F, "winding"), TypeError),
        (lambda: igl.winding_number(V, F), TypeError),
        (lambda: igl.fast_winding_number(V, F), TypeError),
        (lambda: igl.fast_winding_number(V, V, V[:, 0], V, order=2), TypeError),
        (lambda: igl.fast_winding_number(V, V, V[:3, 0], V), ValueError),
        (lambda: igl.point_mesh_squared_distance(V, V, F + 1), IndexError),
        (lambda: igl.exact_geodesic(V, F, VT=[1]), ValueError),
        (lambda: igl.exact_geodesic(V, F, VS=[8], VT=[1]), IndexError),
        (lambda: igl.exact_geodesic(V, F, VS=[0], FT=[12]), IndexError),
        (lambda: igl.heat_geodesics_solve(data, [0]), ValueError),
        (lambda: igl.heat_geodesics_precompute(V, F, 0.1), TypeError),
        (lambda: igl.heat_geodesics_precompute(V, F, -1.0, data), ValueError),
    ):
        with pytest.raises(error):
            call()
    igl.heat_geodesics_precompute(V, F, data)
    for gamma, error in (([], ValueError), ([8], IndexError), ([0.5], TypeError)):
        with pytest.raises(error):
            igl.heat_geodesics_solve(data, gamma)
    for call in (
        lambda: igl.signed_distance(V[:, :2], V[:, :2], F[:, :2]),
        lambda: igl.winding_number(V[:, :2], F[:, :2], V[:, :2]),
        lambda: igl.point_mesh_squared_distance(V, V, F[:, :2]),
        lambda: igl.fast_winding_number_precompute(V, V, V[:, 0], [[0]], F),
        lambda: igl.fast_winding_number(V, V, V[:, 0], [[0]], F, V, V[:, 0], V, V),
    ):
        with pytest.raises(littoral.UnsupportedError, match=r"littoral has no .*; "):
            call()


# ------------------------------------------------------------------ side by side


def test_the_names_are_the_same(real):
    for name, sign in real.SignedDistanceType.__members__.items():
        assert igl.SignedDistanceType[name].value == sign.value
        assert getattr(igl, name) is igl.SignedDistanceType[name]
    assert len(igl.SignedDistanceType) == len(real.SignedDistanceType)
    assert all(hasattr(real, name) for name in igl.__all__)


@pytest.mark.slow
@pytest.mark.parametrize("sign", TYPES)
@pytest.mark.parametrize("name", ["spot", "broken", "ball"])
def test_signed_distance_side_by_side(real, name, sign, shapes):
    V, F, x = shape_of(name, shapes)
    theirs = real.signed_distance(x, V, F, real.SignedDistanceType[sign.name])
    ours = igl.signed_distance(x, V, F, real.SignedDistanceType[sign.name])
    for a, b in zip(ours, theirs, strict=True):
        assert (type(a), a.shape, a.dtype) == (type(b), b.shape, b.dtype)
    S = abs(ours[0] - theirs[0]).max()
    exact = sign in (PSEUDONORMAL, UNSIGNED)
    print(f"{name}, {sign.name}: S {S:.2g}, C {abs(ours[2] - theirs[2]).max():.2g}")
    assert (1e-12 if exact else 5e-3) > S
    np.testing.assert_allclose(ours[2], theirs[2], atol=1e-9)
    if sign == PSEUDONORMAL:
        same = ours[1] == theirs[1]
        np.testing.assert_allclose(ours[3][same], theirs[3][same], atol=1e-6)
    a, b = (m.signed_distance(x, V, F, lower_bound=-0.05, upper_bound=0.1) for m in (igl, real))
    assert (np.isnan(a[0]) == np.isnan(b[0])).all()
    assert (a[1][np.isnan(a[0])] == b[1][np.isnan(a[0])]).all()
    assert [v.shape for v in igl.signed_distance(x[:0], V, F)] == [(0,), (0,), (0, 3), (0, 0)]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["spot", "broken", "ball"])
def test_winding_and_nearest_side_by_side(real, name, shapes):
    V, F, x = shape_of(name, shapes)
    for f in ("winding_number", "fast_winding_number"):
        ours, theirs = (getattr(m, f)(V, F, x) for m in (igl, real))
        print(f"{name}, {f}: {abs(ours - theirs).max():.2g}")
        np.testing.assert_allclose(ours, theirs, atol=1e-3 if f == "winding_number" else 5e-3)
        assert (ours.shape, ours.dtype) == (theirs.shape, theirs.dtype)
    assert type(igl.winding_number(V, F, x[0])) is type(real.winding_number(V, F, x[0]))
    P, N = V, V / np.linalg.norm(V, axis=1, keepdims=True)
    A = np.full(len(V), 1 / len(V))
    ours, theirs = igl.fast_winding_number(P, N, A, x), real.fast_winding_number(P, N, A, x, 2, 0.0)
    np.testing.assert_allclose(ours, theirs, rtol=1e-9, atol=1e-9)
    for elements in (F, np.arange(0, len(V), 3)[:, None]):
        ours, theirs = (m.point_mesh_squared_distance(x, V, elements) for m in (igl, real))
        np.testing.assert_allclose(ours[0], theirs[0], atol=1e-12)
        np.testing.assert_allclose(ours[2], theirs[2], atol=1e-9)
        assert [(a.shape, a.dtype) for a in ours] == [(b.shape, b.dtype) for b in theirs]


@pytest.mark.parametrize("name", ["spot", "broken", "ball"])
def test_geodesics_side_by_side(real, name, shapes):
    V, F, _ = shape_of(name, shapes)
    sources = {"VS": np.array([7, 100]), "FS": np.array([50])}
    targets = {"VT": np.arange(0, len(V), 20), "FT": np.arange(0, len(F), 100)}
    ours, theirs = (m.exact_geodesic(V, F, **sources, **targets) for m in (igl, real))
    print(f"{name}, exact: {abs(ours - theirs).max():.2g}")
    np.testing.assert_allclose(ours, theirs, atol=1e-8)
    assert (ours.shape, ours.dtype) == (theirs.shape, theirs.dtype)
    for intrinsic in (False, True):
        for time in ((), (1e-3,)):
            answers = []
            for m in (igl, real):
                data = m.HeatGeodesicsData()
                data.use_intrinsic_delaunay = intrinsic
                m.heat_geodesics_precompute(V, F, *time, data)
                answers.append(m.heat_geodesics_solve(data, np.array([7])))
            ours, theirs = answers
            error = abs(ours - theirs).max() / theirs.max()
            print(f"{name}, heat, intrinsic {intrinsic}, t {time}: {error:.2g}")
            assert error < 0.02
            assert (ours.shape, ours.dtype) == (theirs.shape, theirs.dtype)


def test_names_that_are_missing_say_what_to_use(real):
    with pytest.raises(AttributeError, match=r"no cotmatrix; -littoral.operators\(\(V, F\)\).L"):
        _ = igl.cotmatrix
    with pytest.raises(AttributeError, match="what libigl has of that name"):
        _ = igl.boundary_loop
    assert not hasattr(igl, "massmatrix")
    cube = littoral.examples.cube()
    V, F = np.array(cube.points), np.array(cube.faces)
    np.testing.assert_allclose(
        real.cotmatrix(V, F).toarray(), -littoral.operators((V, F)).L.toarray(), atol=1e-12
    )


def test_points_nearest_to_one_or_two_points():
    V = np.array([[0, 0, 0], [2, 0, 0], [0, 9, 0.0]])
    D, nearest, C = igl.point_mesh_squared_distance([[-1, 0, 0], [3, 0, 0]], V, [[0], [1], [1]])
    assert (D.tolist(), nearest.tolist()) == ([1, 1], [0, 1])
    np.testing.assert_array_equal(C, V[:2])
    D, nearest, C = igl.point_mesh_squared_distance([[0, 8]], V[:, :2], [[2]])
    assert (D.tolist(), nearest.tolist(), C.tolist()) == ([1], [0], [[0, 9]])


def test_no_points_have_no_nearest(cube):
    for P, columns in (([], 3), (np.zeros((0, 3)), 3), (np.zeros((0, 2)), 2)):
        D, nearest, C = igl.point_mesh_squared_distance(P, *cube)
        assert (D.shape, nearest.shape, C.shape) == ((0,), (0,), (0, columns))
