"""The names of trimesh's proximity queries."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import littoral
from littoral.compat import trimesh as ours


def box_distance(x):
    """To the unit cube, negative inside."""
    q = np.abs(x - 0.5) - 0.5
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)


@pytest.fixture(scope="module")
def cube():
    return littoral.examples.cube()


@pytest.fixture(scope="module")
def x():
    return np.random.default_rng(1).uniform(-0.5, 1.5, (500, 3))


def test_a_cube_is_exact(cube, x):
    exact = box_distance(x)
    np.testing.assert_allclose(ours.signed_distance(cube, x), -exact, atol=1e-12)
    np.testing.assert_array_equal(ours.contains(cube, x), exact < 0)
    closest, distance, triangle = ours.closest_point(cube, x)
    np.testing.assert_allclose(distance, np.abs(exact), atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(x - closest, axis=1), distance, atol=1e-12)
    flat = np.abs(closest - 0.5).max(axis=1)
    np.testing.assert_allclose(flat, 0.5, atol=1e-12)
    corners = cube.points[np.asarray(cube.faces)[triangle]]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    np.testing.assert_allclose(((closest - corners[:, 0]) * normals).sum(axis=1), 0, atol=1e-12)
    assert (closest.dtype, distance.dtype, triangle.dtype) == (float, float, np.int64)


def test_a_query_answers_as_the_functions(cube, x):
    query = ours.ProximityQuery(cube)
    np.testing.assert_array_equal(query.signed_distance(x), ours.signed_distance(cube, x))
    np.testing.assert_array_equal(query.contains(x), ours.contains(cube, x))
    for one, other in zip(query.on_surface(x), ours.closest_point(cube, x), strict=True):
        np.testing.assert_array_equal(one, other)
    assert isinstance(query.sdf, littoral.SDF)
    np.testing.assert_allclose(query.sdf(x), -query.signed_distance(x))
    distance, vertex = query.vertex(x)
    to_all = np.linalg.norm(x[:, None] - cube.points[None], axis=2)
    np.testing.assert_allclose(distance, to_all.min(axis=1), atol=1e-12)
    np.testing.assert_array_equal(vertex, to_all.argmin(axis=1))


def test_positive_on_the_surface_and_empty(cube):
    on = np.array([[0.3, 0.4, 1.0], [0.3, 0.4, 1 + 5e-9], [0.3, 0.4, 1 + 1e-7]])
    got = ours.signed_distance(cube, on)
    assert (got[:2] >= 0).all() and got[2] < 0
    assert ours.signed_distance(cube, np.zeros((0, 3))).shape == (0,)
    assert ours.contains(cube, []).shape == (0,)


def test_inside_out_has_the_same_inside(cube, x):
    turned = littoral.Mesh(cube.points, np.asarray(cube.faces)[:, ::-1])
    np.testing.assert_allclose(
        ours.signed_distance(turned, x), ours.signed_distance(cube, x), atol=1e-12
    )


def test_a_hole_is_bridged(sphere):
    V, F = np.array(sphere.points), np.array(sphere.faces)
    cap = V[F].mean(axis=1)[:, 2] < 0.8
    x = np.random.default_rng(2).uniform(-1.5, 1.5, (2000, 3))
    far = np.linalg.norm(x - [0, 0, 0.8], axis=1) > 0.8
    opened = littoral.Mesh(V, F[cap])
    np.testing.assert_array_equal(ours.contains(opened, x)[far], ours.contains(sphere, x)[far])
    assert ours.signed_distance(opened, [[0, 0, 0]]) > 0.9


def test_what_was_prepared_is_kept_until_the_mesh_changes(cube, monkeypatch):
    made = []
    real = littoral.SDF.__init__
    monkeypatch.setattr(
        littoral.SDF, "__init__", lambda self, *a, **k: (made.append(1), real(self, *a, **k))[1]
    )
    V, F = np.array(cube.points) * 1.25, np.array(cube.faces)
    for _ in range(3):
        assert ours.contains((V, F), [[1.2, 1.2, 1.2]]).all()
    assert len(made) == 1
    V *= 0.5
    assert not ours.contains((V, F), [[1.2, 1.2, 1.2]]).any()
    assert len(made) == 2


def test_a_query_takes_the_mesh_when_it_is_first_asked():
    # trimesh makes one for each mesh, before its vertices are there.
    cube = littoral.examples.cube()
    V = np.array(cube.points)
    query = ours.ProximityQuery((V, cube.faces))
    V *= 2
    np.testing.assert_allclose(query.signed_distance([[1, 1, 1]]), 1)


def test_bad_input(cube):
    for points in (np.zeros(3), np.zeros((2, 2)), np.zeros((1, 2, 3)), [[np.nan, 0, 0]]):
        with pytest.raises(ValueError, match="points"):
            ours.closest_point(cube, points)
    with pytest.raises(TypeError):
        ours.contains(cube, [["a", "b", "c"]])
    with pytest.raises(TypeError, match="expected a littoral surface"):
        ours.signed_distance(7, [[0, 0, 0]])
    with pytest.raises(ValueError, match="faces"):
        ours.contains(littoral.PointCloud(np.eye(3)), [[0, 0, 0]])


@pytest.fixture(scope="module", params=["spot", "sphere", "cube"])
def theirs(request, spot, sphere):
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("rtree")
    pytest.importorskip("scipy")
    cube = littoral.examples.cube()
    V, F = {
        "spot": spot,
        "sphere": (sphere.points, sphere.faces),
        "cube": (cube.points, cube.faces),
    }[request.param]
    mesh = trimesh.Trimesh(np.array(V), np.array(F), process=False)
    low, high = mesh.bounds
    margin = 0.2 * (high - low)
    x = np.random.default_rng(3).uniform(low - margin, high + margin, (400, 3))
    return mesh, x


@pytest.mark.slow
def test_side_by_side(theirs):
    from trimesh import proximity

    mesh, x = theirs
    query, real = ours.ProximityQuery(mesh), proximity.ProximityQuery(mesh)
    expected = real.signed_distance(x)
    got = query.signed_distance(x)
    assert got.dtype == expected.dtype and got.shape == expected.shape
    np.testing.assert_allclose(got, expected, atol=1e-7)
    assert (got > 0).any() and (got < 0).any()
    np.testing.assert_array_equal(ours.contains(mesh, x), mesh.contains(x))
    closest, distance, triangle = real.on_surface(x)
    ours_closest, ours_distance, ours_triangle = query.on_surface(x)
    np.testing.assert_allclose(ours_distance, distance, atol=1e-7)
    np.testing.assert_allclose(ours_closest, closest, atol=1e-7)
    assert ours_triangle.dtype == triangle.dtype and ours_triangle.shape == triangle.shape
    found = query.sdf.closest(x)
    within = found.barycentric.min(axis=1) > 1e-6  # elsewhere several triangles are as near
    assert within.any()
    np.testing.assert_array_equal(ours_triangle[within], triangle[within])
    for one, other in zip(query.vertex(x), real.vertex(x), strict=True):
        assert one.dtype == other.dtype
        np.testing.assert_allclose(one, other, atol=1e-7)


def test_side_by_side_with_a_hole(spot):
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("rtree")
    V, F = spot
    kept = np.arange(len(F)) >= 40
    mesh = trimesh.Trimesh(V, F[kept], process=False)
    x = np.random.default_rng(4).uniform(V.min(axis=0), V.max(axis=0), (400, 3))
    expected, got = trimesh.proximity.signed_distance(mesh, x), ours.signed_distance(mesh, x)
    np.testing.assert_allclose(np.abs(got), np.abs(expected), atol=1e-7)
    assert (np.sign(got) == np.sign(expected)).mean() > 0.97


def test_signatures():
    trimesh = pytest.importorskip("trimesh")
    pairs = [
        (ours.signed_distance, trimesh.proximity.signed_distance),
        (ours.closest_point, trimesh.proximity.closest_point),
    ]
    for name in ("__init__", "signed_distance", "vertex"):
        pairs.append(
            (getattr(ours.ProximityQuery, name), getattr(trimesh.proximity.ProximityQuery, name))
        )
    for one, other in pairs:
        assert list(inspect.signature(one).parameters) == list(inspect.signature(other).parameters)


def test_tracks_changes_of_a_trimesh():
    trimesh = pytest.importorskip("trimesh")
    mesh = trimesh.creation.box()
    assert ours.contains(mesh, [[0.4, 0.4, 0.4]]).all()
    mesh.apply_scale(0.5)
    assert not ours.contains(mesh, [[0.4, 0.4, 0.4]]).any()


def test_names_that_are_missing_say_what_to_use():
    with pytest.raises(AttributeError, match="has no closest_point_naive; closest_point has"):
        _ = ours.closest_point_naive
    with pytest.raises(AttributeError, match="has no thickness; what trimesh has"):
        _ = ours.thickness
