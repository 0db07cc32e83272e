"""littoral sdf and query: values, formats, statuses."""

import json
import math
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import PROGRAM, Run

CUBE = """v -1 -1 -1
v 1 -1 -1
v -1 1 -1
v 1 1 -1
v -1 -1 1
v 1 -1 1
v -1 1 1
v 1 1 1
f 1 3 4 2
f 5 6 8 7
f 1 2 6 5
f 3 7 8 4
f 1 5 7 3
f 2 4 8 6
"""


@pytest.fixture
def cube(tmp_path: Path) -> Path:
    """cube.obj, of side 2 about the origin, and points.csv: its middle, and (3, 0, 0)."""
    (tmp_path / "cube.obj").write_text(CUBE)
    (tmp_path / "points.csv").write_text("x,y,z\n0,0,0\n3,0,0\n")
    return tmp_path / "cube.obj"


def rows(path: Path) -> list[list[float]]:
    lines = path.read_text().splitlines()
    return [[float(x) for x in line.split(",")] for line in lines[1:]]


def test_query_gives_values_and_gradients(run: Run, cube: Path, tmp_path: Path) -> None:
    run("query", "cube.obj", "--points", "points.csv", "--gradient", "-o", "a.csv", "-o", "a.npy")
    middle, outside = rows(tmp_path / "a.csv")
    assert middle[0] == pytest.approx(-1)
    assert outside == pytest.approx([2, 1, 0, 0])
    assert b"(2, 4)" in (tmp_path / "a.npy").read_bytes()
    run("query", "cube.obj", "--points", "points.csv", "--flip", "-o", "b.csv", "-o", "b.ply")
    assert rows(tmp_path / "b.csv")[1][0] == pytest.approx(2)  # a winding number of -1 is outside


@pytest.mark.parametrize("method", ["closest-point", "hopf-cole", "planar", "log-sum-exp"])
def test_every_method_answers(run: Run, cube: Path, tmp_path: Path, method: str) -> None:
    run("query", "cube.obj", "--points", "points.csv", "--method", method, "-o", "a.csv")
    middle, outside = rows(tmp_path / "a.csv")
    assert middle[0] < -0.8
    assert outside[0] == pytest.approx(2, abs=0.4)


def test_sdf_writes_volumes_surfaces_and_a_report(run: Run, cube: Path, tmp_path: Path) -> None:
    names = [x for e in ("vti", "npy", "nrrd", "obj", "png") for x in ("-o", "a." + e)]
    result = run("sdf", "cube.obj", "--resolution", 24, "--level", "0,0.2", "--json", *names)
    report = json.loads(result.stdout)
    assert report["method"] == "signed-heat"
    assert report["domain"] == "grid"
    assert report["sizes"]["nodes"] == 24**3
    info = json.loads(run("info", "a.obj", "--json").stdout)
    assert info["components"] == 2
    assert info["boundary_edges"] == 0


def test_sdf_on_tets(run: Run, cube: Path, tmp_path: Path) -> None:
    run("sdf", "cube.obj", "--domain", "tets", "--resolution", 16, "-o", "t.ply", "-o", "t.vti")
    info = json.loads(run("info", "t.ply", "--json").stdout)
    assert info["boundary_edges"] == 0
    run("sdf", "cube.obj", "--domain", "tets", "--method", "planar", "-o", "x.ply", status=2)


def test_clouds_without_normals_name_the_remedy(run: Run, tmp_path: Path) -> None:
    points = []
    for i in range(400):
        z = 1 - 2 * (i + 0.5) / 400
        r, a = math.sqrt(1 - z * z), i * 2.399963
        points.append((r * math.cos(a), r * math.sin(a), z))
    (tmp_path / "c.xyz").write_text("".join(f"{x} {y} {z}\n" for x, y, z in points))
    (tmp_path / "q.txt").write_text("0 0 0\n2 0 0\n")
    error = run("query", "c.xyz", "--points", "q.txt", "-o", "a.csv", status=2).stderr
    assert "--estimate-normals" in error
    run("query", "c.xyz", "--points", "q.txt", "--estimate-normals", "-o", "a.csv")
    middle, outside = rows(tmp_path / "a.csv")
    assert middle[0] == pytest.approx(-1, abs=0.05)
    assert outside[0] == pytest.approx(1, abs=0.05)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--resolution", "1"), "--resolution"),
        (("--resolution", "20000"), "too large"),
        (("--resolution", "1200"), "memory"),
        (("--bounds", "5,5,5,6,6,6"), "misses"),
        (("--bounds", "1,2,3"), "--bounds"),
        (("--method", "magic"), "unknown method"),
        (("--sharpness", "2"), "no option"),
    ],
)
def test_bad_usage_is_said_in_one_line(
    run: Run, cube: Path, arguments: tuple[str, str], words: str
) -> None:
    assert words in run("sdf", "cube.obj", *arguments, "-o", "a.vti", status=2).stderr


def test_nothing_is_left_where_writing_fails(run: Run, cube: Path, tmp_path: Path) -> None:
    run("sdf", "cube.obj", "--resolution", 8, "-o", "missing/a.vti", status=1)
    assert not (tmp_path / "missing").exists()


def test_interrupt_stops_soon(cube: Path, tmp_path: Path) -> None:
    command = [PROGRAM, "sdf", "cube.obj", "--resolution", "200", "-o", "a.vti"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE)
    time.sleep(0.5)
    os.kill(process.pid, signal.SIGINT)
    start = time.monotonic()
    process.wait(timeout=10)
    assert time.monotonic() - start < 1
    assert process.returncode == 130
    assert not list(tmp_path.glob("*.vti"))
