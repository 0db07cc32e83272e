"""Runs the program named by LITTORAL on tiny meshes made here."""

import os
import re
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest

PROGRAM = os.environ.get("LITTORAL", "littoral")
Run = Callable[..., subprocess.CompletedProcess[str]]
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
# A shell may start the tests in the background, where Ctrl-C is ignored, also by what they start.
signal.signal(signal.SIGINT, signal.default_int_handler)


def square(n: int) -> str:
    """An OBJ of the unit square in n x n cells of two triangles; vertex i + j (n + 1)."""
    lines = [f"v {i / n} {j / n} 0" for j in range(n + 1) for i in range(n + 1)]
    for j in range(n):
        for i in range(n):
            a = j * (n + 1) + i + 1
            b, c, d = a + 1, a + n + 2, a + n + 1
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    return "\n".join(lines) + "\n"


def results(path: Path) -> list[list[float]]:
    """The rows of a .csv of results at points, without these: x, y, z come first."""
    head, *lines = path.read_text().splitlines()
    assert head.startswith("x,y,z,")
    return [[float(x) for x in line.split(",")[3:]] for line in lines]


@pytest.fixture
def run(tmp_path: Path) -> Run:
    """Runs the program in the test's folder and checks the status and the shape of its messages."""

    def call(*arguments: object, status: int = 0) -> subprocess.CompletedProcess[str]:
        result = subprocess.run(
            [PROGRAM, *map(str, arguments)],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=60,
        )
        assert result.returncode == status, result.stderr
        if status in (1, 2):
            errors = [x for x in result.stderr.splitlines() if "warning: " not in x]
            assert len(errors) == 1, result.stderr
            assert errors[0].startswith("littoral: error: ")
            assert "--json" in arguments or result.stdout == ""
        return result

    return call


@pytest.fixture
def mesh(tmp_path: Path) -> Path:
    """square.obj, with a curve up its middle in curve.txt: the left half is positive."""
    (tmp_path / "square.obj").write_text(square(10))
    nodes = "".join(f"v {5 + 11 * j}\n" for j in range(11))
    (tmp_path / "curve.txt").write_text("signed_curve\n" + nodes)
    return tmp_path / "square.obj"


@pytest.fixture
def cube(tmp_path: Path) -> Path:
    """cube.obj, of side 2 about the origin, and points.csv: its middle, and (3, 0, 0)."""
    (tmp_path / "cube.obj").write_text(CUBE)
    (tmp_path / "points.csv").write_text("x,y,z\n0,0,0\n3,0,0\n")
    return tmp_path / "cube.obj"


def wait_for_handler(pid: int, number: int) -> None:
    """Until the program catches the signal: on a busy machine its start may take a while."""
    for _ in range(500):
        caught = re.search(r"SigCgt:\s*(\w+)", Path(f"/proc/{pid}/status").read_text())
        if caught and int(caught[1], 16) >> (number - 1) & 1:
            return
        time.sleep(0.01)
