"""The three functions of mesh_to_sdf."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import littoral
from littoral.compat import mesh_to_sdf as ours


def box_distance(x):
    """To the unit cube, negative inside."""
    q = np.abs(x - 0.5) - 0.5
    return np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0)


@pytest.fixture(scope="module")
def cube():
    return littoral.examples.cube()


def test_a_cube_is_exact(cube):
    x = np.random.default_rng(1).uniform(-0.5, 1.5, (300, 3))
    got = ours.mesh_to_sdf(cube, x)
    assert got.dtype == np.float32 and got.shape == (300,)
    np.testing.assert_allclose(got, box_distance(x), atol=1e-7)
    turned = littoral.Mesh(cube.points, np.asarray(cube.faces)[:, ::-1])
    np.testing.assert_allclose(ours.mesh_to_sdf(turned, x), got, atol=1e-7)
    assert ours.mesh_to_sdf(cube, np.zeros((0, 3))).shape == (0,)


def test_voxels_of_a_box():
    cube = littoral.examples.cube()
    box = littoral.Mesh(cube.points * np.array([3.0, 1.5, 0.75]) + 7, cube.faces)
    voxels = ours.mesh_to_voxels(box, 9)
    assert voxels.shape == (9, 9, 9) and voxels.dtype == np.float32
    axis = np.linspace(-1, 1, 9)
    x = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1)
    q = np.abs(x) - np.array([1, 0.5, 0.25])
    exact = np.linalg.norm(np.maximum(q, 0), axis=-1) + np.minimum(q.max(axis=-1), 0)
    np.testing.assert_allclose(voxels, exact, atol=1e-6)
    padded, gradients = ours.mesh_to_voxels(
        box, 9, pad=True, check_result=True, return_gradients=True
    )
    assert padded.shape == (11, 11, 11) and gradients.shape == (11, 11, 11, 3)
    np.testing.assert_array_equal(padded[1:-1, 1:-1, 1:-1], voxels)
    assert (padded[0] == 1).all() and (padded[..., -1] == 1).all()
    np.testing.assert_allclose(np.linalg.norm(gradients, axis=-1), 1, atol=1e-12)
    np.testing.assert_allclose(gradients[5, 10, 5], [0, 1, 0], atol=1e-6)


def test_check_of_the_result(cube, monkeypatch):
    assert ours.mesh_to_voxels(cube, 6, check_result=True).shape == (6, 6, 6)
    jump = np.ones((5, 5, 5), np.float32)
    jump[2, 2, 2] = -1
    monkeypatch.setattr(ours.Nearest, "signed", lambda self, points: jump.ravel())
    with pytest.raises(ours.BadMeshException):
        ours.mesh_to_voxels(cube, 5, check_result=True)
    assert ours.mesh_to_voxels(cube, 5).min() == -1


def test_gradients_point_away_from_the_surface(sphere):
    np.random.seed(1)
    points, values, gradients = ours.sample_sdf_near_surface(sphere, 2000, return_gradients=True)
    assert (points.dtype, values.dtype) == (np.float32, np.float32)
    assert points.shape == gradients.shape == (2000, 3) and values.shape == (2000,)
    radii = np.linalg.norm(points, axis=1)
    np.testing.assert_allclose(values, radii - 1, atol=0.01)
    away = (gradients * points).sum(axis=1) / radii
    assert np.median(away) > 0.99
    np.testing.assert_allclose(np.linalg.norm(gradients, axis=1), 1, atol=1e-6)
    near = int(2000 * 47 / 50) // 2
    assert 0.002 < np.abs(values[:near]).mean() / 0.8 + 0.0005 < 0.004
    assert np.abs(values[near : 2 * near]).mean() < 0.0005
    assert (radii[2 * near :] <= 1 + 1e-6).all() and radii[2 * near :].min() < 0.6


def test_points_repeat_with_the_seed(cube):
    drawn = []
    for _ in range(2):
        np.random.seed(5)
        drawn.append(ours.sample_sdf_near_surface(cube, 100))
    np.testing.assert_array_equal(drawn[0][0], drawn[1][0])
    np.testing.assert_array_equal(drawn[0][1], drawn[1][1])


def test_points_are_spread_by_area():
    np.random.seed(2)
    quads = littoral.Polygons([[0, 0, 0], [3, 0, 0], [3, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    points, _ = ours.sample_sdf_near_surface(quads, 20000)
    near = points[:9400] * 10**0.5 / 2  # back to 3 x 1, about 0
    counts, _, _ = np.histogram2d(near[:, 0], near[:, 1], bins=(3, 2))
    assert np.abs(counts / counts.sum() - 1 / 6).max() < 0.02


def test_what_raises(cube):
    x = np.zeros((1, 3))
    with pytest.raises(TypeError, match="numpy array"):
        ours.mesh_to_sdf(cube, [[0, 0, 0]])
    for bad in (np.zeros(3), np.zeros((1, 2)), np.full((1, 3), np.nan)):
        with pytest.raises(ValueError):
            ours.mesh_to_sdf(cube, bad)
    with pytest.raises(TypeError):
        ours.mesh_to_sdf("cube", x)
    with pytest.raises(ValueError, match="'scan' or 'sample'"):
        ours.mesh_to_sdf(cube, x, surface_point_method="guess")
    with pytest.raises(ValueError, match="'normal' or 'depth'"):
        ours.mesh_to_voxels(cube, 4, sign_method="guess")
    with pytest.raises(ValueError, match="bounding_radius"):
        ours.mesh_to_sdf(cube, x, bounding_radius=-1)
    with pytest.raises(ValueError, match="voxel_resolution"):
        ours.mesh_to_voxels(cube, 1)
    with pytest.raises(ValueError, match="number_of_points"):
        ours.sample_sdf_near_surface(cube, 0)
    with pytest.raises(ours.BadMeshException):
        ours.sample_sdf_near_surface(cube, 1000, min_size=0.9)
    with pytest.raises(ValueError, match="extent"):
        ours.mesh_to_voxels((np.zeros((3, 3)), [[0, 1, 2]]), 4)
    with pytest.raises(littoral.UnsupportedError):
        ours.get_surface_point_cloud(cube)


@pytest.fixture(scope="module")
def theirs():
    return pytest.importorskip("mesh_to_sdf", exc_type=ImportError)


def trimesh_of(V, F):
    trimesh = pytest.importorskip("trimesh")
    return trimesh.Trimesh(np.array(V), np.array(F), process=False)


SAMPLED = {"surface_point_method": "sample", "sample_point_count": 200_000}


def agree(got, expected, spacing):
    """Up to the spacing of the samples, which are all the other one knows."""
    assert got.dtype == expected.dtype and got.shape == expected.shape
    np.testing.assert_allclose(np.abs(got), np.abs(expected), atol=spacing)
    away = np.abs(expected) > spacing
    assert (np.sign(got) == np.sign(expected))[away].mean() > 0.999
    assert (got < 0).any() and (got > 0).any()


def test_side_by_side(theirs, spot):
    np.random.seed(3)
    V, F = spot
    mesh = trimesh_of(V, F)
    x = np.random.default_rng(3).uniform(V.min(0) - 0.1, V.max(0) + 0.1, (1000, 3))
    agree(ours.mesh_to_sdf(mesh, x), theirs.mesh_to_sdf(mesh, x, **SAMPLED), 0.02)


def test_voxels_side_by_side(theirs, spot):
    np.random.seed(4)
    mesh = trimesh_of(*spot)
    for words in ({}, {"pad": True}):
        agree(
            ours.mesh_to_voxels(mesh, 12, **words),
            theirs.mesh_to_voxels(mesh, 12, **SAMPLED, **words),
            0.025,
        )
    one = ours.mesh_to_voxels(mesh, 12, return_gradients=True)
    other = theirs.mesh_to_voxels(mesh, 12, return_gradients=True, **SAMPLED)
    assert [a.shape for a in one] == [a.shape for a in other]
    assert [a.dtype for a in one] == [a.dtype for a in other]
    far = np.abs(other[0]) > 0.1
    assert np.median((one[1] * other[1]).sum(axis=-1)[far]) > 0.99


def test_samples_side_by_side(theirs, sphere):
    np.random.seed(5)
    mesh = trimesh_of(sphere.points, sphere.faces)
    mesh.apply_transform(np.diag([2.0, 2.0, 2.0, 1.0]))
    one = ours.sample_sdf_near_surface(mesh, 4000, return_gradients=True)
    other = theirs.sample_sdf_near_surface(mesh, 4000, return_gradients=True, **SAMPLED)
    assert [a.shape for a in one] == [a.shape for a in other]
    assert [a.dtype for a in one] == [a.dtype for a in other]
    for share in (slice(0, 1880), slice(1880, 3760), slice(3760, 4000)):
        deep, other_deep = np.abs(one[1][share]).mean(), np.abs(other[1][share]).mean()
        assert abs(deep - other_deep) < 0.25 * other_deep + 0.004


def test_signatures(theirs):
    for name in ("mesh_to_sdf", "mesh_to_voxels", "sample_sdf_near_surface"):
        one, other = (inspect.signature(getattr(m, name)).parameters for m in (ours, theirs))
        assert [(p.name, p.default) for p in one.values()] == [
            (p.name, p.default) for p in other.values()
        ]
