"""Volumes: littoral contour, offset, convert, info, view and render of grids of values."""

import json
import math
import os
import shutil
import signal
import struct
import subprocess
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import PROGRAM, Run


def write_nrrd(path: Path, n: int, function: Callable[[float, float, float], float]) -> None:
    """Values at n^3 nodes of [-1, 1]^3."""
    at = [2 * i / (n - 1) - 1 for i in range(n)]
    values = [function(x, y, z) for z in at for y in at for x in at]
    h = 2 / (n - 1)
    path.write_bytes(
        f"NRRD0004\ntype: double\ndimension: 3\nsizes: {n} {n} {n}\nspacings: {h} {h} {h}\n"
        "space origin: (-1,-1,-1)\nendian: little\nencoding: raw\n\n".encode()
        + struct.pack(f"<{len(values)}d", *values)
    )


def sphere(x: float, y: float, z: float) -> float:
    return math.hypot(x, y, z) - 0.6


@pytest.fixture
def ball(tmp_path: Path) -> str:
    write_nrrd(tmp_path / "ball.nrrd", 24, sphere)
    return "ball.nrrd"


def facts(run: Run, file: str) -> dict[str, Any]:
    result: dict[str, Any] = json.loads(run("info", file, "--json").stdout)
    return result


def expect_clean(info: dict[str, Any]) -> None:
    for key in (
        "boundary_edges",
        "nonmanifold_edges",
        "nonmanifold_vertices",
        "degenerate_faces",
        "duplicate_faces",
        "coincident_vertices",
        "inconsistently_oriented_edges",
    ):
        assert info[key] == 0, key


def test_info_and_convert(run: Run, ball: str, tmp_path: Path) -> None:
    info = facts(run, ball)
    assert info["nodes_along_axes"] == [24, 24, 24]
    assert info["bounding_box"] == [
        -1,
        -1,
        -1,
        pytest.approx(1),
        pytest.approx(1),
        pytest.approx(1),
    ]
    run("convert", ball, "-o", "a.vti")
    run("convert", "a.vti", "-o", "a.npy")
    assert facts(run, "a.vti")["values"] == info["values"]
    assert facts(run, "a.npy")["spacing"] == [1, 1, 1]
    run("convert", ball, "-o", "a.ply", status=2)
    run("convert", ball, "--band", 3, "-o", "b.vti", status=2)
    run("convert", ball, "--field", "nothing", "-o", "b.vti", status=2)
    assert not (tmp_path / "b.vti").exists()


def test_contour(run: Run, ball: str) -> None:
    for extension in ("obj", "ply", "off", "stl"):
        run("contour", ball, "--level", 0, "-o", f"a.{extension}")
        info = facts(run, f"a.{extension}")
        expect_clean(info)
        assert info["euler_characteristic"] == 2
    run("contour", ball, "--level=-0.2,0.1", "-o", "two.ply")
    assert facts(run, "two.ply")["components"] == 2
    run("contour", ball, "--level=-0.2,0.1", "-o", "in.ply", "-o", "out.ply")
    assert facts(run, "in.ply")["bounding_box"][3] == pytest.approx(0.4, abs=0.01)
    assert facts(run, "out.ply")["bounding_box"][3] == pytest.approx(0.7, abs=0.01)


def test_contour_at_the_box(run: Run, ball: str) -> None:
    result = run("contour", ball, "--level", "0.7", "-o", "open.ply")
    assert "meets the boundary" in result.stderr
    assert facts(run, "open.ply")["boundary_edges"] > 0
    assert run("contour", ball, "--level", "0.7", "--clip", "-o", "closed.ply").stderr == ""
    expect_clean(facts(run, "closed.ply"))


def test_contour_refuses(run: Run, ball: str, tmp_path: Path) -> None:
    run("contour", ball, "--level", 9, "-o", "x.obj", status=2)
    run("contour", ball, "--level", 0, "-o", "x.vti", status=2)
    run("contour", ball, "--level", "0,0.1,0.2", "-o", "x.obj", "-o", "y.obj", status=2)
    write_nrrd(tmp_path / "nan.nrrd", 4, lambda x, y, z: float("nan") if x > 0 else z)
    assert (
        "node (2, 0, 0) is nan"
        in run("contour", "nan.nrrd", "--level", 0, "-o", "x.obj", status=2).stderr
    )
    (tmp_path / "bad.vti").write_text("<VTKFile type='ImageData'>")
    run("contour", "bad.vti", "--level", 0, "-o", "x.obj", status=2)
    (tmp_path / "folder").mkdir()
    run("contour", ball, "--level", 0, "-o", "folder/missing/x.obj", status=1)
    assert [p.name for p in tmp_path.iterdir() if p.name.startswith((".", "x", "y"))] == []


def test_a_full_disk_leaves_nothing(ball: str, tmp_path: Path) -> None:
    # A limit on the size of files stands for a full disk.
    result = subprocess.run(
        ["sh", "-c", f"ulimit -f 8; trap '' XFSZ; exec {PROGRAM} convert {ball} -o full.vti"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert result.returncode == 1, result.stderr
    assert "cannot write full.vti" in result.stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == [ball]


@pytest.mark.skipif(os.geteuid() == 0, reason="nothing is read-only to root")
def test_a_read_only_folder_is_refused(run: Run, ball: str, tmp_path: Path) -> None:
    (tmp_path / "sealed").mkdir(mode=0o555)
    run("contour", ball, "--level", 0, "-o", "sealed/x.obj", status=1)


def test_offset_of_a_volume(run: Run, ball: str) -> None:
    run("offset", ball, "--distance", "0,0.2", "--erode", "0.1", "-o", "shells.ply")
    info = facts(run, "shells.ply")
    expect_clean(info)
    assert info["components"] == 3
    report = json.loads(run("offset", ball, "--open", "0.2", "--json", "-o", "open.ply").stdout)
    assert dict(report["timings"]) is not None
    box = facts(run, "open.ply")["bounding_box"]
    assert box[3] == pytest.approx(0.6, abs=0.01)
    run("offset", ball, "-o", "x.ply", status=2)
    run("offset", ball, "--open", "0.9", "-o", "x.ply", status=2)
    run("offset", ball, "--dilate=-1", "-o", "x.ply", status=2)


def test_offset_of_a_curve(run: Run, mesh: Path) -> None:
    run("offset", "square.obj", "-s", "curve.txt", "--distance", "0.2,-0.1", "-o", "lines.obj")
    rows = (mesh.parent / "lines.obj").read_text().splitlines()
    x = {round(float(r.split()[1]), 2) for r in rows if r[:2] == "v "}
    assert x == {0.3, 0.6}
    run("offset", "square.obj", "-s", "curve.txt", "--close", "0.15", "-o", "closed.ply")
    assert facts(run, "closed.ply")["bounding_box"][0] == pytest.approx(0.5, abs=0.01)
    run("offset", "square.obj", "-s", "curve.txt", "--distance", 5, "-o", "x.obj", status=2)
    run("offset", "square.obj", "-s", "curve.txt", "--open", 5, "-o", "x.obj", status=2)


def test_view_and_render(run: Run, ball: str, tmp_path: Path) -> None:
    options = ("--axis", "x", "--slice", "0.2", "--level", "0.1", "--isolines", 12)
    run("render", ball, *options, "--width", 120, "--height", 90, "-o", "a.png")
    assert (tmp_path / "a.png").read_bytes()[16:24] == b"\0\0\0\x78\0\0\0\x5a"
    run("view", ball, *options, "-o", "a.html")
    assert '"volume"' in (tmp_path / "a.html").read_text()
    run("render", ball, "--slice", 7, "-o", "b.png", status=2)
    run("render", ball, "--axis", "w", "-o", "b.png", status=2)
    run("render", ball, "--sources", "curve.txt", "-o", "b.png", status=2)


@pytest.mark.parametrize("delay", [0.02, 0.3])
def test_interrupt(run: Run, ball: str, tmp_path: Path, delay: float) -> None:
    """Ctrl-C at any stage ends the program at once and leaves nothing half-written."""
    n = 96
    (tmp_path / "noise.nrrd").write_bytes(
        f"NRRD0004\ntype: uint8\ndimension: 3\nsizes: {n} {n} {n}\nencoding: raw\n\n".encode()
        + os.urandom(n**3)
    )
    process = subprocess.Popen(
        [PROGRAM, "contour", "noise.nrrd", "--level", "128.5", "-o", "x.obj"], cwd=tmp_path
    )
    time.sleep(delay)
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=30) in (130, -signal.SIGINT)
    assert sorted(p.name for p in tmp_path.iterdir()) == [ball, "noise.nrrd"]


def test_vdb_without_its_module_is_a_clear_error(ball: str, tmp_path: Path) -> None:
    program = shutil.which(PROGRAM)
    assert program is not None
    alone = tmp_path / "alone" / "bin" / "littoral"
    alone.parent.mkdir(parents=True)
    shutil.copy(program, alone)
    words = [str(alone), "convert", str(tmp_path / ball), "-o", str(tmp_path / "ball.vdb")]
    result = subprocess.run(words, capture_output=True, text=True, timeout=60)
    if result.returncode == 0:
        pytest.skip("the module is installed where the program looks last")
    assert result.returncode == 2
    assert "littoral_vdb.so" in result.stderr
    assert not (tmp_path / "ball.vdb").exists()
