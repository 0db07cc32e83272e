"""littoral.compat.pygeodesic: known answers, and side by side with pygeodesic where it is."""

from __future__ import annotations

import inspect

import numpy as np
import pytest

import littoral
import littoral.compat.pygeodesic.geodesic as geodesic
from littoral.compat import pygeodesic

pytestmark = pytest.mark.filterwarnings("ignore::RuntimeWarning")


@pytest.fixture(scope="module")
def real():
    return pytest.importorskip("pygeodesic.geodesic")


def length(path: np.ndarray) -> float:
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


def holes(F: np.ndarray) -> np.ndarray:
    return np.delete(F, np.arange(0, len(F), 10), axis=0)


# ------------------------------------------------------------------ without the real package


def test_names():
    assert pygeodesic.geodesic is geodesic


def test_a_square_is_flat(square):
    algorithm = geodesic.PyGeodesicAlgorithmExact(square.points, square.faces)
    for source, target in ((0, 80), (8, 72), (3, 70), (0, 8), (40, 40)):
        d, path = algorithm.geodesicDistance(source, target)
        a, b = square.points[[source, target]]
        assert isinstance(d, float) and d == pytest.approx(np.linalg.norm(a - b), abs=1e-12)
        assert length(path) == pytest.approx(d, abs=1e-12)
        np.testing.assert_array_equal(path[[0, -1]], [b, a])
        along = np.linalg.norm(path - b, axis=1)  # a straight line
        np.testing.assert_allclose(path, b + np.outer(along, a - b) / max(d, 1e-30), atol=1e-12)
    d, path = algorithm.geodesicDistance(0, 80)
    assert len(path) == 9  # all vertices on the diagonal


def test_around_a_corner_of_the_boundary(square):
    """A slit: the way between its sides goes by its end."""
    keep = [
        f
        for f, (a, b, c) in enumerate(square.points[np.asarray(square.faces)].mean(axis=1))
        if not (3 / 8 < a < 5 / 8 and b > 1 / 4)
    ]
    F = np.asarray(square.faces)[keep]
    algorithm = geodesic.PyGeodesicAlgorithmExact(square.points, F)
    source, target = 2 + 9 * 8, 6 + 9 * 8
    d, path = algorithm.geodesicDistance(source, target)
    corners = np.array([[1 / 4, 1], [3 / 8, 1 / 4], [5 / 8, 1 / 4], [3 / 4, 1]])
    assert d == pytest.approx(np.linalg.norm(np.diff(corners, axis=0), axis=1).sum(), abs=1e-12)
    assert length(path) == pytest.approx(d, abs=1e-12)


@pytest.mark.parametrize("broken", [False, True])
def test_paths_have_the_length_of_the_distance(spot, broken):
    V, F = spot
    algorithm = geodesic.PyGeodesicAlgorithmExact(V, holes(F) if broken else F)
    for target in range(0, len(V), 60):
        d, path = algorithm.geodesicDistance(1000, target)
        assert length(path) == pytest.approx(d, rel=1e-8)
        assert path.dtype == np.float64 and path.shape[1] == 3


def test_paths_where_three_and_more_faces_meet():
    rng = np.random.default_rng(1)
    V = rng.random((60, 3))
    F = rng.permuted(np.tile(np.arange(60), (120, 1)), axis=1)[:, :3]
    algorithm = geodesic.PyGeodesicAlgorithmExact(V, F)
    for target in range(60):
        d, path = algorithm.geodesicDistance(3, target)
        assert length(path) == pytest.approx(d, abs=1e-9)


def test_paths_through_a_single_vertex():
    """pygeodesic does not pass there."""
    V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]], float)
    algorithm = geodesic.PyGeodesicAlgorithmExact(V, [[0, 1, 2], [0, 3, 4]])
    d, path = algorithm.geodesicDistance(1, 3)
    assert d == 2 and path.tolist() == [[-1, 0, 0], [0, 0, 0], [1, 0, 0]]


def test_several_sources_and_targets(square):
    algorithm = geodesic.PyGeodesicAlgorithmExact(square.points, square.faces)
    d, best = algorithm.geodesicDistances([0, 80], [8, 0, 79, 79])
    np.testing.assert_allclose(d, [1, 0, 1 / 8, 1 / 8], atol=1e-12)
    assert best.tolist() == [0, 0, 1, 1] and (d.dtype, best.dtype) == (np.float64, np.int32)
    d, best = algorithm.geodesicDistances()
    np.testing.assert_allclose(d, np.linalg.norm(square.points, axis=1), atol=1e-12)
    assert (best == 0).all()
    d, best = algorithm.geodesicDistances(max_distance=0.5)
    assert (np.isinf(d) == (np.linalg.norm(square.points, axis=1) > 0.5)).all()
    assert (best == np.where(np.isinf(d), -1, 0)).all()


def test_what_is_not_reached(square):
    V = np.concatenate([square.points, square.points + 5])
    F = np.concatenate([square.faces, np.asarray(square.faces) + 81])
    algorithm = geodesic.PyGeodesicAlgorithmExact(V, F)
    d, path = algorithm.geodesicDistance(0, 100)
    assert np.isinf(d) and path.shape == (0, 3)
    d, best = algorithm.geodesicDistances([0], [100])
    assert np.isinf(d[0]) and best[0] == -1


def test_wrong_arguments(square, tmp_path):
    algorithm = geodesic.PyGeodesicAlgorithmExact(square.points, square.faces)
    for call, error in (
        (lambda: geodesic.PyGeodesicAlgorithmExact(square.points, [[0, 1]]), ValueError),
        (lambda: geodesic.PyGeodesicAlgorithmExact(square.points, [[0, 1, 81]]), IndexError),
        (lambda: algorithm.geodesicDistance(0, 81), IndexError),
        (lambda: algorithm.geodesicDistance(-1, 0), IndexError),
        (lambda: algorithm.geodesicDistance(0.5, 0), TypeError),
        (lambda: algorithm.geodesicDistances([81]), IndexError),
        (lambda: algorithm.geodesicDistances([[0, 1]]), ValueError),
        (lambda: algorithm.geodesicDistances([]), ValueError),
        (lambda: algorithm.geodesicDistances([0], max_distance=np.nan), ValueError),
        (lambda: geodesic.read_mesh_from_file(tmp_path / "none.txt"), OSError),
    ):
        with pytest.raises(error):
            call()


def test_files(tmp_path):
    file = tmp_path / "mesh.txt"
    file.write_text("3 1\n0 0 0\n1\t0 0\n0 1 0.5\n0 1 2\n")
    points, faces = geodesic.read_mesh_from_file(file)
    assert points.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0.5]] and faces.tolist() == [[0, 1, 2]]
    assert (points.dtype, faces.dtype) == (np.float64, np.int64)
    file.write_text("3 2\n0 0 0\n1 0 0\n0 1 0\n0 1 2\n")
    with pytest.raises(ValueError, match="2 triangles"):
        geodesic.read_mesh_from_file(file)


# ------------------------------------------------------------------ side by side


@pytest.mark.parametrize("shape", ["spot", "broken", "ball", "square"])
def test_side_by_side(real, shapes, shape):
    V, F = shapes[shape]
    theirs = real.PyGeodesicAlgorithmExact(V, F)
    ours = geodesic.PyGeodesicAlgorithmExact(V, F)
    worst, apart, compared = 0.0, 0.0, 0
    for source in (0, len(V) // 2):
        for target in range(1, len(V), len(V) // 20):
            d, path = theirs.geodesicDistance(source, target)
            e, line = ours.geodesicDistance(source, target)
            assert (type(e), line.dtype, line.ndim) == (type(d), path.dtype, path.ndim)
            worst = max(worst, abs(d - e), abs(length(line) - d))
            if line.shape == path.shape:
                compared += 1
                apart = max(apart, np.median(abs(line - path)))
    print(f"{shape}: distances {worst:.2g}, {compared} paths {apart:.2g}")
    assert worst < 1e-8
    if shape in ("spot", "broken"):  # elsewhere many paths are as short
        assert compared > 30 and apart < 1e-8
    sources = np.array([0, len(V) // 3, len(V) // 2])
    for targets in (None, np.arange(0, len(V), 3)):
        a, b = (x.geodesicDistances(sources, targets) for x in (theirs, ours))
        np.testing.assert_allclose(b[0], a[0], atol=1e-8)
        assert (a[0].dtype, a[1].dtype, a[1].shape) == (b[0].dtype, b[1].dtype, b[1].shape)
        assert (a[1] == b[1]).mean() > 0.95  # all but ties
    np.testing.assert_allclose(
        ours.geodesicDistances()[0], theirs.geodesicDistances()[0], atol=1e-8
    )


def test_the_names_are_the_same(real):
    public = {n for n in dir(real) if not n.startswith("_") and callable(getattr(real, n))}
    assert public <= set(geodesic.__all__)
    theirs = {n for n in dir(real.PyGeodesicAlgorithmExact) if not n.startswith("_")}
    assert theirs <= set(dir(geodesic.PyGeodesicAlgorithmExact))
    for name, wanted in (
        ("geodesicDistance", ["self", "sourceIndex", "targetIndex"]),
        ("geodesicDistances", ["self", "source_indices", "target_indices", "max_distance"]),
    ):
        ours = inspect.signature(getattr(geodesic.PyGeodesicAlgorithmExact, name))
        assert list(ours.parameters) == wanted


def test_unsupported_is_an_error_of_littoral():
    assert issubclass(littoral.UnsupportedError, NotImplementedError)
