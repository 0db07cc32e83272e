"""Tets as a domain: littoral distance, contour, info, convert and render on tet meshes."""

import itertools
import json
from pathlib import Path

import numpy as np
import pytest
from conftest import Run


def cube_mesh(n: int) -> str:
    """The unit cube in n^3 cells of six tets each, in Medit's format."""
    rows = [f"{i / n} {j / n} {k / n} 0" for k, j, i in itertools.product(range(n + 1), repeat=3)]
    tets = []
    for k, j, i in itertools.product(range(n), repeat=3):
        for axes in itertools.permutations(range(3)):
            at = [i, j, k]
            path = [tuple(at)]
            for axis in axes:
                at[axis] += 1
                path.append(tuple(at))
            numbers = [1 + x + (n + 1) * (y + (n + 1) * z) for x, y, z in path]
            tets.append(" ".join(map(str, numbers)) + " 0")
    return "\n".join(
        [
            "MeshVersionFormatted 1",
            "Dimension 3",
            "Vertices",
            str(len(rows)),
            *rows,
            "Tetrahedra",
            str(len(tets)),
            *tets,
            "End",
            "",
        ]
    )


@pytest.fixture
def cube(tmp_path: Path) -> str:
    """cube.mesh, and half.obj: the square x = 1/2, positive where x is larger."""
    (tmp_path / "cube.mesh").write_text(cube_mesh(4))
    corners = "v 0.5 0 0\nv 0.5 1 0\nv 0.5 1 1\nv 0.5 0 1\n"
    (tmp_path / "half.obj").write_text(corners + "f 1 2 3\nf 1 3 4\n")
    return "cube.mesh"


def test_distance_from_a_surface(run: Run, cube: str, tmp_path: Path) -> None:
    out = ["d.vtk", "d.vtu", "d.csv", "d.npy", "d.ply", "d.html", "d.png"]
    words = [word for file in out for word in ("-o", file)]
    report = json.loads(run("distance", cube, "--sources", "half.obj", "--json", *words).stdout)
    assert report["domain"] == "tet mesh"
    assert report["sizes"]["tets"] == 384
    lines = (tmp_path / "d.csv").read_text().splitlines()[1:]
    values = [float(line.split(",")[1]) for line in lines]
    assert len(values) == 125
    for v, value in enumerate(values):
        assert value == pytest.approx(v % 5 / 4 - 0.5, abs=1e-3)
    assert all((tmp_path / file).stat().st_size > 0 for file in out)


def test_values_of_sources(run: Run, cube: str, tmp_path: Path) -> None:
    def answer(*words: str) -> list[float]:
        run("distance", cube, *words, "-o", "d.npy")
        return np.load(tmp_path / "d.npy").tolist()

    for name, x in (("low", 0.25), ("high", 0.75)):
        corners = f"v {x} 0 0\nv {x} 1 0\nv {x} 1 1\nv {x} 0 1\n"
        (tmp_path / f"{name}.obj").write_text(corners + "f 1 2 3 4\n")
    slab = ("-s", "low.obj", "-s", "high.obj", "--method", "signed-heat", "--values")
    assert answer(*slab, "0,0.8")[:5] == pytest.approx([-0.25, 0, 0.4, 0.8, 1.05], abs=2e-3)
    assert answer(*slab, "3")[:5] == pytest.approx([2.75, 3, 3, 3, 3.25], abs=2e-3)
    both = answer("--vertex", "0", "--boundary", "--values", "-1,0.5")
    assert both[:3] == pytest.approx([-1, -0.75, -0.5])
    assert both[124] == pytest.approx(0.5)
    error = run("distance", cube, *slab, "1,2,3", "-o", "d.npy", status=2).stderr
    assert "3 numbers for 2 sources" in error
    (tmp_path / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    words = ("one.obj", "--vertex", "0", "--values", "1", "-o", "d.npy")
    assert "option --values is for tets" in run("distance", *words, status=2).stderr


def test_two_sheets_are_level_sets(run: Run, cube: str, tmp_path: Path) -> None:
    def sheet(x: float) -> str:
        return "".join(f"v {x} {y} {z}\n" for y, z in ((0, 0), (1, 0), (1, 1), (0, 1)))

    faces = "f 1 2 3\nf 1 3 4\nf 5 6 7\nf 5 7 8\n"
    (tmp_path / "sheets.obj").write_text(sheet(0.3) + sheet(0.7) + faces)
    words = ("--method", "signed-heat", "--constraint", "level-sets")
    run("distance", cube, "--sources", "sheets.obj", *words, "-o", "d.csv")
    lines = (tmp_path / "d.csv").read_text().splitlines()[1:]
    for v, line in enumerate(lines):
        assert float(line.split(",")[1]) == pytest.approx(v % 5 / 4 - 0.5, abs=2e-3)
    for domain in ("grid", "tets"):
        box = ("--bounds", "0,0,0,1,1,1", "--resolution", 9, "--domain", domain)
        run("sdf", "sheets.obj", *box, *words, "-o", "g.npy")
        g = np.load(tmp_path / "g.npy")
        assert g[0, 4, 4] == pytest.approx(-0.5, abs=0.05), domain
        assert g[8, 4, 4] == pytest.approx(0.5, abs=0.05)
    sharp = run("sdf", "sheets.obj", *box, *words, "--sharpen", "-o", "g.npy", status=2).stderr
    assert "level-sets" in sharp


def test_distance_from_a_vertex_and_its_level_set(run: Run, cube: str, tmp_path: Path) -> None:
    run("distance", cube, "--vertex", 62, "-o", "d.vtk")
    run("contour", "d.vtk", "--level", "0.3", "-o", "ball.ply")
    facts = json.loads(run("info", "ball.ply", "--json").stdout)
    assert facts["boundary_edges"] == 0
    assert facts["nonmanifold_edges"] == 0
    facts = json.loads(run("info", "d.vtk", "--json").stdout)
    assert facts["tets"] == 384
    assert facts["fields"] == "distance"
    run("render", "d.vtk", "-o", "d.png")
    run("convert", "d.vtk", "-o", "boundary.obj")
    assert json.loads(run("info", "boundary.obj", "--json").stdout)["faces"] == 192


def test_regularized_distance_from_the_boundary_cut_open(
    run: Run, cube: str, tmp_path: Path
) -> None:
    words = ["--method", "regularized", "--boundary", "--alpha", "0"]
    out = ["--json", "-o", "d.vtk", "-o", "d.txt"]
    report = json.loads(run("distance", cube, *words, *out).stdout)
    assert report["status"] == "converged"
    values = [float(line) for line in (tmp_path / "d.txt").read_text().splitlines()]
    assert max(values) == pytest.approx(0.5, abs=0.12)  # edges of a quarter
    assert values[0] == 0
    run("render", "d.vtk", "--axis", "x", "--slice", "0.4", "-o", "cut.png")
    assert "misses" in run("render", "d.vtk", "--slice", "7", "-o", "x.png", status=2).stderr
    message = run("distance", cube, *words[:3], "--regularizer", "hessian", "-o", "d.vtk", status=2)
    assert "no option 'regularizer'" in message.stderr


def test_the_lattice_is_written_as_tets(run: Run, cube: str) -> None:
    run("sdf", "half.obj", "--domain", "tets", "--resolution", 9, "-o", "lattice.vtu")
    run("sdf", "half.obj", "--domain", "tets", "--resolution", 9, "-o", "lattice.vtk")
    assert json.loads(run("info", "lattice.vtk", "--json").stdout)["tets"] > 100
    assert "--domain tets" in run("sdf", "half.obj", "-o", "grid.vtk", status=2).stderr


def test_errors_are_clear(run: Run, cube: str, tmp_path: Path) -> None:
    def error(*words: object, status: int = 2) -> str:
        return run("distance", cube, *words, status=status).stderr

    assert "--sources FILE, --vertex I, --at X,Y,Z or --boundary" in error("-o", "d.vtk")
    assert "there is no vertex 125" in error("--vertex", 125, "-o", "d.vtk")
    assert "not both" in error("--vertex", 0, "--sources", "half.obj", "-o", "d.vtk")
    unknown = error("--vertex", 0, "--method", "winding", "-o", "d.vtk")
    assert "known: auto, signed-heat, regularized, belyaev-fayolle, quadratic" in unknown
    assert ".vtk" in error("--vertex", 0, "-o", "d.vti")
    (tmp_path / "bad.mesh").write_text(cube_mesh(2).replace("\n1 2 5 14 0", "\n1 2 5 99 0"))
    message = run("distance", "bad.mesh", "--vertex", 0, "-o", "d.vtk", status=2).stderr
    assert "bad.mesh:" in message
    assert "refers to vertex 99" in message
    assert not list(tmp_path.glob("d.*"))
