"""Where results cannot be saved the error says what would do."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import littoral

EXTENSIONS = {
    "field": "ply", "regions": "csv", "volume": "npy", "tets": "vtu", "surface": "obj",
    "samples": "npz",
}  # fmt: skip


@pytest.fixture(scope="module")
def results() -> dict[str, Any]:
    square, cube = littoral.examples.square(4), littoral.examples.cube()
    tets = littoral.TetMesh(np.eye(4, 3), [[0, 1, 2, 3]])
    return {
        "field": littoral.distance(square, points=0),
        "regions": littoral.winding(square, [6, 8, 18, 16, 6]),
        "volume": littoral.SDF(cube).sample(6),
        "tets": littoral.tet_distance(tets, vertices=0),
        "surface": cube,
        "samples": littoral.samples(cube, surface=9, space=9, resolution=12),
    }


@pytest.mark.parametrize("name", EXTENSIONS)
def test_a_missing_folder_is_named(
    name: str, results: dict[str, Any], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result, extension = results[name], EXTENSIONS[name]
    path = f"out/result.{extension}"
    with pytest.raises(littoral.IoError) as error:
        result.save(path)
    assert str(error.value) == f"cannot write {path}: there is no folder out"
    assert error.value.code == "cannot-write" and isinstance(error.value, OSError)
    result.save(f"result.{extension}")
    result.save((str(tmp_path) + f"/again.{extension}").encode())
    assert (tmp_path / f"again.{extension}").exists()


def test_a_missing_folder_of_a_page_is_named(results: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(littoral.IoError, match="there is no folder"):
        results["field"].show(tmp_path / "out" / "page.html")


@pytest.mark.parametrize("name", ["field", "regions", "volume", "tets"])
def test_an_unknown_extension_lists_what_is_written(
    name: str, results: dict[str, Any], tmp_path: Path
) -> None:
    result, extension = results[name], EXTENSIONS[name]
    with pytest.raises(littoral.UnsupportedError, match="possible: ") as error:
        result.save(tmp_path / "result.foo")
    assert error.value.code == "unknown-format"
    possible = str(error.value).split("possible: ")[1].split()
    assert {f".{extension}", ".html", ".png"} <= set(possible)
    assert len(possible) == len(set(possible))
    for each in possible:
        try:
            result.save(tmp_path / f"result{each}")
        except littoral.UnsupportedError as refused:  # where a library was built without a part
            assert each in (".html", ".vdb"), refused
        else:
            assert (tmp_path / f"result{each}").exists(), each
