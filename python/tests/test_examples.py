"""The programs in examples/python run."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import littoral

EXAMPLES = Path(__file__).parents[2] / "examples"


def run(name: str, *arguments: str | Path) -> str:
    command = [sys.executable, EXAMPLES / "python" / name, *arguments]
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


SPOT = EXAMPLES / "data/spot.obj"
JERSEY = EXAMPLES / "data/spot-jersey.txt"


def test_curve_offsets():
    said = run("curve_offsets.py", SPOT, JERSEY, "-0.1", "0.1")
    assert "at distance -0.1: " in said and "sure at" in said


def test_samples_are_sure_and_lie_where_they_say(tmp_path):
    mesh = littoral.read(SPOT)
    mesh.save(tmp_path / "whole.obj")
    middle = mesh.points[mesh.faces].mean(axis=1)
    holed = mesh.faces[np.linalg.norm(middle - [0, 0.3, 0.3], axis=1) > 0.25]
    littoral.Mesh(mesh.points, holed).save(tmp_path / "holed.obj")
    for name, count in ("whole", 1000), ("holed", 1000):
        run("samples.py", tmp_path / f"{name}.obj", str(count), tmp_path / "samples.npz")
        samples = np.load(tmp_path / "samples.npz")
        assert 0.8 * count < len(samples["sdf"]) <= count
        assert 0.2 < (samples["sdf"] < 0).mean() < 0.8
        at = samples["centre"] + samples["half_side"] * samples["points"]
        truth = littoral.SDF(mesh)(at) / samples["half_side"]
        assert (samples["sdf"] * truth < 0).mean() < (0.01 if name == "holed" else 1e-9)


def test_a_printable_shell_of_a_broken_scan(tmp_path):
    mesh = littoral.read(SPOT)
    middle = mesh.points[mesh.faces].mean(axis=1)
    left = mesh.faces[np.linalg.norm(middle - [0, 0.3, 0.3], axis=1) > 0.25]
    littoral.Mesh(mesh.points, left).save(tmp_path / "scan.obj")
    said = run("print_shell.py", tmp_path / "scan.obj", "0.04", tmp_path / "shell.stl")
    assert "closed: True" in said and " 0 free edges" not in said
    shell = littoral.read(tmp_path / "shell.stl")
    assert np.median(littoral.SDF(mesh)(shell.points)) == pytest.approx(0.04, abs=0.004)


def test_a_lasso(tmp_path):
    said = run("lasso.py", SPOT, JERSEY, tmp_path / "part.obj")
    part = littoral.read(tmp_path / "part.obj")
    assert 1000 < part.n_faces < 4000 and "0 curves bound nothing" in said


def test_courses_of_knitting():
    said = run("knitting.py", SPOT, "306", "5")
    lengths = [float(line.split()[-2]) for line in said.splitlines()]
    assert len(lengths) == 5 and min(lengths) > 0.1


def test_clearance(tmp_path):
    ball = littoral.examples.sphere(2)
    ball.save(tmp_path / "one.obj")
    littoral.Mesh(ball.points + np.array([2.5, 0, 0]), ball.faces).save(tmp_path / "apart.obj")
    littoral.Mesh(ball.points + np.array([1.5, 0, 0]), ball.faces).save(tmp_path / "into.obj")
    said = run("clearance.py", tmp_path / "one.obj", tmp_path / "apart.obj")
    assert said.startswith("clearance") and float(said.split()[1][:-1]) == pytest.approx(
        0.5, abs=0.03
    )
    said = run("clearance.py", tmp_path / "one.obj", tmp_path / "into.obj")
    assert said.startswith("overlap") and float(said.split()[1][:-1]) == pytest.approx(
        0.5, abs=0.05
    )


def test_crossed_bars_overlap_though_no_vertex_is_inside(tmp_path):
    cube = littoral.examples.cube()
    middle = (cube.points.min(axis=0) + cube.points.max(axis=0)) / 2
    for name, size in ("along.obj", (4.0, 1.0, 1.0)), ("across.obj", (1.0, 4.0, 1.0)):
        littoral.Mesh((cube.points - middle) * size, cube.faces).save(tmp_path / name)
    said = run("clearance.py", tmp_path / "along.obj", tmp_path / "across.obj")
    side = float(np.ptp(cube.points, axis=0)[0])
    assert said.startswith("overlap")
    assert float(said.split()[1][:-1]) == pytest.approx(0.5 * side, abs=0.05 * side)


@pytest.mark.slow
def test_clusters_of_a_figure_are_its_limbs(tmp_path):
    run("figure.py", tmp_path / "figure.ply")
    figure = littoral.read(tmp_path / "figure.ply")
    said = run("clusters.py", tmp_path / "figure.ply", "6", tmp_path / "labels.npy")
    labels = np.load(tmp_path / "labels.npy")
    assert set(labels) == set(range(6)) and "farthest" in said
    x, _, z = figure.points.T
    hands = [int(x.argmin()), int(x.argmax())]
    feet = [int(np.where(side * x > 0, z, np.inf).argmin()) for side in (-1, 1)]
    ends = [*hands, *feet, int(z.argmax())]
    assert len({int(labels[v]) for v in ends}) == 5


def test_the_cut_locus_of_a_torus_lies_across_from_the_source(tmp_path):
    u, v = np.meshgrid(np.arange(60), np.arange(30), indexing="ij")
    a, b = 2 * np.pi * u / 60, 2 * np.pi * v / 30
    r = 1 + 0.4 * np.cos(b)
    points = np.stack([r * np.cos(a), r * np.sin(a), 0.4 * np.sin(b)], -1).reshape(-1, 3)
    i, right = u * 30 + v, (u + 1) % 60 * 30 + v
    up, both = u * 30 + (v + 1) % 30, (u + 1) % 60 * 30 + (v + 1) % 30
    corners = [np.stack(t, -1).reshape(-1, 3) for t in ((i, right, both), (i, both, up))]
    littoral.Mesh(points, np.concatenate(corners)).save(tmp_path / "torus.obj")
    run("cut_locus.py", tmp_path / "torus.obj", "0", tmp_path / "ridge.ply")
    ridge = littoral.read(tmp_path / "ridge.ply").points
    # the source is at angle 0 outside: the ridge is at angle pi, or on the inner circle
    opposite = ridge[:, 0] < -0.5
    inner = np.hypot(ridge[:, 0], ridge[:, 1]) < 0.75
    assert opposite.any() and inner.any() and (opposite | inner).mean() > 0.9


def test_thickness_of_a_plate(tmp_path):
    size = np.array([6, 6, 4])  # cells, six tets each
    at = np.stack(np.meshgrid(*(np.arange(n + 1) for n in size), indexing="ij"), -1).reshape(-1, 3)
    steps = np.array([(size[1] + 1) * (size[2] + 1), size[2] + 1, 1])
    first = (at[(at < size).all(axis=1)] * steps).sum(axis=1)
    tets = [
        np.stack([first, first + a, first + a + b, first + steps.sum()], -1)
        for a in steps
        for b in steps
        if a != b
    ]
    rows = ["4 " + " ".join(map(str, tet)) for tet in np.concatenate(tets)]
    lines = [f"{len(at)} {len(rows)}", *(f"{x} {y} {0.25 * z}" for x, y, z in at), *rows]
    (tmp_path / "plate.tet").write_text("\n".join(lines) + "\n")
    run("thickness.py", tmp_path / "plate.tet", tmp_path / "thickness.npy")
    thickness = np.load(tmp_path / "thickness.npy")
    assert thickness.max() == pytest.approx(1, abs=0.1)
    middle = (abs(at[:, :2] - size[:2] / 2) <= 1).all(axis=1)  # away from the rim, also outside
    assert thickness[middle & (at[:, 2] > 0) & (at[:, 2] < size[2])] == pytest.approx(1, abs=0.1)
