"""The verb winding: labels, curves, formats and errors."""

import json
from pathlib import Path

from conftest import Run


def octahedron(path: Path) -> Path:
    """An octahedron whose equator runs along edges."""
    points = [(1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
    lines = [f"v {x} {y} {z}" for x, y, z in points]
    for i in range(4):
        j = (i + 1) % 4
        lines += [f"f {i + 1} {j + 1} 5", f"f {j + 1} {i + 1} 6"]
    path.write_text("\n".join(lines) + "\n")
    return path


def equator(path: Path, nodes: str = "v 0\nv 1\nv 2\nv 3\nv 0\n") -> Path:
    path.write_text("signed_curve\n" + nodes)
    return path


def test_labels_and_curves(run: Run, tmp_path: Path) -> None:
    mesh, curve = octahedron(tmp_path / "o.obj"), equator(tmp_path / "c.txt")
    out = [tmp_path / f"w{end}" for end in (".txt", ".csv", ".npy", ".ply", ".obj", ".png")]
    flags = [word for path in out for word in ("-o", str(path))]
    curves = tmp_path / "curves.obj"
    result = run("winding", mesh, "-s", curve, *flags, "--curves", curves, "--json")
    labels = [int(line) for line in out[0].read_text().split()]
    assert sorted(abs(label) for label in labels) == [0] * 4 + [1] * 4
    assert labels[0::2] == [labels[0]] * 4 and labels[1::2] == [labels[1]] * 4
    assert labels[0] - labels[1] == 1
    assert out[1].read_text().splitlines()[0] == "face,region"
    assert "\nvt " in out[4].read_text()
    text = curves.read_text()
    assert text.index("o bounding") < text.index("o nonbounding") < text.index("o completed")
    report = json.loads(result.stdout)
    assert report["method"] == "surface-winding"
    assert abs(report["sizes"]["bounding_length"] - 4 * 2**0.5) < 1e-12


def test_variants(run: Run, tmp_path: Path) -> None:
    mesh, curve = octahedron(tmp_path / "o.obj"), equator(tmp_path / "c.txt")
    out = tmp_path / "w.txt"
    labels = []
    for flags in (
        ("--boundary-condition", "free"),
        ("--residual", "paths"),
        ("--formulation", "dual"),
        ("--formulation", "nonconforming"),
    ):
        run("winding", mesh, "-s", curve, "-o", out, *flags)
        labels.append(out.read_text())
    assert labels == [labels[0]] * 4


def test_bad_requests(run: Run, tmp_path: Path) -> None:
    mesh, curve = octahedron(tmp_path / "o.obj"), equator(tmp_path / "c.txt")
    assert "--sources" in run("winding", mesh, "-o", "w.txt", status=2).stderr
    wrong = run("winding", mesh, "-s", curve, "-o", "w.txt", "--labels", "none", status=2)
    assert "labels" in wrong.stderr
    cut = run(
        *("winding", mesh, "-s", curve, "-o", "w.txt"),
        *("--formulation", "nonconforming", "--labels", "cut"),
        status=2,
    )
    assert "formulation primal" in cut.stderr
    point = tmp_path / "p.txt"
    point.write_text("unsigned_point\nv 0\n")
    assert "signed" in run("winding", mesh, "-s", point, "-o", "w.txt", status=2).stderr
