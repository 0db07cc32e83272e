"""Samples for learning."""

from __future__ import annotations

import json

import numpy as np
import pytest

import littoral


def test_samples_of_a_sphere(sphere, tmp_path) -> None:
    made = littoral.samples(sphere, surface=200, space=400, resolution=20, seed=3)
    sdf = littoral.SDF(sphere)
    exact = sdf(made.centre + made.half_side * made.points) / made.half_side
    assert np.abs(made.distances - exact).max() < 1e-9
    on = made.centre + made.half_side * made.surface_points
    assert np.abs(sdf(on)).max() < 1e-6
    assert ((made.surface_normals * on).sum(axis=1) > 0.95).all()
    assert set(made.kinds) == {0, 2, 3} and set(made.surface_kinds) == {0, 1}
    assert made.surface.n_faces > 100 and made.report.method == "auto"
    again = littoral.samples(sphere, surface=200, space=400, resolution=20, seed=3, threads=2)
    assert (again.points == made.points).all() and (again.distances == made.distances).all()
    made.save(tmp_path / "s.npz", "sphere")
    with np.load(tmp_path / "s.npz") as data:
        assert (data["points"] == made.points).all(), "positions are rounded already"
    assert json.loads((tmp_path / "s.json").read_text()) == made.card("sphere")
    for wrong in ({"numbers": "float8"}, {"resolution": 2}, {"scales": []}, {"uniform": 2}):
        with pytest.raises(littoral.InputError):
            littoral.samples(sphere, **wrong)


def test_the_libraries_of_the_formats_read_samples(sphere, tmp_path) -> None:
    zarr, webdataset = pytest.importorskip("zarr"), pytest.importorskip("webdataset")
    made = littoral.samples(sphere, surface=30, space=40, resolution=12, numbers="float16")
    for name in ("s.npz", "s.zarr", "s.tar"):
        made.save(tmp_path / name, "ball")
    with np.load(tmp_path / "s.npz") as data:
        arrays = {name: data[name] for name in data}
    group = zarr.open_group(str(tmp_path / "s.zarr"), mode="r")
    assert set(group.array_keys()) == set(arrays)
    assert group.attrs.asdict() == made.card("ball")
    [sample] = webdataset.WebDataset(str(tmp_path / "s.tar"), shardshuffle=False).decode()
    for name, array in arrays.items():
        assert (group[name][:] == array).all() and group[name].dtype == array.dtype, name
        assert (sample[name + ".npy"] == array).all(), name
