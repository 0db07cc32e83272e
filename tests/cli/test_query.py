"""littoral query: values at points."""

from pathlib import Path

import pytest
from conftest import Run, results


def test_places_are_named_one_by_one(run: Run, cube: Path, tmp_path: Path) -> None:
    places = ("--at", "0,0,0", "--at", "-3,0,0")
    assert run("query", "cube.obj", *places, "-o", "csv:-").stdout == (
        "x,y,z,distance\n0,0,0,-1\n-3,0,0,2\n"
    )
    run("winding", "cube.obj", *places, "-o", "w.csv")
    assert (tmp_path / "w.csv").read_text() == "x,y,z,winding\n0,0,0,1\n-3,0,0,0\n"
    for arguments, words in (
        ((), "[nothing-given]"),
        (("--at", "0,0,0", "--points", "points.csv"), "[options-conflict]"),
        (("--at", "0,0"), "three numbers"),
        (("--at", "0,0,nan"), "'nan' is not a finite number"),
    ):
        assert words in run("query", "cube.obj", *arguments, "-o", "a.csv", status=2).stderr


def test_query_gives_values_and_gradients(run: Run, cube: Path, tmp_path: Path) -> None:
    run("query", "cube.obj", "--points", "points.csv", "--gradient", "-o", "a.csv", "-o", "a.npy")
    middle, outside = results(tmp_path / "a.csv")
    assert middle[0] == pytest.approx(-1)
    assert outside == pytest.approx([2, 1, 0, 0])
    assert b"(2, 4)" in (tmp_path / "a.npy").read_bytes()
    run("query", "cube.obj", "--points", "points.csv", "--flip", "-o", "b.csv", "-o", "b.ply")
    assert [row[0] for row in results(tmp_path / "b.csv")] == pytest.approx([1, -2])


@pytest.mark.parametrize("how", [(), ("--flip",), ("--method", "winding"), ("--offset", 0)])
def test_zero_has_no_sign(run: Run, cube: Path, tmp_path: Path, how: tuple[str, ...]) -> None:
    """On the surface, whichever side its points count to."""
    places = ["1,0,0", "-1,0,0", "1,1,1", "0,0,-1", "0.3,1,0.2", "0,-1,0"]
    (tmp_path / "on.csv").write_text("x,y,z\n" + "\n".join(places) + "\n")
    run("query", "cube.obj", "--points", "on.csv", *how, "-o", "a.csv", "-o", "a.npy")
    rows = (tmp_path / "a.csv").read_text().splitlines()[1:]
    assert rows == [f"{place},0" for place in places]


@pytest.mark.parametrize("method", ["closest-point", "hopf-cole", "planar", "log-sum-exp", "tori"])
def test_every_method_answers(run: Run, cube: Path, tmp_path: Path, method: str) -> None:
    run("query", "cube.obj", "--points", "points.csv", "--method", method, "-o", "a.csv")
    middle, outside = results(tmp_path / "a.csv")
    assert middle[0] < -0.8
    assert outside[0] == pytest.approx(2, abs=0.4)
