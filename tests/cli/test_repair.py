"""littoral repair: what comes out is closed, and says what was done."""

import json
from pathlib import Path

import pytest
from conftest import Run

CUBE = (
    "".join(f"v {x} {y} {z}\n" for z in (0, 1) for y in (0, 1) for x in (0, 1))
    + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\n"
)  # the side x = 1 is missing


def test_an_open_cube(run: Run, tmp_path: Path) -> None:
    (tmp_path / "open.obj").write_text(CUBE)
    words = ("repair", "open.obj", "-o", "out.ply", "-o", "out.png", "--resolution", 24, "--json")
    report = json.loads(run(*words).stdout)
    sizes = report["sizes"]
    assert (sizes["input: boundary edges"], sizes["result: boundary edges"]) == (4, 0)
    assert report["values"]["distance"]["min"] == 0
    facts = json.loads(run("info", "out.ply", "--json").stdout)
    assert facts["watertight"] and facts["self_intersecting_triangles"] == 0
    assert (tmp_path / "out.png").stat().st_size > 1000


def test_lengths_in_per_cent_and_what_goes_together(run: Run, tmp_path: Path) -> None:
    (tmp_path / "open.obj").write_text(CUBE)
    words = ("repair", "open.obj", "-o", "out.stl")
    sizes = json.loads(run(*words, "--thicken", "20%", "--resolution", 24, "--json").stdout)[
        "sizes"
    ]
    assert sizes["result: handles"] == 0
    assert sizes["parts"] == 1
    assert "resolution" in run(*words, "--error", ".1", "--resolution", 24, status=2).stderr
    assert "smallest-part" in run(*words, "--smallest-part", "9", status=2).stderr
    assert "nan" in run(*words, "--error", "nan", status=2).stderr


def test_what_has_no_inside(run: Run, tmp_path: Path) -> None:
    (tmp_path / "sheet.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    found = run("repair", "sheet.obj", "-o", "out.stl", "--resolution", 24, status=2)
    assert "no inside" in found.stderr and "thicken" in found.stderr
    assert not (tmp_path / "out.stl").exists()


@pytest.mark.parametrize(("name", "status"), [("x.csv", 2), ("no/such/x.stl", 1)])
def test_outputs_are_checked_first(run: Run, tmp_path: Path, name: str, status: int) -> None:
    (tmp_path / "open.obj").write_text(CUBE)
    assert name in run("repair", "open.obj", "-o", name, status=status).stderr
