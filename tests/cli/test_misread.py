"""Inputs that look like something else: taken for what they are, or refused with the remedy."""

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest
from conftest import Run
from test_volumes import facts, sphere, write_nrrd

N = 33


def grid() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    x = np.linspace(-1, 1, N)
    at = np.meshgrid(x, x, x, indexing="ij")
    return at[0], at[1], at[2]


def radius() -> np.ndarray:
    x, y, z = grid()
    return np.sqrt(x * x + y * y + z * z)


def write_vol(path: Path, values: np.ndarray) -> None:
    n = values.shape[0]
    head = f"X: {n}\nY: {n}\nZ: {n}\nVoxel-Size: 1\nVersion: 2\n.\n"
    path.write_bytes(head.encode() + values.astype(np.uint8).tobytes(order="F"))


def column(path: Path, name: str) -> list[float]:
    with path.open(newline="") as file:
        lines = list(csv.reader(file))
    return [float(row[lines[0].index(name)]) for row in lines[1:]]


@pytest.fixture
def middle(tmp_path: Path) -> str:
    """q.csv: the middle of the box in nodes, and eight nodes from it."""
    c = (N - 1) / 2
    (tmp_path / "q.csv").write_text(f"x,y,z\n{c},{c},{c}\n{c + 16},{c},{c}\n")
    return "q.csv"


@pytest.mark.parametrize("kind", ["vol", "npy"])
def test_a_mask_is_a_mask(run: Run, tmp_path: Path, middle: str, kind: str) -> None:
    ball = np.where(radius() < 0.6, 128, 0)  # of radius 9.6 nodes
    if kind == "vol":
        write_vol(tmp_path / "m.vol", ball)
    else:
        np.save(tmp_path / "m.npy", ball.astype(np.int16))
    run("query", f"m.{kind}", "--points", middle, "-o", "v.csv")
    inside, outside = column(tmp_path / "v.csv", "distance")
    assert inside == pytest.approx(-9.6, abs=0.6)
    assert outside == pytest.approx(16 - 9.6, abs=0.6)
    run("offset", f"m.{kind}", "--distance", 2, "--resolution", 40, "-o", "o.ply")
    assert facts(run, "o.ply")["bounding_box"][3] == pytest.approx(16 + 11.6, abs=0.7)
    report = run("sdf", f"m.{kind}", "--resolution", 16, "--json", "-o", "s.nrrd").stdout
    assert json.loads(report)["status"] == "converged"


def test_a_mask_that_fills_its_box_is_closed(run: Run, tmp_path: Path) -> None:
    np.save(tmp_path / "full.npy", np.ones((5, 5, 5), np.uint8))
    run("offset", "full.npy", "--as", "mask", "--distance", 0, "-o", "o.ply")
    info = facts(run, "o.ply")
    assert info["boundary_edges"] == 0
    assert info["bounding_box"][0] == pytest.approx(-0.5, abs=0.1)
    np.save(tmp_path / "none.npy", np.zeros((5, 5, 5), np.uint8))
    failed = run("offset", "none.npy", "--as", "mask", "--distance", 0, "-o", "o.ply", status=2)
    assert "nothing is inside" in failed.stderr


@pytest.mark.parametrize(
    "values",
    [
        (radius() ** 2 - 0.36) * 5,  # an implicit function
        np.round(100 * np.exp(-radius())),  # a scan
        radius(),  # without sign
    ],
)
def test_other_values_are_refused_with_the_remedy(
    run: Run, tmp_path: Path, middle: str, values: np.ndarray
) -> None:
    np.save(tmp_path / "f.npy", values)
    for arguments in (("query", "f.npy", "--points", middle), ("offset", "f.npy", "--distance=0")):
        failed = run(*arguments, "-o", "v.csv" if "query" in arguments else "v.ply", status=2)
        for word in ("--as distance", "--as mask", "--as density", "--redistance", "inside"):
            assert word in failed.stderr


def test_density_is_larger_inside(run: Run, tmp_path: Path, middle: str) -> None:
    np.save(tmp_path / "d.npy", np.exp(-radius()))
    how = ("--as", "density", "--threshold", str(math.exp(-0.5)))
    run("query", "d.npy", *how, "--points", middle, "-o", "v.csv")
    inside, outside = column(tmp_path / "v.csv", "distance")
    assert inside == pytest.approx(-8, abs=0.1)
    assert outside == pytest.approx(8, abs=0.1)
    failed = run("query", "d.npy", *how[:3], "9", "--points", middle, "-o", "v.csv", status=2)
    assert "--threshold: no surface at 9" in failed.stderr


def test_distance_is_taken_as_distance(run: Run, tmp_path: Path) -> None:
    write_nrrd(tmp_path / "d.nrrd", 24, sphere)
    (tmp_path / "q.csv").write_text("x,y,z\n0.9,0,0\n")
    run("query", "d.nrrd", "--points", "q.csv", "-o", "v.csv")
    assert column(tmp_path / "v.csv", "distance") == pytest.approx([0.3], abs=0.01)
    write_nrrd(tmp_path / "cut.nrrd", 24, lambda x, y, z: max(-0.2, min(0.2, sphere(x, y, z))))
    run("query", "cut.nrrd", "--points", "q.csv", "-o", "v.csv")


@pytest.mark.parametrize("method", ["signed-heat", "winding", "planar", "hopf-cole"])
def test_what_sdf_writes_is_distance(run: Run, tmp_path: Path, method: str) -> None:
    (tmp_path / "t.obj").write_text(
        "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    )
    run("sdf", "t.obj", "--method", method, "--resolution", 32, "-o", "d.npz")
    run("offset", "d.npz", "--distance", 0, "-o", "o.ply")


def test_columns_of_points_are_found_by_name(run: Run, tmp_path: Path) -> None:
    write_nrrd(tmp_path / "d.nrrd", 24, sphere)
    (tmp_path / "p.csv").write_text('id,z,"x",y,tag\n7,0,0.9,0,a\n8,0.4,0,0,"b, c"\n')
    run("query", "d.nrrd", "--points", "p.csv", "-o", "v.csv", "-o", "v.npy")
    assert column(tmp_path / "v.csv", "distance") == pytest.approx([0.3, -0.2], abs=0.01)
    lines = (tmp_path / "v.csv").read_text().splitlines()
    assert lines[0] == "id,z,x,y,tag,distance"
    assert lines[2].startswith('8,0.4,0,0,"b, c",-0.')
    assert np.load(tmp_path / "v.npy").shape == (2,)
    (tmp_path / "p.csv").write_text("id;x;y;z\n7;0.9;0;0\n")
    run("query", "d.nrrd", "--points", "p.csv", "-o", "v.csv")
    assert column(tmp_path / "v.csv", "distance") == pytest.approx([0.3], abs=0.01)


def test_tables_of_results_have_the_points(run: Run, tmp_path: Path) -> None:
    """Whatever they came from; results that are there already are replaced."""
    write_nrrd(tmp_path / "d.nrrd", 24, sphere)
    points = np.array([[0.9, 0, 0], [0, 0, 0.4]])
    np.save(tmp_path / "p.npy", points)
    (tmp_path / "p.txt").write_text("0.9 0 0\n0 0 0.4\n")
    (tmp_path / "p.obj").write_text("v 0.9 0 0\nv 0 0 0.4\n")
    (tmp_path / "p.csv").write_text("x,y,z\n0.90,0,0\n0,0,4e-1\n")
    for name in ("p.npy", "p.txt", "p.obj", "p.csv"):
        run("query", "d.nrrd", "--points", name, "--gradient", "-o", "v.csv", "-o", "v.npz")
        rows = [line.split(",") for line in (tmp_path / "v.csv").read_text().splitlines()]
        assert rows[0] == ["x", "y", "z", "distance", "gradient_x", "gradient_y", "gradient_z"]
        assert [row[:3] for row in rows[1:]] == [["0.9", "0", "0"], ["0", "0", "0.4"]]
        held = np.load(tmp_path / "v.npz")
        assert held["points"].tolist() == points.tolist()
        assert held["distance"].tolist() == [float(row[3]) for row in rows[1:]]
    run("query", "d.nrrd", "--points", "v.csv", "--offset", 1, "-o", "w.csv")
    rows = [line.split(",") for line in (tmp_path / "w.csv").read_text().splitlines()]
    assert rows[0] == ["x", "y", "z", "gradient_x", "gradient_y", "gradient_z", "distance"]
    assert float(rows[1][-1]) == pytest.approx(-0.7, abs=0.01)
    run("query", "d.nrrd", "--points", "v.npz", "-o", "w.tsv")
    assert (tmp_path / "w.tsv").read_text().startswith("x\ty\tz\tdistance\n")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("7,0.9,0,0\n", "'7,0.9,0,0'"),  # four columns without names
        ("7 0.9 0 0\n", "'7 0.9 0 0'"),
        ("id,a,b,c\n7,0.9,0,0\n", "'id,a,b,c', names no columns x, y and z"),
        ("x,y,z\n1,2,3\n1,2\n", ":3: expected 3 columns as in the first row, found 2"),
        ("x;y;z\n1,5;2;3\n", "'1,5'"),
    ],
)
def test_points_that_cannot_be_told_are_refused(
    run: Run, tmp_path: Path, text: str, words: str
) -> None:
    write_nrrd(tmp_path / "d.nrrd", 8, sphere)
    (tmp_path / "p.csv").write_text(text)
    assert words in run("query", "d.nrrd", "--points", "p.csv", "-o", "v.csv", status=2).stderr


@pytest.mark.parametrize("order", ["C", "F"])
def test_points_from_numpy(run: Run, tmp_path: Path, order: str) -> None:
    write_nrrd(tmp_path / "d.nrrd", 24, sphere)
    points = np.array([[0.9, 0, 0], [0, 0, 0.4]], order=order)  # type: ignore[call-overload]
    np.save(tmp_path / "p.npy", points)
    np.savez(tmp_path / "p.npz", points=points, other=np.zeros((2, 3)))
    np.savez_compressed(tmp_path / "q.npz", points.astype(np.float32))
    for name in ("p.npy", "p.npz", "q.npz"):
        run("query", "d.nrrd", "--points", name, "-o", "v.npy", "-o", "v.npz")
        assert np.load(tmp_path / "v.npy") == pytest.approx([0.3, -0.2], abs=0.01)
        assert np.load(tmp_path / "v.npz")["distance"] == pytest.approx([0.3, -0.2], abs=0.01)
    np.save(tmp_path / "p.npy", np.zeros((3, 2)))
    failed = run("query", "d.nrrd", "--points", "p.npy", "-o", "v.npy", status=2)
    assert "N x 3, this one is 3 x 2" in failed.stderr


def test_archives_keep_the_box(run: Run, tmp_path: Path) -> None:
    write_nrrd(tmp_path / "d.nrrd", 8, sphere)
    run("convert", "d.nrrd", "-o", "d.npz")
    with np.load(tmp_path / "d.npz") as held:
        assert held["origin"] == pytest.approx([-1, -1, -1])
        assert held["spacing"] == pytest.approx([2 / 7] * 3)
        assert held["distance"].shape == (8, 8, 8)
        np.savez_compressed(
            tmp_path / "e.npz", values=held["distance"], origin=[-1, -1, -1], spacing=2 / 7
        )
    for name in ("d.npz", "e.npz"):
        info, expected = facts(run, name), facts(run, "d.nrrd")
        assert info["bounding_box"] == pytest.approx(expected["bounding_box"])
        assert info["values"] == expected["values"]
    np.savez(tmp_path / "bare.npz", values=np.zeros((3, 3, 3)))
    assert "'origin'" in run("info", "bare.npz", status=2).stderr
    whole = (tmp_path / "e.npz").read_bytes()
    for size in (0, 10, len(whole) // 2, len(whole) - 1):
        (tmp_path / "cut.npz").write_bytes(whole[:size])
        run("info", "cut.npz", status=2)


def test_a_volume_without_its_box_is_said(run: Run, tmp_path: Path) -> None:
    np.save(tmp_path / "d.npy", (radius() - 0.6) * 16)
    result = run("offset", "d.npy", "--distance", 0, "-o", "o.ply")
    assert "d.npy holds no origin and spacing" in result.stderr
    assert "no origin" in run("contour", "d.npy", "--level", 0, "-o", "o.ply").stderr
    np.savez(tmp_path / "d.npz", values=radius() - 0.6, origin=-np.ones(3), spacing=1 / 16)
    assert run("offset", "d.npz", "--distance", 0, "-o", "o.ply").stderr == ""


def signed_volume(path: Path) -> float:
    """Of a triangle mesh in an OBJ file, by the divergence theorem."""
    rows = [line.split() for line in path.read_text().splitlines()]
    points = np.array([[float(x) for x in r[1:4]] for r in rows if r[0] == "v"])
    faces = np.array([[int(x) - 1 for x in r[1:4]] for r in rows if r[0] == "f"])
    a, b, c = (points[faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def test_a_shell_is_a_wall(run: Run, tmp_path: Path) -> None:
    write_nrrd(tmp_path / "d.nrrd", 40, sphere)
    wall = 4 / 3 * math.pi * (0.7**3 - 0.5**3)
    for arguments in (("--shell", "0.2"), ("--shell", "10%")):  # the box has the side 2
        run("offset", "d.nrrd", *arguments, "-o", "o.obj")
        assert signed_volume(tmp_path / "o.obj") == pytest.approx(wall, rel=0.02)
        info = facts(run, "o.obj")
        assert info["boundary_edges"] == 0
        assert info["components"] == 2
    run("offset", "d.nrrd", "--distance=-0.1", "--shell", "0.2", "-o", "o.obj")
    inward = 4 / 3 * math.pi * (0.6**3 - 0.4**3)
    assert signed_volume(tmp_path / "o.obj") == pytest.approx(inward, rel=0.02)
    solid = run("offset", "d.nrrd", "--distance=-0.55", "--shell", "0.2", "-o", "o.obj")
    assert "is solid" in solid.stderr
    thin = run("offset", "d.nrrd", "--shell", "0.01", "-o", "o.obj")
    assert "thinner than the spacing" in thin.stderr
    run("offset", "d.nrrd", "--shell", "0", "-o", "o.obj", status=2)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("distnce", "a.obj"), "no verb 'distnce'; did you mean 'distance'?"),
        (("distance", "a.obj", "--tim-scale", "3", "-o", "a.ply"), "did you mean '--time-scale'?"),
        (("info", "a.obj", "--gradient"), "it is one of query"),
        (("sdf", "a.obj", "--domain", "grids", "-o", "a.vti"), "did you mean 'grid'?"),
        (
            (
                "distance",
                "square.obj",
                "--vertex=0",
                "--method=signed-heat",
                "--constraint=zero-sets",
                "-o",
                "a.ply",
            ),
            "did you mean 'zero-set'?",
        ),
        (("help", "querry"), "did you mean 'query'?"),
    ],
)
def test_what_is_misspelt_is_named(
    run: Run, mesh: Path, arguments: tuple[str, ...], words: str
) -> None:
    assert words in run(*arguments, status=2).stderr


def test_files_are_named_in_what_is_wrong_with_them(run: Run, mesh: Path) -> None:
    (mesh.parent / "nan.obj").write_text("v 0 0 0\nv 1 0 nan\nv 0 1 0\nf 1 2 3\n")
    (mesh.parent / "nan.csv").write_text("x,y,z\n0,0,1\n1,nan,1\n")
    for words, said in (
        (("sdf", "nan.obj", "-o", "a.vti"), "nan.obj: vertex 1 has coordinates"),
        (("sdf", "square.obj", "--unite", "nan.obj", "-o", "a.vti"), "nan.obj: vertex 1"),
        (("query", "square.obj", "--points", "nan.csv", "-o", "a.csv"), "nan.csv: point 1"),
        (("winding", "square.obj", "--points", "nan.csv", "-o", "a.csv"), "nan.csv: point 1"),
    ):
        assert said in run(*words, status=2).stderr
    logged = ("distance", "square.obj", "--vertex=0", "-o", "a.csv", "--log", "missing/log")
    assert "there is no folder missing" in run(*logged, status=1).stderr


def test_what_was_meant_is_said(run: Run, mesh: Path) -> None:
    apart = run("offset", "square.obj", "--distance", "2", "%", "-o", "a.ply", status=2).stderr
    assert "write them as one, as in 2%" in apart
    made = run("convert", "square.obj", "-o", "a.vti", status=2).stderr
    assert "littoral sdf makes the one of distance to it" in made


def test_lists_of_vertices(run: Run, mesh: Path) -> None:
    written = []
    for vertices in (
        ("--vertex", 0, 60, 120),
        ("--vertex", "0,60,120"),
        ("--vertex=0,60", "--vertex", 120),
        ("--vertex", 0, "--vertex", 60, "--vertex", 120),
    ):
        run("distance", *vertices, "square.obj", "-o", "a.txt")
        written.append((mesh.parent / "a.txt").read_text())
    assert len(set(written)) == 1
    assert written[0].splitlines()[60] == "0"
    assert (
        "no vertex 121"
        in run("distance", "--vertex", 0, 121, "square.obj", "-o", "a.txt", status=2).stderr
    )


def test_help_of_a_verb(run: Run) -> None:
    assert run("help", "query").stdout == run("query", "--help").stdout
    assert "--gradient" in run("help", "query").stdout


@pytest.mark.parametrize(
    "arguments",
    [
        ("distance", "square.obj", "--vertex=0"),
        ("sdf", "square.obj"),
        ("query", "square.obj", "--points", "square.obj"),
        ("convert", "square.obj"),
        ("view", "square.obj"),
    ],
)
def test_outputs_are_checked_first(run: Run, tmp_path: Path, arguments: tuple[str, ...]) -> None:
    """The input is never read: it is no mesh."""
    (tmp_path / "square.obj").write_text("no mesh\n")
    ending = {"query": "csv", "view": "html"}.get(arguments[0], "ply")
    failed = run(*arguments, "-o", f"missing/a.{ending}", status=1)
    assert f"cannot write missing/a.{ending}: there is no folder missing" in failed.stderr
    (tmp_path / f"folder.{ending}").mkdir()
    assert "irectory" in run(*arguments, "-o", f"folder.{ending}", status=1).stderr
    run(*arguments, "-o", "a.unknown", status=2)
    assert sorted(p.name for p in tmp_path.iterdir()) == [f"folder.{ending}", "square.obj"]
