"""Files: their names, and names in them, need not be UTF-8; what is read can be copied."""

from __future__ import annotations

import copy
import os
import pickle

import numpy as np
import pytest

import littoral

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


@pytest.fixture
def latin(tmp_path) -> bytes:
    """The name of a file as older systems wrote it."""
    return os.fsencode(tmp_path) + b"/caf\xe9.obj"


def test_files_may_have_any_name(latin):
    with open(latin, "w") as file:
        file.write(TRIANGLE)
    for name in (latin, os.fsdecode(latin)):
        assert littoral.read(name).n_vertices == 3
    other = latin.replace(b".obj", b".ply")
    littoral.read(latin).save(os.fsdecode(other))
    assert littoral.read(other).n_faces == 1
    sources = latin.replace(b".obj", b".txt")
    with open(sources, "w") as file:
        file.write("unsigned_point\nv 1\n")
    field = littoral.distance(
        littoral.read(latin), littoral.read_sources(sources, littoral.read(latin))
    )
    assert field.values.tolist() == [1, 0, pytest.approx(2**0.5)]


def test_errors_name_such_files(latin):
    with pytest.raises(littoral.IoError, match=r"caf\\xe9\.obj"):
        littoral.read(latin)
    with open(latin, "w") as file:
        file.write("v 0 0\n")
    with pytest.raises(littoral.InputError, match=r"caf\\xe9\.obj:1: expected a coordinate"):
        littoral.read(os.fsdecode(latin))


def test_errors_name_such_fields(tmp_path):
    head = (
        b"# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n"
        b"ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 8\n"
    )
    field = b"SCALARS %s float 1\nLOOKUP_TABLE default\n0 0 0 0 1 1 1 1\n"
    (tmp_path / "a.vtk").write_bytes(head + field % b"a" + field % b"t\xe9")
    with pytest.raises(littoral.InputError, match=r"fields a, t\\xe9"):
        littoral.read_volume(tmp_path / "a.vtk")


def test_such_fields_are_copied(tmp_path):
    (tmp_path / "a.ply").write_bytes(
        b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        b"property float z\nproperty float t\xe9\nelement face 1\n"
        b"property list uchar int vertex_indices\nend_header\n0 0 0 1\n1 0 0 2\n0 1 0 3\n3 0 1 2\n"
    )
    mesh = littoral.read(tmp_path / "a.ply")
    for copied in (pickle.loads(pickle.dumps(mesh)), copy.deepcopy(mesh)):
        np.testing.assert_array_equal(copied.points, mesh.points)
        copied.save(tmp_path / "b.vtp")
        assert b"t\xe9" in (tmp_path / "b.vtp").read_bytes()


def test_voxels_from_a_file_stay_voxels(tmp_path):
    inside = np.zeros((9, 9, 9), np.uint8)
    x, y, z = np.indices(inside.shape) - 4
    inside[x * x + y * y + z * z <= 10] = 1
    head = b"X: 9\nY: 9\nZ: 9\nVersion: 2\n.\n"
    (tmp_path / "ball.vol").write_bytes(head + inside.tobytes())
    read = littoral.read(tmp_path / "ball.vol")
    expected = littoral.distance(read, points=0, method="signed-heat").values
    for copied in (pickle.loads(pickle.dumps(read)), copy.deepcopy(read)):
        assert copied.kind == "voxel surface"
        values = littoral.distance(copied, points=0, method="signed-heat").values
        np.testing.assert_array_equal(values, expected)
    with pytest.raises(littoral.UnsupportedError, match="nothing to weld"):
        read.welded()
    field = pickle.loads(pickle.dumps(littoral.distance(read, points=0)))
    assert field.mesh.kind == "voxel surface"


def test_archives_may_hold_more_than_numbers(tmp_path):
    more = {
        "about": "a text of more than nine letters",
        "bytes": np.array(b"abc"),
        "complex": np.array([1, 2j]),
        "objects": np.array([None, {}]),
        "date": np.array("2026-01-01", "M8[D]"),
        "record": np.zeros(2, [("a", "f8"), ("b", "i4")]),
    }
    points = np.arange(12.0).reshape(4, 3) ** 2
    np.savez(tmp_path / "cloud.npz", points=points, **more)
    np.testing.assert_array_equal(littoral.read(tmp_path / "cloud.npz").points, points)
    values = np.arange(8.0).reshape(2, 2, 2)
    np.savez(tmp_path / "volume.npz", values=values, origin=0, spacing=2, **more)
    np.testing.assert_array_equal(littoral.read_volume(tmp_path / "volume.npz").values, values)
    np.savez(tmp_path / "none.npz", **more)
    with pytest.raises(littoral.InputError, match="no array is"):
        littoral.read(tmp_path / "none.npz")
