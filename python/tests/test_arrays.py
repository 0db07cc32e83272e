"""Arrays of any kind go in; what is wrong is named."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import littoral
from littoral import _arrays

FUZZER = Path(__file__).parents[2] / "fuzz/arrays.py"

V = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], float)
F = np.array([[0, 1, 2], [1, 3, 2]])


@given(
    dtype=st.sampled_from([np.float16, np.float32, np.float64, np.int8, np.int64, np.uint16]),
    index=st.sampled_from([np.int8, np.int16, np.int32, np.int64, np.uint8, np.uint32, np.uint64]),
    order=st.sampled_from("CF"),
    stride=st.sampled_from([1, 2, -1]),
    writable=st.booleans(),
)
@settings(max_examples=60, deadline=None)
def test_dtypes_orders_and_strides_give_the_same_answer(dtype, index, order, stride, writable):
    points = np.repeat(V, abs(stride), axis=0).astype(dtype, order=order)[::stride]
    faces = np.repeat(F, abs(stride), axis=0).astype(index, order=order)[::stride]
    if stride < 0:
        points, faces = points[::-1].copy()[::1], faces
    points.flags.writeable = writable
    field = littoral.distance((points, faces), points=0)
    expected = littoral.distance((points.astype(float), faces.astype(np.int64)), points=0).values
    np.testing.assert_array_equal(field.values, expected.astype(field.values.dtype))
    assert field.values.dtype == (np.float32 if dtype == np.float32 else np.float64)


def unaligned(array: np.ndarray) -> np.ndarray:
    out = np.empty(array.nbytes + 1, np.uint8)[1:].view(array.dtype).reshape(array.shape)
    out[...] = array
    return out


def test_arrays_that_are_not_aligned_are_copied():
    points, faces = unaligned(V), unaligned(F.astype(np.int32))
    assert not points.flags.aligned
    for out in (_arrays.floats(points, "V", 3, finite=False), _arrays.ints(faces, "F", 3)):
        assert out.flags.aligned and out.flags.c_contiguous
    assert _arrays.floats(V, "V", 3) is V
    volume = littoral.Volume(unaligned(np.arange(8.0).reshape(2, 2, 2)))
    assert volume.values[1, 0, 1] == 5


def test_face_chains_are_integers(square):
    with pytest.raises(TypeError, match="expected integers"):
        littoral.winding(square, littoral.FaceChain([0.5, 1.5]))


def test_cases_of_the_fuzzer():
    spec = importlib.util.spec_from_file_location("arrays", FUZZER)
    arrays = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(arrays)
    outcomes = {arrays.check(arrays.Seeded(seed)) for seed in range(60)}
    assert outcomes == {"same", "answered", "refused"}


def test_lists_and_dlpack_are_taken():
    class OnlyDlpack:
        def __init__(self, array):
            self.array = array

        def __dlpack__(self, **options):
            return self.array.__dlpack__(**options)

        def __dlpack_device__(self):
            return self.array.__dlpack_device__()

    expected = littoral.distance((V, F), points=0).values
    np.testing.assert_array_equal(littoral.distance((V.tolist(), F.tolist()), points=0), expected)
    np.testing.assert_array_equal(
        littoral.distance((OnlyDlpack(V), OnlyDlpack(F)), points=0), expected
    )
    vertex = OnlyDlpack(np.array([0]))
    np.testing.assert_array_equal(littoral.distance((V, F), points=vertex).values, expected)
    curve = OnlyDlpack(np.array([0, 1]))
    assert littoral.distance((V, F), curve).values[2] == pytest.approx(1)


@pytest.mark.parametrize(
    ("points", "faces", "error", "says"),
    [
        (V[:, :2], F, ValueError, "V: expected shape n x 3"),
        (V.astype(complex), F, TypeError, "V: expected real numbers"),
        (np.array([["a"] * 3]), F, TypeError, "V: expected real numbers"),
        (V, F.astype(float), TypeError, "F: expected integers"),
        (V, F[:, :2], ValueError, "F: expected shape faces x 3"),
        (V, F.ravel(), ValueError, "F: expected shape faces x 3"),
        (V, F + 2, IndexError, r"F\[0, 2\] is 4: there are 4 vertices, 0 to 3"),
        (V, F - 1, IndexError, r"F\[0, 0\] is -1"),
        (V, np.array([[0, 1, 2**40]]), IndexError, "1099511627776"),
        (V, np.array([[0, -1, 1, 2]]), ValueError, r"F\[0\]"),
        (np.where(V == 1, np.nan, V), F, ValueError, "1"),
        ([[0, 0, 0], [1, 0]], F, ValueError, "rows of different lengths"),
    ],
)
def test_what_is_wrong_is_named(points, faces, error, says):
    with pytest.raises(error, match=says) as raised:
        littoral.Mesh(points, faces)
    assert isinstance(raised.value, (TypeError, littoral.Error))


def test_mixed_faces_end_in_minus_one():
    mesh = littoral.Mesh(
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0.5, 0]], [[0, 1, 2, 3], [1, 4, 2, -1]]
    )
    assert mesh.kind == "polygon mesh"
    assert [face.tolist() for face in mesh.faces] == [[0, 1, 2, 3], [1, 4, 2]]


def test_points_and_faces_are_views_that_keep_their_mesh():
    mesh = littoral.Mesh(V, F)
    points, faces = mesh.points, mesh.faces
    del mesh
    assert not points.flags.writeable and not faces.flags.writeable
    np.testing.assert_array_equal(points, V)
    np.testing.assert_array_equal(faces, F)


@given(data=st.data())
@settings(max_examples=150, deadline=None)
def test_random_arrays_give_an_answer_or_an_error_of_ours(data):
    n = data.draw(st.integers(0, 12))
    numbers = st.one_of(
        st.floats(-2, 2), st.sampled_from([0.0, 1e-300, 1e300, np.inf, -np.inf, np.nan])
    )
    points = np.array(
        data.draw(st.lists(st.tuples(numbers, numbers, numbers), min_size=n, max_size=n)), float
    ).reshape(-1, 3)
    faces = np.array(
        data.draw(
            st.lists(
                st.tuples(*[st.integers(-1, max(n, 1))] * data.draw(st.integers(3, 5))), max_size=12
            )
        )
        or np.empty((0, 3)),
        np.int64,
    )
    source = data.draw(st.integers(-1, n))
    method = data.draw(
        st.sampled_from(["auto", "exact", "signed-heat", "unsigned-heat", "fast-marching"])
    )
    try:
        field = littoral.distance((points, faces), points=source, method=method)
    except littoral.Error:
        return
    assert field.values.shape == (n,)
    assert not np.isnan(field.values).any()
    if n and np.isfinite(points[source]).all():
        assert field.values.min() >= -1e-9 * max(1, np.abs(points[np.isfinite(points)]).max())
    try:
        sdf = littoral.SDF(points, faces)
    except littoral.Error:
        return
    values = sdf(np.zeros((2, 3)))
    assert np.isfinite(values).all()


def test_what_is_masked_is_no_number():
    points = np.ma.array(V, mask=False)
    np.testing.assert_array_equal(littoral.Mesh(points, F).points, V)  # nothing is
    points[2, 1] = np.ma.masked
    with pytest.raises(littoral.InputError, match=r"V\[2, 1\] is masked"):
        littoral.Mesh(points, F)
    with pytest.raises(littoral.InputError, match=r"points\[1\] is masked"):
        littoral.distance((V, F), points=np.ma.array([0, 3], mask=[False, True]))
    with pytest.raises(littoral.InputError, match=r"values\[0, 0, 1\] is masked"):
        littoral.Volume(np.ma.array(np.zeros((2, 2, 2)), mask=np.arange(8).reshape(2, 2, 2) == 1))


@pytest.mark.filterwarnings("ignore::PendingDeprecationWarning")
def test_matrices_are_arrays():
    padded = np.matrix(np.column_stack([F, [-1, -1]]))
    mesh = littoral.Mesh(np.matrix(V), padded)
    np.testing.assert_array_equal(mesh.faces, F)


@pytest.mark.parametrize("element", [2**31, 2**63, 2**70, -(2**70)])
def test_elements_beyond_any_integer_are_named(element):
    mesh = littoral.Mesh(V, F)
    for points in (
        [(element, [])],
        [littoral.SurfacePoint.vertex(element)],
        [0, littoral.SurfacePoint.edge(element, 0.5)],
        [littoral.SurfacePoint.face(element, 1, 0, 0)],
    ):
        with pytest.raises(littoral.IndexOutOfRange, match=f"is {element}: there are"):
            littoral.distance(mesh, points=points)


def test_surface_points_lie_on_something():
    for on, b in ((3, (1.0, 0.0, 0.0)), (0, (1.0, 0.0))):
        with pytest.raises(littoral.InputError, match="make one by vertex, edge, face"):
            littoral.SurfacePoint(on, 0, b)


@pytest.mark.parametrize("resolution", [float("nan"), float("inf"), 2**31, 2.5, "64", [8]])
def test_resolutions_are_whole_numbers(resolution):
    sdf = littoral.SDF(littoral.examples.cube())
    with pytest.raises(littoral.InputError, match="resolution: expected a whole number of nodes"):
        sdf.sample(resolution)
    assert sdf.sample(8.0).shape == (8, 8, 8)


@pytest.mark.parametrize(
    "numbers",
    [{"resolution": 8.5}, {"surface": float("inf")}, {"space": 2**40}, {"seed": 1.5}, {"seed": -1}],
)
def test_samples_are_counted_in_whole_numbers(numbers):
    name = next(iter(numbers))
    with pytest.raises(littoral.InputError, match=f"{name}: expected a whole number"):
        littoral.samples(littoral.examples.cube(), **numbers)


@pytest.mark.parametrize(
    ("grid", "says"),
    [
        ({"resolution": -1}, "resolution must be at least 2"),
        ({"resolution": 8.5}, "resolution: expected a whole number"),
        ({"spacing": float("nan")}, "spacing must be positive and finite"),
        ({"spacing": -1}, "spacing must be positive and finite"),
        ({"resolution": 8, "spacing": 0.1}, "give one"),
    ],
)
def test_repair_checks_its_grid_also_where_it_needs_none(grid, says):
    cube = littoral.examples.cube()
    assert littoral.repair(cube, resolution=8.0).surface.n_faces == cube.n_faces
    with pytest.raises(littoral.InputError, match=says):
        littoral.repair(cube, **grid)


@pytest.mark.parametrize("spacing", [0, -1, [1, 1, -1], [1, 0, 1]])
def test_spacings_are_positive(spacing):
    for make in (littoral.Volume, littoral.Voxels):
        with pytest.raises(littoral.InputError, match="spacing: expected positive lengths"):
            make(np.ones((2, 2, 2)), spacing=spacing)


def test_grids_have_values():
    with pytest.raises(littoral.InputError, match="values: there are none"):
        littoral.Volume(np.zeros((2, 0, 2)))
    inside = np.ones((2, 2, 2))
    inside[1, 0, 1] = np.nan
    with pytest.raises(littoral.InputError, match=r"inside\[1, 0, 1\] is nan"):
        littoral.Voxels(inside)


def test_too_many_threads_are_a_value_error():
    with pytest.raises(ValueError, match="threads: expected"):
        littoral.set_threads(2**40)


def test_files_of_options_keep_their_names(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("along_x").write_text("f 0 1 0 0\n")
    mesh = littoral.Mesh(V, F)
    how = {"method": "regularized", "regularizer": "align", "points": 0}
    fields = [littoral.distance(mesh, field=f, **how) for f in ("along_x", Path("along_x"))]
    np.testing.assert_array_equal(fields[0].values, fields[1].values)
    assert fields[0].report.options["field"] == "along_x"
    with pytest.raises(littoral.IoError, match="along_y"):
        littoral.distance(mesh, field="along_y", **how)
