"""Distance in space counted from values: sdf, query and offset."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Run

QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5))


def boxes(*centres: float) -> str:
    """Unit boxes along x, one connected part each."""
    lines, first = [], 1
    for centre in centres:
        for v in range(8):
            x, y, z = (centre + (v & 1) - 0.5, (v >> 1 & 1) - 0.5, (v >> 2) - 0.5)
            lines.append(f"v {x} {y} {z}")
        lines += ["f " + " ".join(str(first + k) for k in quad) for quad in QUADS]
        first += 8
    return "\n".join(lines) + "\n"


def asked(run: Run, tmp_path: Path, *words: str) -> list[float]:
    """Distance at a few places along x."""
    (tmp_path / "at.csv").write_text("x,y,z\n-2.5,0,0\n-1.5,0,0\n0,0,0\n1.5,0,0\n3,0,0\n")
    run("query", *words, "--points", "at.csv", "-o", "d.csv")
    with (tmp_path / "d.csv").open() as rows:
        return [float(row["distance"]) for row in csv.DictReader(rows)]


def test_one_for_each_part(run: Run, tmp_path: Path) -> None:
    (tmp_path / "two.obj").write_text(boxes(-1.5, 1.5))
    plain = asked(run, tmp_path, "two.obj")
    assert plain == pytest.approx([0.5, -0.5, 1, -0.5, 1])
    assert asked(run, tmp_path, "two.obj", "--values", "0.3,-0.2") == pytest.approx(
        [0.8, -0.2, 0.8, -0.7, 0.8]
    )
    assert asked(run, tmp_path, "two.obj", "--values=-0.25") == pytest.approx(
        [d - 0.25 for d in plain]
    )
    # Of the longest side, 4.
    assert asked(run, tmp_path, "two.obj", "--values", "5%") == pytest.approx(
        [d + 0.2 for d in plain]
    )
    box = ("--bounds=-3,-1,-1,3,1,1", "--spacing", 0.5, "-o", "d.npy")
    run("sdf", "two.obj", "--values", "0.3,-0.2", *box)
    assert float(np.load(tmp_path / "d.npy").min()) == pytest.approx(-0.7)


def test_points_are_balls_of_their_own(run: Run, tmp_path: Path) -> None:
    (tmp_path / "p.xyz").write_text("0 0 0\n3 0 0\n")
    given = ("p.xyz", "--values=-1,-0.5")
    assert asked(run, tmp_path, *given) == pytest.approx([1.5, 0.5, -1, 0.5, -0.5])
    report = json.loads(
        run("offset", *given, "--distance", 0, "--resolution", 24, "--json", "-o", "b.ply").stdout
    )
    assert report["status"] == "converged"
    info = json.loads(run("info", "b.ply", "--json").stdout)
    assert (info["components"], info["boundary_edges"]) == (2, 0)
    named = "\n".join(
        ["ply", "format ascii 1.0", "element vertex 2", "property double x", "property double y",
         "property double z", "property double reach", "end_header", "0 0 0 -1", "3 0 0 -0.5", ""]
    )  # fmt: skip
    (tmp_path / "p.ply").write_text(named)
    assert asked(run, tmp_path, "p.ply", "--values", "reach") == pytest.approx(
        [1.5, 0.5, -1, 0.5, -0.5]
    )


def test_what_has_no_meaning_is_refused(run: Run, tmp_path: Path) -> None:
    (tmp_path / "two.obj").write_text(boxes(-1.5, 1.5))
    (tmp_path / "p.xyz").write_text("0 0 0\n3 0 0\n")
    for words, text in (
        (("two.obj", "--values", "1,2,3"), "3 numbers for 2 connected parts"),
        (("p.xyz", "--values", "1,2,3"), "3 numbers for 2 points"),
        (("two.obj", "--values", "0,1", "--method", "planar"), "on a grid these take them: auto, "),
        (("two.obj", "--values", "0,1", "--unite", "two.obj"), "one mesh, soup or cloud"),
        (("two.obj", "--values", "0,1", "--field", "winding"), "no values"),
        (("two.obj", "--values", "0,x"), "values"),
        (("p.xyz", "--values=-1", "--domain", "tets"), "not through tets"),
    ):
        assert text in run("sdf", *words, "-o", "d.npy", status=2).stderr, words
    curves = ("two.obj", "--curve-vertices", "0,1", "--distance", 0.1, "--values", 1, "-o", "l.obj")
    assert "option --values" in run("offset", *curves, status=2).stderr


def test_what_is_shadowed_is_told(run: Run, tmp_path: Path) -> None:
    (tmp_path / "two.obj").write_text(boxes(-1.5, 1.5))  # 2 apart
    done = run("sdf", "two.obj", "--values", "0,2.5", "--resolution", 12, "-o", "d.npy")
    assert "the source of value 2.5 has a value 0.5 above" in done.stderr
    done = run("sdf", "two.obj", "--values", "0,1.5", "--resolution", 12, "-o", "d.npy")
    assert "shadowed" not in done.stderr
