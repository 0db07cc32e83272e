"""littoral repair: what comes out is closed, and says what was done."""

import json
import re
from pathlib import Path

import numpy as np
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
    assert "--error must be greater than 0" in run(*words, "--error", "0%", status=2).stderr


def test_what_has_no_inside_becomes_a_wall(run: Run, tmp_path: Path) -> None:
    (tmp_path / "sheet.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    found = run("repair", "sheet.obj", "-o", "out.obj", "--resolution", 24)
    assert "[sheets-thickened]" in found.stderr and "--thicken says how thick" in found.stderr
    facts = json.loads(run("info", "out.obj", "--json").stdout)
    assert facts["watertight"] and facts["self_intersecting_triangles"] == 0
    low, high = facts["bounding_box"][2], facts["bounding_box"][5]
    thickness = high - low
    assert 0 < thickness < 0.2 and low == pytest.approx(-high, abs=0.01)
    said = re.search(r"walls ([\d.]+) thick", found.stderr)
    assert said and thickness == pytest.approx(float(said[1]), rel=0.02)


def double_planes() -> str:
    """Three squares across each other, each triangle twice with both orientations."""
    points = "v 0 0 0\n" + "".join(
        f"v {x} {y} {z}\n"
        for x, y, z in ((1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1))
    )
    rings = ((2, 3, 5, 6), (2, 4, 5, 7), (3, 4, 6, 7))
    faces = [(r[i], r[(i + 1) % 4]) for r in rings for i in range(4)]
    return points + "".join(f"f 1 {a} {b}\nf 1 {b} {a}\n" for a, b in faces)


SHEETS = {
    "double planes": double_planes(),
    "one triangle": "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    "three at an edge": "v 0 0 0\nv 0 0 1\nv 1 0 0\nv -1 1 0\nv -1 -1 0\n"
    + "f 1 2 3\nf 1 2 4\nf 1 2 5\n",
}


@pytest.mark.parametrize("name", SHEETS)
def test_sheets_of_any_kind_become_sound_walls(run: Run, tmp_path: Path, name: str) -> None:
    (tmp_path / "sheet.obj").write_text(SHEETS[name])
    run("repair", "sheet.obj", "-o", "out.obj", "--resolution", 20)
    facts = json.loads(run("info", "out.obj", "--json").stdout)
    assert facts["watertight"] and facts["components"] == 1
    assert facts["self_intersecting_triangles"] == facts["nonmanifold_vertices"] == 0


@pytest.mark.parametrize(("name", "status"), [("x.csv", 2), ("no/such/x.stl", 1)])
def test_outputs_are_checked_first(run: Run, tmp_path: Path, name: str, status: int) -> None:
    (tmp_path / "open.obj").write_text(CUBE)
    assert name in run("repair", "open.obj", "-o", name, status=status).stderr


def test_what_goes_back_in_the_fit_is_asked_again(run: Run, tmp_path: Path) -> None:
    """Triangles through each other, where vertices that went back met others that had not."""
    rng = np.random.default_rng(1)
    centres = rng.uniform(-1, 1, (110, 1, 3))
    corners = (centres + rng.uniform(-1.2, 1.2, (110, 3, 3))).reshape(-1, 3)
    text = "".join(f"v {x:.4f} {y:.4f} {z:.4f}\n" for x, y, z in corners)
    text += "".join(f"f {3 * i + 1} {3 * i + 2} {3 * i + 3}\n" for i in range(110))
    (tmp_path / "soup.obj").write_text(text)
    words = ("repair", "soup.obj", "-o", "out.obj", "--resolution", 32, "--json")
    assert json.loads(run(*words).stdout)["sizes"]["result: self intersecting triangles"] == 0


@pytest.mark.parametrize("size", [1e-200, 1e-150, 1e200])
def test_neither_info_nor_repair_depends_on_the_unit(run: Run, tmp_path: Path, size: float) -> None:
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    for name, scale in (("one.obj", 1.0), ("sized.obj", size)):
        rows = [f"v {x * scale!r} {y * scale!r} {z * scale!r}" for x, y, z in corners]
        (tmp_path / name).write_text("\n".join([*rows, "f 1 3 2", "f 1 2 4", "f 2 3 4", "f 1 4 3"]))
    one, sized = (json.loads(run("info", f"{n}.obj", "--json").stdout) for n in ("one", "sized"))
    for key in ("thickness_5_percent", "thickness_median"):
        assert sized[key] / size == pytest.approx(one[key], rel=1e-9)
    assert sized["watertight"] is True
    report = json.loads(run("repair", "sized.obj", "-o", "kept.obj", "--json").stdout)
    assert "triangles of the input turned, share" in report["sizes"], "kept as they are"


@pytest.mark.parametrize("option", ["--noisy", "--sharpness=2"])
def test_options_are_looked_at_where_triangles_are_kept(
    run: Run, tmp_path: Path, option: str
) -> None:
    corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    rows = [f"v {x} {y} {z}" for x, y, z in corners]
    (tmp_path / "closed.obj").write_text(
        "\n".join([*rows, "f 1 3 2", "f 1 2 4", "f 2 3 4", "f 1 4 3"])
    )
    failed = run("repair", "closed.obj", option, "-o", "out.obj", status=2)
    assert "has no option" in failed.stderr and "unknown-name" in failed.stderr


def test_walls_far_beyond_the_input_are_refused(run: Run, tmp_path: Path) -> None:
    (tmp_path / "open.obj").write_text(CUBE)
    failed = run("repair", "open.obj", "--thicken", "1e9", "-o", "out.obj", status=2)
    assert "option --thicken must be at most 100 times as long as the input" in failed.stderr
