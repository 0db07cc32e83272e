"""Signed distance, volumes, offsets, tori; tets."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import littoral


@pytest.fixture(scope="module")
def cube() -> littoral.Mesh:
    return littoral.examples.cube()


def box_distance(x: np.ndarray) -> np.ndarray:
    """To the unit cube, negative inside."""
    q = np.abs(x - 0.5) - 0.5
    return np.linalg.norm(np.maximum(q, 0), axis=1) + np.minimum(q.max(axis=1), 0)


def test_a_cube_is_exact(cube):
    rng = np.random.default_rng(1)
    x = rng.uniform(-0.5, 1.5, (500, 3))
    for sdf in (
        littoral.SDF(cube),
        littoral.SDF(cube.points, cube.faces),
        littoral.SDF((cube.points, cube.faces), method="closest-point"),
        littoral.SDF(cube, method="winding", flip=False),
    ):
        np.testing.assert_allclose(sdf(x), box_distance(x), atol=1e-12)
        closest = sdf.closest(x)
        np.testing.assert_allclose(closest.distance, np.abs(box_distance(x)), atol=1e-12)
        corners = cube.points[closest.corners]
        np.testing.assert_allclose(
            (corners * closest.barycentric[:, :, None]).sum(axis=1), closest.point, atol=1e-12
        )
        np.testing.assert_array_equal(closest.corners, cube.faces[closest.face])
        np.testing.assert_allclose(
            sdf.winding_number(x), (box_distance(x) < 0).astype(float), atol=1e-6
        )
        assert sdf.confidence(x).min() > 1 - 1e-5
    step = 1e-6
    sdf = littoral.SDF(cube)
    gradient = sdf.gradient(x)
    numeric = np.stack(
        [(sdf(x + step * e) - sdf(x - step * e)) / (2 * step) for e in np.eye(3)], axis=1
    )
    smooth = np.abs(np.linalg.norm(numeric, axis=1) - 1) < 1e-6
    assert smooth.mean() > 0.9
    np.testing.assert_allclose(gradient[smooth], numeric[smooth], atol=1e-6)


def test_shapes_of_queries_and_results(cube):
    sdf = littoral.SDF(cube)
    assert sdf([0.5, 0.5, 0.5]).shape == ()
    assert sdf(np.zeros((0, 3))).shape == (0,)
    assert sdf(np.zeros((2, 3), np.float32)).dtype == np.float32
    assert sdf.closest([2, 0.5, 0.5]).point.tolist() == [1, 0.5, 0.5]
    with pytest.raises(ValueError, match="n x 3"):
        sdf(np.zeros((2, 2)))
    with pytest.raises(ValueError, match="query point 1 "):
        sdf([[0, 0, 0], [np.nan, 0, 0]])
    with pytest.raises(TypeError):
        sdf("inside")


def test_confidence_is_low_at_a_hole(cube):
    open_box = littoral.Mesh(cube.points, cube.faces[2:])
    sdf = littoral.SDF(open_box)
    assert sdf.confidence([0.5, 0.5, 1e-9]) < sdf.confidence([0.5, 0.5, 0.9])
    assert sdf.confidence([5, 5, 5]) > 0.95


def test_closest_on_polygons_and_clouds():
    quads = littoral.examples.quads(2)
    found = littoral.SDF(quads, method="winding").closest([[0.9, 0.1, 1]])
    assert found.face.tolist() == [1]
    np.testing.assert_allclose(found.point, [[0.9, 0.1, 0]], atol=1e-12)
    P = np.eye(3)
    cloud = littoral.SDF(P, P, method="closest-point")
    assert cloud.closest([[0, 2, 0]]).face.tolist() == [1]


def test_sampling_isosurfaces_and_offsets(cube):
    sdf = littoral.SDF(cube)
    volume = sdf.sample(24)
    np.testing.assert_allclose(
        volume.values.ravel(), box_distance(volume.nodes().reshape(-1, 3)), atol=1e-12
    )
    shell = volume.isosurface(0.1)
    assert np.abs(box_distance(shell.points) - 0.1).max() < 0.02
    inner, outer = littoral.offset(cube, [-0.1, 0.2], resolution=32)
    # Vertices are exact but for those that lie so near to a node that several become one.
    near_nodes = 0.05 * 3**0.5 * 3 / 31
    assert np.abs(box_distance(inner.points) + 0.1).max() < near_nodes
    assert np.abs(box_distance(outer.points) - 0.2).max() < near_nodes
    assert np.median(np.abs(box_distance(outer.points) - 0.2)) < 1e-4
    (coarse,) = littoral.offset(littoral.SDF(cube, method="signed-heat"), 0.2, resolution=32)
    assert np.abs(box_distance(coarse.points) - 0.2).max() < 0.06
    with pytest.raises(littoral.InputError):
        volume.isosurface(100)
    other = littoral.Volume(volume.values, volume.spacing, volume.origin)
    np.testing.assert_array_equal(other.values, volume.values)
    np.testing.assert_array_equal(sdf.sample(grid=other).values, volume.values)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(volume)).values, volume.values)


def test_rounding_does_not_choose_diagonals():
    """Contours of planes are rectangles; last bits, which differ between machines, are noise."""
    axis = np.arange(6.0)
    values = (axis[:, None, None] * 0 + axis[:, None] + 0.37 * axis - 2.6) / 3
    surface = littoral.Volume(values).isosurface()
    rng = np.random.default_rng(0)
    for _ in range(5):
        moved = values * (1 + 2.0**-52 * rng.integers(-2, 3, values.shape))
        again = littoral.Volume(moved).isosurface()
        np.testing.assert_allclose(again.points, surface.points, atol=1e-13)
        np.testing.assert_array_equal(again.faces, surface.faces)


def test_signed_heat_on_grids(cube):
    volume = littoral.signed_heat_grid(cube, resolution=24)
    exact = box_distance(volume.nodes().reshape(-1, 3))
    assert np.abs(volume.values.ravel() - exact).mean() < 0.05
    with pytest.raises(littoral.UnsupportedError, match="grid"):
        littoral.SDF(cube, method="signed-heat")([0, 0, 0])


def test_combinations(cube):
    other = littoral.Mesh(cube.points + np.array([0.5, 0, 0]), cube.faces)
    a, b = littoral.SDF(cube), littoral.SDF(other)
    x = np.array([[0.25, 0.5, 0.5], [0.75, 0.5, 0.5], [1.25, 0.5, 0.5], [3, 0.5, 0.5]])
    assert ((a | b)(x) < 0).tolist() == [True, True, True, False]
    assert ((a & b)(x) < 0).tolist() == [False, True, False, False]
    assert ((a - b)(x) < 0).tolist() == [True, False, False, False]
    joined = pickle.loads(pickle.dumps(littoral.unite(a, b, blend=0.1)))
    np.testing.assert_array_equal(joined(x), littoral.unite(a, b, blend=0.1)(x))
    with pytest.raises(littoral.UnsupportedError, match="combination"):
        (a | b).closest(x)
    with pytest.raises(TypeError):
        a | 3


def test_clouds_become_tori(sphere):
    sdf = littoral.SDF(sphere.points, sphere.points)
    assert sdf.report.method == "auto"
    x = np.array([[0, 0, 0.5], [0, 0, 1.5]])
    np.testing.assert_allclose(sdf(x), [-0.5, 0.5], atol=0.02)
    tori = littoral.fit_tori(sphere.points, sphere.points)
    by_tori = littoral.SDF(sphere.points, sphere.points, method="tori")
    np.testing.assert_allclose(littoral.SDF(tori)(x), by_tori(x), atol=1e-6)
    with pytest.raises(ValueError, match="estimate-normals"):
        littoral.SDF(sphere.points)
    assert littoral.SDF(sphere.points, estimate_normals=True)(x)[1] > 0


def test_volumes_as_shapes(cube):
    volume = littoral.SDF(cube).sample(24)
    again = littoral.sdf_of_volume(volume)
    assert abs(float(again([0.5, 0.5, 0.5])) + 0.5) < 0.05


def grid_tets(side: int):
    V = np.stack(np.meshgrid(*[np.arange(side) / (side - 1)] * 3, indexing="ij"), -1).reshape(-1, 3)
    corner = np.arange(side**3).reshape(side, side, side)[:-1, :-1, :-1].ravel()
    steps = [(1, side, side**2), (1, side**2, side), (side, 1, side**2)]
    steps += [(side, side**2, 1), (side**2, 1, side), (side**2, side, 1)]
    T = np.concatenate(
        [np.stack([corner, corner + a, corner + a + b, corner + a + b + c], 1) for a, b, c in steps]
    )
    return V, T


def test_tets():
    V, T = grid_tets(5)
    mesh = littoral.TetMesh(V, T)
    field = littoral.tet_distance(mesh, vertices=[0])
    exact = np.linalg.norm(V, axis=1)
    assert np.abs(field.values - exact).max() < 0.35
    precise = littoral.tet_distance(mesh, vertices=0, method="quadratic")
    np.testing.assert_allclose(precise.values, exact, atol=1e-3)
    copy = pickle.loads(pickle.dumps(field))
    np.testing.assert_array_equal(copy.values, field.values)
    with pytest.raises(IndexError, match="vertices"):
        littoral.tet_distance(mesh, vertices=[999])
    with pytest.raises(ValueError, match="n x 4"):
        littoral.TetMesh(V, T[:, :3])


def test_calls_on_surfaces_take_tets(cube):
    """`distance`, `DistanceSolver` and `distance_matrix` measure through tets as `tet_distance`."""
    V = np.array([[-1.0, -1, -1], [4, -1, -1], [-1, 4, -1], [-1, -1, 4], [4, 4, 4]])
    tets = littoral.TetMesh(V, [[0, 1, 2, 3], [1, 2, 3, 4]])
    from_first = littoral.tet_distance(tets, vertices=0, method="quadratic").values
    np.testing.assert_allclose(from_first[1:4], 5, atol=1e-3)
    for given in ({"points": 0}, {"vertices": [0]}):
        field = littoral.distance(tets, method="quadratic", **given)
        assert isinstance(field, littoral.TetField)
        np.testing.assert_array_equal(field.values, from_first)
    np.testing.assert_array_equal(
        littoral.distance(tets, cube).values, littoral.tet_distance(tets, cube).values
    )
    np.testing.assert_array_equal(
        littoral.distance(tets, boundary=True).values,
        littoral.tet_distance(tets, boundary=True).values,
    )
    solver = littoral.DistanceSolver(tets, "quadratic")
    assert isinstance(solver, littoral.TetDistanceSolver)
    np.testing.assert_array_equal(solver.solve(points=0).values, from_first)
    matrix = littoral.distance_matrix(tets, [0, 1], [1, 2, 3], method="quadratic")
    np.testing.assert_allclose(matrix, [[5, 5, 5], [0, 50**0.5, 50**0.5]], atol=1e-3)
    assert littoral.distance_matrix(tets, 0, method="quadratic").shape == (1, 5)

    with pytest.raises(littoral.UnsupportedError, match="signed: distance through tets"):
        littoral.distance(tets, points=0, signed=True)
    with pytest.raises(ValueError, match="from a surface, from vertices"):
        littoral.distance(tets, [0, 1])
    with pytest.raises(TypeError, match="give one of them"):
        littoral.distance(tets, points=0, vertices=0)
    with pytest.raises(TypeError, match="given twice"):
        littoral.distance(tets, cube, surface=cube)
    with pytest.raises(TypeError, match="give one of them"):
        solver.solve(points=0, vertices=0)
    with pytest.raises(TypeError, match="sources: expected vertices of the tets"):
        littoral.distance_matrix(tets, [(0, [0.5])])
    for call, more in (
        (littoral.isolines, [np.zeros(5)]),
        (littoral.offset_curves, [[0], 1]),
        (littoral.winding, [[0, 1, 2]]),
        (littoral.SDF, []),
    ):
        with pytest.raises(TypeError, match="a TetMesh is no surface"):
            call(tets, *more)


def test_tet_sources_have_values() -> None:
    grid, T = grid_tets(5)
    mesh = littoral.TetMesh(grid, T)
    corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
    planes = [np.column_stack([np.full(4, x), corners]) for x in (0.25, 0.75)]
    slab = littoral.Mesh(np.vstack(planes), [[0, 1, 2, 3], [4, 5, 6, 7]])
    expected = np.interp(grid[:, 0], [0, 0.25, 0.75, 1], [-0.25, 0, 0.8, 1.05])
    field = littoral.tet_distance(mesh, slab, values=[0, 0.8], method="signed-heat")
    np.testing.assert_allclose(field, expected, atol=4e-3)
    both = littoral.tet_distance(mesh, vertices=0, boundary=True, values=[-1, 0.5])
    inward = np.minimum(grid, 1 - grid).min(axis=1)
    least = np.minimum(np.linalg.norm(grid, axis=1) - 1, inward + 0.5)
    np.testing.assert_allclose(both, least, atol=1e-12)
    shifted = littoral.tet_distance(mesh, vertices=0, values=2.5, method="quadratic")
    assert shifted.values.min() == pytest.approx(2.5, abs=1e-3)
    same = littoral.distance(mesh, points=0, values=2.5, method="quadratic")
    np.testing.assert_array_equal(same.values, shifted.values)
    with pytest.raises(littoral.InputError, match="3 values for 2 sources"):
        littoral.tet_distance(mesh, slab, values=[1, 2, 3])


def test_sources_in_space_have_values(cube: littoral.Mesh) -> None:
    x = np.random.default_rng(4).uniform(-2, 2, (50, 3))
    centres, radii = np.random.default_rng(5).uniform(-1, 1, (9, 3)), np.linspace(0.1, 0.3, 9)
    balls = littoral.SDF(centres, values=-radii)
    exact = (np.linalg.norm(x[:, None] - centres, axis=2) - radii).min(axis=1)
    np.testing.assert_allclose(balls(x), exact, atol=1e-12)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(balls))(x), balls(x))
    assert balls.bounds[0].max() <= (centres - 0.29).min(axis=0).max()
    np.testing.assert_array_equal(littoral.SDF(cube, values=0.5)(x), littoral.SDF(cube)(x) + 0.5)
    two = littoral.Mesh(
        np.vstack([cube.points, cube.points + [3, 0, 0]]),
        np.vstack([np.reshape(cube.corners, (-1, 3)), np.reshape(cube.corners, (-1, 3)) + 8]),
    )
    n = len(cube.corners) // 3
    sdf = littoral.SDF(two, values=np.repeat([0.25, -0.5], n))
    at = [[-1, 0.5, 0.5], [2.5, 0.5, 0.5], [0.5, 0.5, 0.5], [3.5, 0.5, 0.5]]
    np.testing.assert_allclose(sdf(at), [1.25, 0, -0.25, -1])
    for values in ([0.1, 0.2], np.full(2 * n, np.nan)):
        with pytest.raises(littoral.InputError):
            littoral.SDF(two, values=values)
    with pytest.raises(littoral.UnsupportedError, match="auto, winding"):
        littoral.SDF(two, values=np.repeat([0.25, -0.5], n), method="hopf-cole")


def test_many_queries_are_answered_block_by_block(cube):
    sdf = littoral.SDF(cube)
    x = np.random.default_rng(2).uniform(-1, 2, (300_000, 3))
    values = sdf(x)
    for i in (0, 262_143, 262_144, 299_999):
        assert values[i] == sdf(x[i])
    assert sdf.closest(x).face[-1] == sdf.closest(x[-1]).face
    x[270_000, 1] = np.inf
    with pytest.raises(ValueError, match="query point 270000 "):
        sdf(x)


def test_resolutions_are_whole_numbers(cube):
    with pytest.raises(ValueError, match="resolution"):
        littoral.SDF(cube).sample(8.5)


def test_tets_take_the_other_side(cube):
    V = [[-1, -1, -1], [4, -1, -1], [-1, 4, -1], [-1, -1, 4]]
    tets = littoral.TetMesh(V, [[0, 1, 2, 3]])
    one = littoral.tet_distance(tets, cube).values
    other = littoral.tet_distance(tets, cube, flip=True).values
    np.testing.assert_allclose(one, -other, atol=1e-9)


def test_repair(cube: littoral.Mesh) -> None:
    """An open cube becomes a closed one of the same volume; a sheet, a wall."""
    broken = littoral.Mesh(cube.points, cube.faces[:-1])
    found = littoral.repair(broken, resolution=24)
    assert found.report.status == "converged" and not found.warnings
    assert found.report.sizes["input: boundary edges"] == 3
    for name in ("boundary edges", "nonmanifold edges", "self intersecting triangles"):
        assert found.report.sizes["result: " + name] == 0
    a, b, c = (found.surface.points[found.surface.faces[:, k]] for k in range(3))
    assert np.sum(a * np.cross(b, c)) / 6 == pytest.approx(1, abs=0.02)
    square = littoral.examples.square(2)
    wall = littoral.repair(square, resolution=24)
    assert "walls" in wall.warnings[-1] and wall.report.sizes["result: boundary edges"] == 0
    assert littoral.repair(square, resolution=48, thicken=0.1).report.sizes["parts"] == 1
    with pytest.raises(littoral.UnsupportedError, match="thicken"):
        littoral.repair(cube.points, cube.points - 0.5, thicken=0.1)
    with pytest.raises(littoral.InputError, match="error"):
        littoral.repair(cube, error=float("nan"))
