"""Distance on surfaces, all pairs, regions."""

from __future__ import annotations

import gc
import itertools
import pickle
import resource
import signal
import threading

import numpy as np
import pytest

import littoral
from littoral import Curve, SurfacePoint


def test_curves_in_every_form_are_the_same(square, line):
    expected = 0.5 - square.points[:, 0]
    x = square.points[line]
    for curves in (
        line,
        np.array(line),
        [line],
        [np.array(line, np.uint8)],
        [(v, []) for v in line],
        [[(v, []) for v in line]],
        [SurfacePoint.vertex(v) for v in line],
        Curve(line),
        [Curve(line)],
        x,
        [x],
        x.tolist(),
        x.astype(np.float32),
        np.array(list(itertools.pairwise(line))),
    ):
        values = littoral.distance(square, curves).values
        np.testing.assert_allclose(values, expected, atol=1e-7)
    for unsigned in (
        littoral.distance(square, line, signed=False),
        littoral.distance(square, [line], signed=[False]),
        littoral.distance(square, Curve(line, signed=False)),
        littoral.distance(square, x, signed=False),
    ):
        np.testing.assert_allclose(unsigned.values, np.abs(expected), atol=1e-12)


def test_no_curves_are_none(square):
    expected = littoral.distance(square, points=7).values
    for curves in ([], (), None):
        field = littoral.distance(square, curves=curves, points=7, signed=[])
        np.testing.assert_array_equal(field.values, expected)
    np.testing.assert_array_equal(littoral.distance(square, points=(7,)).values, expected)


def test_distance_is_counted_from_values(square):
    def to(v):
        return np.linalg.norm(square.points - square.points[v], axis=1)

    expected = np.minimum(to(0) + 0.25, to(40) - 0.1)
    field = littoral.distance(square, points=[0, 40], values=[0.25, -0.1])
    np.testing.assert_allclose(field.values, expected, atol=1e-12)
    again = pickle.loads(pickle.dumps(field))
    np.testing.assert_array_equal(again.values, field.values)
    line = [4, 13, 22, 31, 40, 49, 58, 67, 76]
    x = square.points[:, 0] - square.points[4, 0]
    for counted in (
        littoral.distance(square, Curve(line, signed=False, value=2)),
        littoral.distance(square, line, signed=False, values=2),
        littoral.distance(square, line, signed=False, values=[2]),
    ):
        np.testing.assert_allclose(counted.values, np.abs(x) + 2, atol=1e-12)
    both = littoral.distance(square, [line], 0, signed=False, values=[2, 1.75])
    np.testing.assert_allclose(both.values, np.minimum(np.abs(x) + 2, to(0) + 1.75), atol=1e-12)
    with pytest.raises(
        littoral.InputError,
        match="values: expected one number or one for each of 1 curve and 1 point, got 1",
    ):
        littoral.distance(square, [line], 0, values=[2])
    with pytest.raises(littoral.UnsupportedError, match="one value"):
        littoral.distance(square, points=[0, 40], values=[0, 0.1], method="quadratic")


def test_points_in_every_form_are_the_same(square):
    a = littoral.distance(square, points=40).values
    for points in ([40], np.array([40]), [(40, [])], (40, []), SurfacePoint.vertex(40)):
        np.testing.assert_array_equal(littoral.distance(square, points=points).values, a)
    np.testing.assert_allclose(
        a, np.linalg.norm(square.points - square.points[40], axis=1), atol=1e-12
    )
    centre = square.points[square.faces[7]].mean(axis=0)
    for points in ((7, [1 / 3] * 3), [SurfacePoint.face(7, 1 / 3, 1 / 3, 1 / 3)]):
        np.testing.assert_allclose(
            littoral.distance(square, points=points).values,
            np.linalg.norm(square.points - centre, axis=1),
            atol=1e-12,
        )
    mixed = [40, (7, [1 / 3] * 3)]
    np.testing.assert_allclose(square.positions(mixed), [square.points[40], centre], atol=1e-12)
    tail, head = square.edges[11]
    np.testing.assert_allclose(
        square.positions([(11, [0.25])])[0],
        0.75 * square.points[tail] + 0.25 * square.points[head],
    )


@pytest.mark.parametrize(
    ("given", "error", "says"),
    [
        ({"points": 81}, IndexError, r"points\[0\] is 81: there are 81 vertices"),
        ({"points": [0, -1]}, IndexError, r"points\[1\] is -1"),
        ({"points": [(500, [0.5])]}, IndexError, "edges"),
        ({"points": [(500, [1, 0, 0])]}, IndexError, "faces"),
        ({"points": [(5, [0.2, 0.8])]}, ValueError, "barycentric"),
        ({"points": [(5, [0.2, 0.2, np.nan])]}, ValueError, "finite"),
        ({"points": 1.5}, TypeError, "points"),
        ({"curves": [[0, 99]]}, IndexError, r"curves\[0\]"),
        ({"curves": [[0, "a"]]}, TypeError, r"curves\[0\]"),
        ({"curves": [[0, 9]], "signed": [True, False]}, ValueError, "2 truth values for 1 curve$"),
        ({"curves": np.zeros((3, 2))}, ValueError, "n x 3"),
        ({}, ValueError, "source"),
        ({"points": 0, "method": "exat"}, ValueError, "did you mean 'exact'"),
        ({"points": 0, "method": "signed-heat", "tim_scale": 1}, ValueError, "'time-scale'"),
        ({"points": 0, "method": "signed-heat", "time_scale": -1}, ValueError, "time-scale"),
        ({"points": 0, "method": "signed-heat", "time_scale": [1]}, TypeError, "time_scale"),
        ({"points": 0, "threads": -1}, ValueError, "threads"),
    ],
)
def test_wrong_calls_say_what_is_wrong(square, given, error, says):
    with pytest.raises(error, match=says):
        littoral.distance(square, **given)


def test_methods_that_do_not_run_there_say_what_does():
    with pytest.raises(littoral.UnsupportedError, match="signed-heat"):
        littoral.distance(littoral.PointCloud(np.eye(3)), points=0, method="exact")


def test_solvers_equal_the_one_call(square, line):
    for method in ("auto", "signed-heat", "unsigned-heat", "exact", "regularized"):
        solver = littoral.DistanceSolver(square, method=method)
        np.testing.assert_array_equal(
            solver.solve(points=3).values, littoral.distance(square, points=3, method=method).values
        )


def test_a_solver_may_be_shared_by_threads(sphere):
    solver = littoral.DistanceSolver(sphere, method="signed-heat")
    alone = [solver.solve(points=v).values for v in range(50)]
    found: dict[int, np.ndarray] = {}

    def solve(start: int) -> None:
        for v in range(start, 50, 2):
            found[v] = solver.solve(points=v).values
            found[v + 100] = solver.solve(points=v).values

    threads = [threading.Thread(target=solve, args=(k,)) for k in (0, 1)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for v in range(50):
        np.testing.assert_array_equal(found[v], alone[v])
        np.testing.assert_array_equal(found[v + 100], alone[v])


def test_distance_matrix_takes_points_of_any_kind(square):
    where = [(7, [1 / 3] * 3), 3, SurfacePoint.edge(2, 0.5)]
    D = littoral.distance_matrix(square, where, where, method="exact")
    x = square.positions(where)
    np.testing.assert_allclose(D, np.linalg.norm(x[:, None] - x[None], axis=2), atol=0.1)
    assert littoral.distance_matrix(square, where).shape == (3, 81)
    assert littoral.distance_matrix(square, []).shape == (0, 81)
    with pytest.raises(littoral.UnsupportedError):
        littoral.distance_matrix(square, [(7, [1 / 3] * 3)], method="symmetric")


def test_float32_stays_float32(square):
    V = square.points.astype(np.float32)
    assert littoral.distance((V, square.faces), points=0).values.dtype == np.float32
    assert littoral.distance_matrix((V, square.faces), [0], [1]).dtype == np.float32
    assert littoral.distance(square, points=0).values.dtype == np.float64


def test_winding_regions_and_isolines(square):
    loop = [20, 24, 60, 56, 20]
    regions = littoral.winding(square, loop)
    inside = square.points[square.faces].mean(axis=1)
    expected = ((inside[:, :2] > 0.25) & (inside[:, :2] < 0.75)).all(axis=1)
    np.testing.assert_array_equal(regions.region, expected.astype(int))
    assert sum(len(line) for line in regions.bounding) > 0
    again = littoral.distance(square, regions.bounding_sources)
    np.testing.assert_allclose(again.values, littoral.distance(square, loop).values, atol=1e-12)
    lines = littoral.distance(square, loop).isolines([0.1, 0.2])
    assert len(lines) == 2
    for line in lines:
        np.testing.assert_array_equal(line[0], line[-1])
    surface, functions = regions.surface
    assert set(functions) == {"winding", "region", "weight"}
    assert all(len(values) == surface.n_vertices for values in functions.values())


def test_everything_pickles(square, line):
    field = littoral.distance(square, line, method="quadratic", subdivide=2)
    regions = littoral.winding(square, [20, 24, 60, 56, 20])
    cloud = littoral.PointCloud(square.points, np.tile([0, 0, 1.0], (81, 1)))
    voxels = littoral.Voxels(np.pad(np.ones((2, 2, 2)), 1), 0.5)
    for thing in (field, regions, cloud, voxels, square, littoral.DistanceSolver(square)):
        copy = pickle.loads(pickle.dumps(thing))
        assert repr(copy) == repr(thing)
    copy = pickle.loads(pickle.dumps(field))
    np.testing.assert_array_equal(copy.values, field.values)
    np.testing.assert_array_equal(copy.refined[1], field.refined[1])
    assert copy.report == field.report
    copied_regions = pickle.loads(pickle.dumps(regions))
    np.testing.assert_array_equal(copied_regions.region, regions.region)
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(voxels)).points, voxels.points)


def test_other_surfaces(square):
    quads = littoral.examples.quads(8)
    assert quads.kind == "polygon mesh"
    for surface in (quads, littoral.PointCloud(square.points, np.tile([0, 0, 1.0], (81, 1)))):
        values = littoral.distance(surface, points=40).values
        exact = np.linalg.norm(square.points - square.points[40], axis=1)
        assert np.abs(values - exact).max() < 0.12
    box = littoral.Voxels(np.pad(np.ones((4, 4, 4), bool), 1), spacing=0.25, origin=(1, 2, 3))
    assert box.kind == "voxel surface"
    assert littoral.distance(box, points=0).values.max() > 1


def test_welded_surfaces_are_connected(sphere):
    soup = littoral.Mesh(
        sphere.points[sphere.faces.ravel()], np.arange(3 * sphere.n_faces).reshape(-1, 3)
    )
    assert soup.n_components == soup.n_faces
    whole = soup.welded()
    assert isinstance(whole, littoral.Mesh)
    assert (whole.n_vertices, whole.n_components) == (sphere.n_vertices, 1)
    assert np.isinf(littoral.distance(soup, points=0).values).any()
    assert np.isfinite(littoral.distance(whole, points=0).values).all()
    assert len(pickle.loads(pickle.dumps(whole)).points) == sphere.n_vertices
    cloud = littoral.PointCloud([[0, 0, 0], [1, 0, 0], [1, 0, 1e-6]])
    assert cloud.welded(1e-3).n_vertices == 2
    for distance in (-1, float("nan")):
        with pytest.raises(littoral.InputError, match="finite and not negative"):
            soup.welded(distance)
    with pytest.raises(littoral.UnsupportedError, match="nothing to weld"):
        littoral.Voxels(np.ones((2, 2, 2))).welded()


def test_progress_is_told_and_can_stop(sphere):
    seen: list[tuple[float, str]] = []
    with littoral.progress(lambda share, stage: seen.append((share, stage))):
        littoral.distance(sphere, points=0, method="signed-heat")
    assert seen[-1] == (1.0, "done")
    assert [share for share, _ in seen] == sorted(share for share, _ in seen)

    class Enough(Exception):
        pass

    def stop(share: float, stage: str) -> None:
        raise Enough

    with pytest.raises(Enough):
        littoral.distance_matrix(sphere, range(600), progress=stop)


@pytest.mark.slow
def test_an_interrupt_stops_a_long_call():
    mesh = littoral.examples.sphere(5)
    timer = threading.Timer(0.5, signal.raise_signal, [signal.SIGINT])
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        littoral.distance_matrix(mesh, np.arange(20_000) % mesh.n_vertices, range(10))
    littoral.distance(mesh, points=0)  # and the next one runs


@pytest.mark.slow
def test_many_calls_do_not_grow(square):
    solver = littoral.DistanceSolver(square, method="signed-heat")
    sdf = littoral.SDF(square)
    X = np.random.default_rng(0).random((20, 3))

    def calls() -> None:
        for _ in range(5000):
            solver.solve(points=3)
            littoral.Mesh(square.points, square.faces)
            sdf.with_gradient(X)
            sdf.closest(X)
            sdf.winding_number(X)
            with pytest.raises(ValueError, match="barycentric"):
                square.positions((0, [7.0]))
        gc.collect()

    calls()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    calls()
    calls()
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 4096  # kB


def test_what_does_not_fit_is_refused(square):
    for bad in ((0, [7.0]), (0, [0.5, 0.6, 0.5]), (0, [-0.1, 0.6, 0.5])):
        with pytest.raises(ValueError, match="barycentric"):
            square.positions(bad)
        with pytest.raises(ValueError, match="barycentric"):
            littoral.distance(square, points=bad)
    six_digits = (0, [0.333333, 0.333333, 0.333333])
    np.testing.assert_allclose(
        littoral.distance(square, points=six_digits).values,
        littoral.distance(square, points=(0, [1 / 3] * 3)).values,
        atol=1e-6,
    )
    with pytest.raises(ValueError, match="curves"):
        littoral.winding(square, None)
    with pytest.raises(ValueError, match="threads"):
        littoral.distance(square, points=0, threads="two")
    with pytest.raises(TypeError, match="Mesh"):
        littoral.Surface()
    with pytest.raises(littoral.UnsupportedError, match=r"^chains of faces"):
        littoral.distance(square, littoral.FaceChain([0, 1]))


def test_errors_and_warnings_have_codes(square):
    for call, code in (
        (lambda: littoral.distance(square, points=10**6), "no-such-element"),
        (lambda: littoral.distance(square, points=0, method="exat"), "unknown-name"),
        (lambda: littoral.read("no-such-file.obj"), "cannot-read"),
    ):
        with pytest.raises(littoral.Error) as raised:
            call()
        assert raised.value.code == code
    points = np.vstack([square.points, [[9, 9, 9]]])
    field = littoral.distance(littoral.Mesh(points, square.faces), points=0)
    (warning,) = field.warnings
    assert warning.code == "isolated-vertices"
    assert "belongs to no face" in warning
    kept = pickle.loads(pickle.dumps(field)).warnings
    assert [(w, w.code) for w in kept] == [(warning, warning.code)]
    assert field.report.as_dict()["warnings"] == [{"code": warning.code, "message": str(warning)}]
