"""The scene of Open3D, without rays."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import littoral
from littoral.compat.open3d import RaycastingScene


def box_distance(x):
    """To the unit cube, negative inside."""
    q = np.abs(x - 0.5) - 0.5
    return np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0)


@pytest.fixture
def x():
    return np.random.default_rng(1).uniform(-0.5, 1.5, (300, 3)).astype(np.float32)


@pytest.fixture
def scene():
    out = RaycastingScene()
    assert out.add_triangles(littoral.examples.cube()) == 0
    return out


def test_a_cube_is_exact(scene, x):
    exact = box_distance(x.astype(float))
    signed = scene.compute_signed_distance(x)
    np.testing.assert_allclose(signed, exact, atol=1e-7)
    np.testing.assert_array_equal(scene.compute_distance(x), np.abs(signed))
    np.testing.assert_array_equal(scene.compute_occupancy(x), exact < 0)
    found = scene.compute_closest_points(x)
    np.testing.assert_allclose(
        np.linalg.norm(x - found["points"], axis=1), np.abs(exact), atol=1e-6
    )
    cube = littoral.examples.cube()
    corners = cube.points[np.asarray(cube.faces)[found["primitive_ids"]]]
    u, v = found["primitive_uvs"].T[..., None]
    at = (1 - u - v) * corners[:, 0] + u * corners[:, 1] + v * corners[:, 2]
    np.testing.assert_allclose(at, found["points"], atol=1e-6)
    normals = np.asarray(found["primitive_normals"])
    np.testing.assert_allclose(((corners[:, 0] + 0.01 * normals) - 0.5).__abs__().max(axis=1), 0.51)


def test_types_and_shapes(scene):
    x = np.zeros((2, 4, 3))
    for value in (scene.compute_distance(x), scene.compute_signed_distance(x)):
        assert value.shape == (2, 4) and value.dtype == np.float32
    assert type(value.numpy()) is np.ndarray
    assert scene.compute_occupancy(x).dtype == np.float32
    found = scene.compute_closest_points(x)
    assert {name: (a.shape[2:], a.dtype.name) for name, a in found.items()} == {
        "points": ((3,), "float32"),
        "geometry_ids": ((), "uint32"),
        "primitive_ids": ((), "uint32"),
        "primitive_uvs": ((2,), "float32"),
        "primitive_normals": ((3,), "float32"),
    }
    assert scene.compute_distance(np.zeros((0, 3))).shape == (0,)


def test_several_meshes(scene):
    cube = littoral.examples.cube()
    before = scene.compute_distance([[3.5, 3.5, 3.5]])
    assert scene.add_triangles(np.array(cube.points) + 3, np.array(cube.faces)) == 1
    after = scene.compute_signed_distance([[3.5, 3.5, 3.6], [0.5, 0.5, 0.4]])
    assert before > 4
    np.testing.assert_allclose(after, [-0.4, -0.4], atol=1e-6)
    found = scene.compute_closest_points([[3.5, 3.4, 3.6], [0.5, 0.4, 0.4]])
    assert found["geometry_ids"].tolist() == [1, 0]
    assert found["primitive_ids"].max() < 12


def test_an_empty_scene(x):
    scene = RaycastingScene()
    assert np.isinf(scene.compute_distance(x)).all()
    assert not scene.compute_occupancy(x).any()
    found = scene.compute_closest_points(x)
    assert (found["primitive_ids"] == RaycastingScene.INVALID_ID).all()
    assert (found["geometry_ids"] == RaycastingScene.INVALID_ID).all()
    assert np.isnan(found["points"]).all()
    assert scene.add_triangles(np.zeros((0, 3)), np.zeros((0, 3), int)) == 0
    assert np.isinf(scene.compute_signed_distance(x)).all()


def test_a_hole_is_bridged():
    cube = littoral.examples.cube()
    scene = RaycastingScene()
    scene.add_triangles(np.array(cube.points), np.array(cube.faces)[2:])
    assert scene.compute_occupancy([[0.5, 0.5, 0.5], [0.5, 0.5, -0.5]]).tolist() == [1, 0]


def test_what_raises(scene):
    for bad in (np.zeros(3), np.zeros((2, 2)), [[np.nan, 0, 0]]):
        with pytest.raises(ValueError, match="query_points"):
            scene.compute_distance(bad)
    with pytest.raises(TypeError):
        scene.compute_distance([["a", "b", "c"]])
    with pytest.raises(ValueError, match="odd"):
        scene.compute_occupancy(np.zeros((1, 3)), nsamples=2)
    with pytest.raises(IndexError):
        scene.add_triangles(np.zeros((2, 3)), [[0, 1, 2]])
    with pytest.raises(TypeError):
        scene.add_triangles(np.zeros((3, 3)), [[0.0, 1.0, 2.0]])
    with pytest.raises(TypeError, match="not both"):
        scene.add_triangles(np.zeros((3, 3)), [[0, 1, 2]], mesh=littoral.examples.cube())
    with pytest.raises(ValueError, match="expected triangles"):
        scene.add_triangles(littoral.examples.quads(2))
    with pytest.raises(littoral.UnsupportedError, match="CPU"):
        RaycastingScene(device="CUDA:0")
    for name in ("cast_rays", "count_intersections", "list_intersections", "test_occlusions"):
        with pytest.raises(littoral.UnsupportedError, match="casts no rays"):
            getattr(scene, name)(np.zeros((1, 6)))
    with pytest.raises(littoral.UnsupportedError, match="casts no rays"):
        scene.create_rays_pinhole(60, [0, 0, 0], [1, 0, 0], [0, 0, 1], 4, 4)


@pytest.fixture(params=["spot", "sphere", "two"])
def both(request, spot, sphere):
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    cube = littoral.examples.cube()
    parts = {
        "spot": [spot],
        "sphere": [(sphere.points, sphere.faces)],
        "two": [(cube.points, cube.faces), (cube.points + np.array([2, 0.3, 0.1]), cube.faces)],
    }[request.param]
    real, ours = open3d.t.geometry.RaycastingScene(), RaycastingScene()
    for V, F in parts:
        arrays = np.array(V, np.float32), np.array(F, np.uint32)
        assert real.add_triangles(*arrays) == ours.add_triangles(*arrays)
    low, high = np.min([V.min(0) for V, _ in parts], 0), np.max([V.max(0) for V, _ in parts], 0)
    x = np.random.default_rng(2).uniform(low - 0.2, high + 0.2, (20, 25, 3)).astype(np.float32)
    return real, ours, x


def test_side_by_side(both):
    real, ours, x = both
    for name in ("compute_distance", "compute_signed_distance", "compute_occupancy"):
        expected = getattr(real, name)(x).numpy()
        got = getattr(ours, name)(x).numpy()
        assert got.dtype == expected.dtype and got.shape == expected.shape
        np.testing.assert_allclose(got, expected, atol=1e-6, err_msg=name)
    expected, got = real.compute_closest_points(x), ours.compute_closest_points(x)
    assert set(expected) == set(got)
    for name in got:
        assert got[name].numpy().dtype == expected[name].numpy().dtype
        assert got[name].numpy().shape == expected[name].numpy().shape
    # Open3D rounds to single precision where it searches
    np.testing.assert_allclose(got["points"].numpy(), expected["points"].numpy(), atol=1e-4)
    np.testing.assert_array_equal(got["geometry_ids"], expected["geometry_ids"].numpy())
    u, v = np.moveaxis(got["primitive_uvs"].numpy(), -1, 0)
    within = np.minimum(np.minimum(u, v), 1 - u - v) > 1e-3  # elsewhere others are as near
    assert within.any()
    for name, atol in (("primitive_ids", 0), ("primitive_uvs", 1e-3), ("primitive_normals", 1e-4)):
        np.testing.assert_allclose(
            got[name].numpy()[within], expected[name].numpy()[within], atol=atol, err_msg=name
        )


def test_tensors_in_and_out():
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    mesh = open3d.t.geometry.TriangleMesh.create_box()
    scene = RaycastingScene(device=open3d.core.Device("CPU:0"))
    scene.add_triangles(mesh)
    assert scene.add_triangles(mesh.vertex.positions + 3, mesh.triangle.indices) == 1
    x = open3d.core.Tensor([[0.5, 0.5, 0.4], [3.5, 3.5, 3.4]], open3d.core.float32)
    got = scene.compute_signed_distance(x)
    assert isinstance(got, open3d.core.Tensor) and got.dtype == open3d.core.float32
    np.testing.assert_allclose(got.numpy(), [-0.4, -0.4], atol=1e-6)
    ids = scene.compute_closest_points(x)["geometry_ids"]
    assert ids.dtype == open3d.core.uint32 and ids.numpy().tolist() == [0, 1]


def test_names():
    open3d = pytest.importorskip("open3d", exc_type=ImportError)
    real = open3d.t.geometry.RaycastingScene
    for name in dir(real):
        assert name.startswith("_") or hasattr(RaycastingScene, name), name
    assert real.INVALID_ID == RaycastingScene.INVALID_ID
    for name in ("compute_distance", "compute_signed_distance", "compute_occupancy"):
        names = list(inspect.signature(getattr(RaycastingScene, name)).parameters)
        assert ", ".join(names[1:2]) in getattr(real, name).__doc__
        assert all(f"{each}:" in getattr(real, name).__doc__ for each in names)
