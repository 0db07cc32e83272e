"""The verb pairs: matrices, rows, statistics and errors."""

import json
from pathlib import Path

import numpy as np
from conftest import Run
from test_winding import octahedron


def test_matrix_and_statistics(run: Run, tmp_path: Path) -> None:
    mesh = octahedron(tmp_path / "o.obj")
    out = tmp_path / "d.npy"
    report = json.loads(run("pairs", mesh, "-o", out, "--json").stdout)
    d = np.load(out)
    assert d.shape == (6, 6)
    assert np.abs(d - d.T).max() < 1e-12 and (np.diag(d) == 0).all()
    over_an_edge = 2**0.5, 6**0.5  # to a neighbour, and over two faces to the other side
    assert np.allclose(np.unique(d.round(9)), [0, *over_an_edge], atol=1e-8)
    names = {entry if isinstance(entry, str) else entry[0] for entry in report["residuals"]}
    assert any("triangle inequality" in name for name in names)
    assert report["method"] == "auto"


def test_the_default_is_exact_and_symmetric_is_asked_for(run: Run, tmp_path: Path) -> None:
    mesh = octahedron(tmp_path / "o.obj")
    out, exact = tmp_path / "d.npy", tmp_path / "exact.npy"
    run("pairs", mesh, "-o", out)
    run("pairs", mesh, "-o", exact, "--method", "exact")
    assert np.abs(np.load(out) - np.load(exact)).max() < 1e-12
    asked = ("--method", "symmetric", "--alpha", "0.05")
    report = json.loads(run("pairs", mesh, "-o", out, *asked, "--json").stdout)
    d = np.load(out)
    assert report["method"] == "symmetric"
    assert (d == d.T).all() and (np.diag(d) == 0).all() and (d >= 0).all()


def test_rows_of_other_methods(run: Run, tmp_path: Path) -> None:
    mesh = octahedron(tmp_path / "o.obj")
    out = tmp_path / "d.csv"
    run("pairs", mesh, "-o", out, "--method", "exact", "--vertex", "4", "--vertex", "0")
    lines = out.read_text().splitlines()
    assert lines[0].startswith("to 0,to 1")
    top = [float(x) for x in lines[1].split(",")]
    assert top[4] == 0 and abs(top[0] - 2**0.5) < 1e-9
    assert abs(top[5] - 6**0.5) < 1e-9  # over two faces


def test_better_triangles_and_point_clouds(run: Run, tmp_path: Path) -> None:
    mesh = octahedron(tmp_path / "o.obj")
    exact, d = tmp_path / "exact.npy", tmp_path / "d.npy"
    run("pairs", mesh, "-o", exact, "--method", "exact", "--vertex", "4")
    for method in ("signed-heat", "unsigned-heat"):
        run("pairs", mesh, "-o", d, "--method", method, "--intrinsic-delaunay", "--vertex", "4")
        assert np.load(d).shape == (1, 6)
        assert np.load(d)[0, 4] == 0
        assert np.abs(np.load(d) - np.load(exact)).max() < 0.3 * np.load(exact).max()
    n = 200
    z = 1 - (2 * np.arange(n) + 1) / n
    r, turn = np.sqrt(1 - z * z), 2.399963 * np.arange(n)
    points = np.column_stack([r * np.cos(turn), r * np.sin(turn), z])
    np.savetxt(tmp_path / "ball.xyz", np.hstack([points, points]))
    run("pairs", "ball.xyz", "-o", d, "--method", "unsigned-heat", "--vertex", "0")
    truth = np.arccos(np.clip(points @ points[0], -1, 1))
    assert np.abs(np.load(d)[0] - truth).mean() < 0.1


def test_what_is_wrong(run: Run, tmp_path: Path) -> None:
    mesh = octahedron(tmp_path / "o.obj")
    for words, says in [
        (["-o", "d.npy", "--method", "nonsense"], "unknown method"),
        (["-o", "d.npy", "--vertex", "6"], "no vertex 6"),
        (["-o", "d.npy", "--method", "symmetric", "--alpha", "-1"], "alpha"),
        (["-o", "d.npy", "--method", "exact", "--alpha", "1"], "no option"),
        (["-o", "d.ply"], "as a table"),
    ]:
        result = run("pairs", mesh, *words, status=2)
        assert says in result.stderr
