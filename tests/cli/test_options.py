"""Sources, levels, lengths and looks given as options."""

from pathlib import Path

import numpy as np
import pytest
from conftest import Run
from test_volumes import facts, sphere, write_nrrd


def field(path: Path) -> np.ndarray:
    return np.loadtxt(path)


def vertices(mesh: Path) -> np.ndarray:
    rows = [line.split()[1:] for line in mesh.read_text().splitlines() if line[:2] == "v "]
    return np.array(rows, dtype=float)


@pytest.mark.parametrize(
    ("arguments", "place"),
    [
        (("--at", "0.33,0.41,0"), (0.33, 0.41, 0)),
        (("--at=-3,0.5,0",), (0, 0.5, 0)),
        (("--face", "0,0.2,0.3,0.5"), (0.08, 0.05, 0)),  # corners (0,0), (.1,0), (.1,.1)
        (("--edge", "0,1,0.25"), (0.025, 0, 0)),
        (("--edge", "1,0,0.25"), (0.075, 0, 0)),
    ],
)
def test_points_without_a_file(
    run: Run, mesh: Path, arguments: tuple[str, ...], place: tuple[float, float, float]
) -> None:
    result = run("distance", "square.obj", *arguments, "--method", "exact", "-o", "a.txt")
    expected = np.linalg.norm(vertices(mesh) - np.array(place), axis=1)
    assert field(mesh.parent / "a.txt") == pytest.approx(expected, abs=1e-9)
    assert ("is 3 from the surface" in result.stderr) == ("--at=-3,0.5,0" in arguments)


def test_places_within_polygons_are_moved_to_vertices(run: Run, tmp_path: Path) -> None:
    corners = [(0, 0), (4, 0), (8, 0), (0, 3), (4, 3), (8, 3)]
    lines = [f"v {x} {y} 0" for x, y in corners] + ["f 1 2 5 4", "f 2 3 6 5"]
    (tmp_path / "quads.obj").write_text("\n".join(lines) + "\n")
    result = run("distance", "quads.obj", "--at", "5.5,2,0", "-o", "a.txt")
    assert "5.5,2,0 is 1.803 from vertex 4, which is taken" in result.stderr
    assert "face 1 has 4 corners [source-moved]" in result.stderr
    assert field(tmp_path / "a.txt")[4] == 0
    result = run("distance", "quads.obj", "--at", "4,2.99,0", "-o", "a.txt")
    assert "source-moved" not in result.stderr and field(tmp_path / "a.txt")[4] == 0


def test_curves_without_a_file(run: Run, mesh: Path) -> None:
    column = [str(5 + 11 * j) for j in range(11)]
    run("distance", "square.obj", "-s", "curve.txt", "-o", "a.txt")
    run("distance", "square.obj", "--curve-vertices", ",".join(column), "-o", "b.txt")
    run("distance", "--curve-vertices", *column, "square.obj", "-o", "c.txt")
    expected = (mesh.parent / "a.txt").read_text()
    assert (mesh.parent / "b.txt").read_text() == expected
    assert (mesh.parent / "c.txt").read_text() == expected
    run("offset", "square.obj", "--curve-vertices", *column, "--distance", "0.2", "-o", "o.obj")
    assert vertices(mesh.parent / "o.obj")[:, 0] == pytest.approx(0.3, abs=0.02)
    loop = ("--curve-vertices", "24,30,96,90,24")  # not along edges
    run("winding", "square.obj", *loop, "-o", "w.txt")
    assert set(field(mesh.parent / "w.txt")) == {0, 1}


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--at", "1,2"), "--at takes three numbers"),
        (("--face", "900,1,0,0"), "no element 900"),
        (("--face", "0,0.5,0.1,0"), "add up to 1"),
        (("--edge", "0,120,0.5"), "no edge from 0 to 120"),
        (("--edge", "0,1,2"), "I,J,t"),
        (("--curve-vertices", "5"), "at least two"),
    ],
)
def test_bad_sources_are_named(
    run: Run, mesh: Path, arguments: tuple[str, ...], words: str
) -> None:
    assert words in run("distance", "square.obj", *arguments, "-o", "a.txt", status=2).stderr


def test_evenly_spaced_levels(run: Run, mesh: Path) -> None:
    run("distance", "square.obj", "-s", "curve.txt", "-o", "d.ply")
    run("contour", "d.ply", "--count", 4, "-o", "a.obj")
    # from -0.5 to 0.5: -0.3, -0.1, 0.1, 0.3
    x = set(np.round(vertices(mesh.parent / "a.obj")[:, 0], 3))
    assert sorted(x) == pytest.approx([0.2, 0.4, 0.6, 0.8])


def test_levels_of_a_range(run: Run, mesh: Path) -> None:
    write_nrrd(mesh.parent / "d.nrrd", 24, sphere)
    run(
        "contour",
        "d.nrrd",
        "--range=-0.3,0.3",
        "--count",
        3,
        *[word for k in range(3) for word in ("-o", f"{k}.ply")],
    )
    for k, radius in enumerate((0.3, 0.6, 0.9)):
        assert facts(run, f"{k}.ply")["bounding_box"][3] == pytest.approx(radius, abs=0.02)
    run("contour", "d.nrrd", "-o", "a.ply", status=2)
    run("contour", "d.nrrd", "--count", 2, "--level", 0, "-o", "a.ply", status=2)
    run("contour", "d.nrrd", "--level", 0, "--range", "0,1", "-o", "a.ply", status=2)
    run("contour", "d.nrrd", "--count", 2, "--range", "1,0", "-o", "a.ply", status=2)


def test_lengths_in_per_cent(run: Run, tmp_path: Path) -> None:
    write_nrrd(tmp_path / "d.nrrd", 24, sphere)  # the box has the side 2
    run("offset", "d.nrrd", "--distance", "5%,0.1", "-o", "a.ply", "-o", "b.ply")
    a, b = (facts(run, f"{name}.ply")["bounding_box"] for name in "ab")
    assert a == pytest.approx(b)
    assert b[3] == pytest.approx(0.7, abs=0.01)
    run("sdf", "d.nrrd", "--spacing", "10%", "--level=-5%", "-o", "c.vti", "-o", "c.ply")
    assert facts(run, "c.vti")["spacing"] == pytest.approx([0.2] * 3, rel=0.05)
    assert facts(run, "c.ply")["bounding_box"][3] == pytest.approx(0.5, abs=0.04)
    assert (
        "--distance" in run("offset", "d.nrrd", "--distance", "x%", "-o", "a.ply", status=2).stderr
    )


def pixels(path: Path) -> bytes:
    return path.read_bytes()


def test_looks(run: Run, mesh: Path) -> None:
    run("distance", "square.obj", "-s", "curve.txt", "-o", "d.ply")
    small = ("--width", 120, "--height", 90)
    seen = []
    for look in (
        (),
        ("--up", "x"),
        ("--up=-y",),
        ("--view", "1,1,1"),
        ("--view=z", "--up=x"),
        ("--colour-map", "grey"),
        ("--colour-map", "heat"),
        ("--colour-range=-2,2",),
    ):
        run("render", "d.ply", *small, *look, "-o", "a.png")
        seen.append(pixels(mesh.parent / "a.png"))
        run("view", "d.ply", *look, "-o", "a.html")
    assert len(set(seen[:4])) == 4
    assert len(set(seen[5:])) == 3
    assert "--view" in run("render", "d.ply", "--view", "0,0,0", "-o", "a.png", status=2).stderr
    parallel = run("render", "d.ply", "--view", "z", "--up", "z", "-o", "a.png", status=2)
    assert "--up is parallel" in parallel.stderr
