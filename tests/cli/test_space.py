"""littoral sdf, and what it shares with others: values, formats, statuses."""

import json
import math
import os
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import CUBE, PROGRAM, Run, results, wait_for_handler


def test_sdf_writes_volumes_surfaces_and_a_report(run: Run, cube: Path, tmp_path: Path) -> None:
    names = [x for e in ("vti", "npy", "nrrd", "obj", "png") for x in ("-o", "a." + e)]
    result = run("sdf", "cube.obj", "--resolution", 24, "--level", "0,0.2", "--json", *names)
    report = json.loads(result.stdout)
    assert report["method"] == "auto"
    assert report["domain"] == "grid"
    assert report["sizes"]["nodes"] == 24**3
    info = json.loads(run("info", "a.obj", "--json").stdout)
    assert info["components"] == 2
    assert info["boundary_edges"] == 0


def test_confidence_stands_beside_the_distance(run: Run, cube: Path, tmp_path: Path) -> None:
    # A cube without its top: sure at the bottom, less so where the top would be.
    lines = (tmp_path / "cube.obj").read_text().splitlines()
    faces = [line for line in lines if line.startswith("f")]
    corners = [tuple(map(float, line.split()[1:4])) for line in lines if line.startswith("v ")]
    top = max(z for _, _, z in corners)
    low = [
        f for f in faces if any(corners[int(c.split("/")[0]) - 1][2] < top for c in f.split()[1:])
    ]
    assert len(low) < len(faces)
    (tmp_path / "open.obj").write_text("\n".join([x for x in lines if x not in faces] + low))
    middle = [sum(c[k] for c in corners) / len(corners) for k in range(3)]
    bottom = min(z for _, _, z in corners)
    points = [(middle[0], middle[1], top), (middle[0], middle[1], bottom - 0.3 * (top - bottom))]
    (tmp_path / "p.csv").write_text("x,y,z\n" + "\n".join(",".join(map(str, p)) for p in points))
    asked = ["query", "open.obj", "--points", "p.csv", "--confidence"]
    run(*asked, "-o", "a.csv")
    assert (tmp_path / "a.csv").read_text().splitlines()[0] == "x,y,z,distance,confidence"
    gap, below = results(tmp_path / "a.csv")
    assert gap[1] < 0.2
    assert below[1] > 0.6
    run(*asked, "--gradient", "-o", "a.csv")
    assert [row[4] for row in results(tmp_path / "a.csv")] == [gap[1], below[1]]

    sdf = ["sdf", "open.obj", "--resolution", 12, "--confidence"]
    run(*sdf, "-o", "a.vti", "-o", "a.ply")
    text = (tmp_path / "a.vti").read_bytes()
    assert b'Name="confidence"' in text
    assert b"property double confidence" in (tmp_path / "a.ply").read_bytes()
    run("contour", "a.vti", "--field", "confidence", "--level", 0.5, "-o", "b.obj")
    run("sdf", "open.obj", "--resolution", 12, "-o", "c.vti")
    run("contour", "a.vti", "--level", 0, "-o", "b.obj")
    run("contour", "c.vti", "--level", 0, "-o", "c.obj")
    assert (tmp_path / "b.obj").read_bytes() == (tmp_path / "c.obj").read_bytes()
    assert "VTK image data" in run(*sdf, "-o", "a.npy", status=2).stderr
    assert "one mesh" in run(*asked, "--unite", "cube.obj", "-o", "a.csv", status=2).stderr


def test_what_is_doubtful_is_said(run: Run, cube: Path, tmp_path: Path) -> None:
    sheet = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n"
    (tmp_path / "sheet.obj").write_text(sheet)
    result = run("sdf", "sheet.obj", "--resolution", 8, "--json", "-o", "a.npy")
    assert json.loads(result.stdout)["status"] == "uncertain"
    assert "encloses nothing" in result.stderr
    wrong = run("sdf", "cube.obj", "--soft", "10", "-o", "a.npy", status=2)
    assert "may name one that has: signed-heat" in wrong.stderr
    faces = CUBE.splitlines()
    turned = [" ".join(["f", *line.split()[:0:-1]]) for line in faces if line.startswith("f")]
    corners = [line for line in faces if line.startswith("v")]
    right = [line for line in faces if line.startswith("f")]
    (tmp_path / "odd.obj").write_text("\n".join([*corners, *turned[:2], *right[2:]]) + "\n")
    result = run("query", "odd.obj", "--points", "points.csv", "-o", "a.csv")
    assert "orientation of faces disagrees" in result.stderr
    assert [row[0] for row in results(tmp_path / "a.csv")] == pytest.approx([-1, 2])


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
    assert "--estimate-normals computes some" in error
    run("query", "c.xyz", "--points", "q.txt", "--estimate-normals", "-o", "a.csv")
    middle, outside = results(tmp_path / "a.csv")
    assert middle[0] == pytest.approx(-1, abs=0.05)
    assert outside[0] == pytest.approx(1, abs=0.05)


def spiral(n: int, scale: float = 1) -> list[tuple[float, float, float]]:
    """Points spread evenly over the unit sphere."""
    points = []
    for i in range(n):
        z = 1 - 2 * (i + 0.5) / n
        r, a = math.sqrt(1 - z * z), i * 2.399963
        points.append((scale * r * math.cos(a), scale * r * math.sin(a), scale * z))
    return points


@pytest.fixture
def ball(tmp_path: Path) -> Path:
    """ball.xyz, 2000 points with normals on the unit sphere; q.csv: its middle, and (3, 0, 0)."""
    rows = [" ".join(map(str, (*p, *p))) + "\n" for p in spiral(2000)]
    (tmp_path / "ball.xyz").write_text("".join(rows))
    (tmp_path / "q.csv").write_text("x,y,z\n0,0,0\n3,0,0\n")
    return tmp_path / "ball.xyz"


def test_tori_are_fitted_saved_and_asked(run: Run, ball: Path, tmp_path: Path) -> None:
    asked = ["query", "ball.xyz", "--points", "q.csv"]
    run(*asked, "--method", "tori", "--gradient", "-o", "a.csv")
    middle, outside = results(tmp_path / "a.csv")
    assert middle[0] == pytest.approx(-1, abs=1e-3)
    assert outside == pytest.approx([2, 1, 0, 0], abs=1e-2)
    run("fit-tori", "ball.xyz", "-o", "tori.ply")
    run("query", "tori.ply", "--points", "q.csv", "--gradient", "-o", "b.csv")
    assert results(tmp_path / "b.csv")[1] == pytest.approx(outside, abs=1e-9)
    run("query", "tori.ply", "--points", "q.csv", "--flip", "-o", "c.csv")
    assert results(tmp_path / "c.csv")[1][0] == pytest.approx(-outside[0], abs=1e-9)
    report = run(*asked, "--json", "-o", "d.csv").stdout
    assert results(tmp_path / "d.csv")[1][0] == pytest.approx(2, abs=1e-2)
    assert json.loads(report)["method"] == "auto"
    run("fit-tori", "ball.xyz", "-o", "tori.obj", status=2)


def test_tori_fitted_in_other_ways(run: Run, ball: Path, tmp_path: Path) -> None:
    for options in (["--fit", "learned"], ["--single"], ["--drop-outliers"]):
        run("query", "ball.xyz", "--points", "q.csv", "--method", "tori", *options, "-o", "a.csv")
        middle, outside = results(tmp_path / "a.csv")
        assert middle[0] == pytest.approx(-1, abs=2e-3)
        assert outside[0] == pytest.approx(2, abs=1e-2)
    (tmp_path / "w.txt").write_text("littoral-torus-fit 1\n24 8\n0 0 nan")
    ask = ["query", "ball.xyz", "--points", "q.csv", "--method", "tori", "-o", "a.csv"]
    failed = run(*ask, "--fit", "learned", "--weights", "w.txt", status=2)
    assert "w.txt: not the weights of a torus fit: 'nan' is no number" in failed.stderr
    run(*ask, "--weights", "w.txt", status=2)
    run(*ask, "--fit", "learned", "--noisy", status=2)
    run(*ask, "--fit", "learned", "--weights", "missing.txt", status=1)


def test_winding_numbers_in_space(run: Run, cube: Path, ball: Path, tmp_path: Path) -> None:
    for name, slack in (("cube.obj", 1e-9), ("ball.xyz", 1e-2)):
        run("winding", name, "--points", "q.csv", "-o", "w.csv")
        middle, outside = results(tmp_path / "w.csv")
        assert middle[0] == pytest.approx(1, abs=slack)
        assert outside[0] == pytest.approx(0, abs=slack)
    run("winding", "cube.obj", "--points", "q.csv", "--flip", "-o", "w.csv")
    assert results(tmp_path / "w.csv")[0][0] == pytest.approx(-1)
    run("winding", "cube.obj", "--points", "q.csv", "-s", "x.txt", "-o", "w.csv", status=2)


def torn() -> str:
    """The cube as six squares that do not touch: cracks all along its edges."""
    corners = [[float(x) for x in row.split()[1:]] for row in CUBE.splitlines()[:8]]
    rows = []
    for row in CUBE.splitlines()[8:]:
        face = [corners[int(v) - 1] for v in row.split()[1:]]
        middle = [sum(p[a] for p in face) / 4 for a in range(3)]
        for p in face:
            rows.append("v " + " ".join(str(0.97 * p[a] + 0.03 * middle[a]) for a in range(3)))
    faces = ["f " + " ".join(str(4 * f + k + 1) for k in range(4)) for f in range(6)]
    return "\n".join(rows + faces) + "\n"


def clean(run: Run, name: str) -> dict[str, object]:
    """What `littoral info` says of a mesh without a fault."""
    info: dict[str, object] = json.loads(run("info", name, "--json").stdout)
    for fault in (
        "boundary_edges",
        "nonmanifold_edges",
        "nonmanifold_vertices",
        "inconsistently_oriented_edges",
        "degenerate_faces",
        "duplicate_faces",
        "coincident_vertices",
    ):
        assert info[fault] == 0, (name, fault)
    return info


def box_of(run: Run, name: str) -> list[float]:
    box: list[float] = json.loads(run("info", name, "--json").stdout)["bounding_box"]
    return box


@pytest.mark.parametrize("name", ["cube.obj", "torn.obj", "ball.xyz"])
def test_offsets_of_meshes_and_clouds(run: Run, cube: Path, ball: Path, name: str) -> None:
    (cube.parent / "torn.obj").write_text(torn())
    run(
        "offset", name, "--dilate", "0.1,0.4", "--erode", "0.3", "--resolution", 40, "-o", "all.ply"
    )
    assert clean(run, "all.ply")["components"] == 3
    for arguments, size in (
        (("--dilate", "0.4"), 1.4),
        (("--erode", "0.3"), 0.7),
        (("--open", "0.2"), 1),
        (("--close", "0.2"), 1),
    ):
        run("offset", name, *arguments, "--resolution", 40, "-o", "one.obj")
        clean(run, "one.obj")
        assert max(box_of(run, "one.obj")) == pytest.approx(size, abs=0.08)


def test_closing_joins_what_is_near(run: Run, tmp_path: Path) -> None:
    rows = []
    for x in (-1.15, 1.15):
        for p in spiral(1500):
            rows.append(f"{p[0] + x} {p[1]} {p[2]} {p[0]} {p[1]} {p[2]}\n")
    (tmp_path / "two.xyz").write_text("".join(rows))
    run("offset", "two.xyz", "--distance", "0", "--resolution", 80, "-o", "a.ply")
    assert clean(run, "a.ply")["components"] == 2
    run("offset", "two.xyz", "--close", "0.5", "--resolution", 80, "-o", "a.ply")
    assert clean(run, "a.ply")["components"] == 1
    run("offset", "two.xyz", "--method", "tori", "--distance", "0.05", "-o", "a.ply")
    assert clean(run, "a.ply")["components"] == 2


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "no vertices"),
        ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "area"),
        ("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "finite"),
    ],
)
@pytest.mark.parametrize("verb", ["sdf", "offset"])
def test_bad_meshes_are_named(run: Run, tmp_path: Path, verb: str, text: str, words: str) -> None:
    (tmp_path / "bad.obj").write_text(text)
    how = ("--dilate", "0.1") if verb == "offset" else ()
    assert words in run(verb, "bad.obj", *how, "-o", "a.ply", status=2).stderr
    assert not (tmp_path / "a.ply").exists()


@pytest.mark.parametrize(
    ("row", "words"),
    [("{x} {y} {z} 0 0 0", "normal"), ("{x} {y} {z} 0 0 nan", "normal"), ("{x} 0 0 0 0 1", "")],
)
def test_bad_clouds_are_named(run: Run, tmp_path: Path, row: str, words: str) -> None:
    text = "".join(row.format(x=p[0], y=p[1], z=p[2]) + "\n" for p in spiral(50))
    (tmp_path / "bad.xyz").write_text(text)
    if words:
        assert words in run("sdf", "bad.xyz", "-o", "a.ply", status=2).stderr
    else:
        run(
            "sdf", "bad.xyz", "--resolution", 12, "-o", "a.npy"
        )  # a line with normals, says no more


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--resolution", "1"), "--resolution"),
        (("--resolution", "20000"), "too large"),
        (("--resolution", "1200"), "memory"),
        (("--bounds", "5,5,5,6,6,6"), "misses"),
        (("--bounds", "1,2,3"), "--bounds"),
        (("--method", "magic"), "unknown method"),
        (("--method", "signed-heat", "--sharpness", "2"), "no option"),
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
    process = subprocess.Popen(
        command,
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    wait_for_handler(process.pid, signal.SIGINT)
    time.sleep(0.5)
    os.kill(process.pid, signal.SIGINT)
    start = time.monotonic()
    process.wait(timeout=10)
    assert time.monotonic() - start < 1
    assert process.returncode == 130
    assert not list(tmp_path.glob("*.vti"))


def test_winding_numbers_as_a_volume(run: Run, cube: Path, tmp_path: Path) -> None:
    (tmp_path / "points.csv").write_text("x,y,z\n0,0,0\n1,0,0\n1.3,0,0\n3,0,0\n")
    run("winding", cube, "--points", "points.csv", "--smoothing", 0.1, "-o", "a.csv")
    assert [row[0] for row in results(tmp_path / "a.csv")] == pytest.approx(
        [1, 0.5, 0, 0], abs=0.01
    )
    grid = ("--resolution", 24)
    run("sdf", cube, "--field", "winding", *grid, "-o", "w.npy", "-o", "w.obj")
    run("sdf", cube, "--field", "winding", "--smoothing", 0.1, *grid, "-o", "s.obj")
    assert (tmp_path / "w.npy").stat().st_size > 24**3
    # The surface at 1/2 is the cube, and faces outward.
    for name in ("w.obj", "s.obj"):
        result = run("sdf", name, "--method", "closest-point", *grid, "-o", "d.obj", "--json")
        assert result.returncode == 0
        run("query", name, "--points", "points.csv", "-o", "b.csv")
        assert [row[0] for row in results(tmp_path / "b.csv")] == pytest.approx(
            [-1, 0, 0.3, 2], abs=0.1
        )


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--field", "winding", "--domain", "tets"), "field winding"),
        (("--field", "winding", "--method", "signed-heat"), "field winding"),
        (("--field", "winding", "--offset", "1"), "field winding"),
        (("--field", "winding", "--smoothing", "1e-9"), "too small"),
        (("--smoothing", "0.1"), "--field winding"),
    ],
)
def test_what_does_not_go_with_winding(
    run: Run, cube: Path, arguments: tuple[str, ...], words: str
) -> None:
    assert words in run("sdf", "cube.obj", *arguments, "-o", "a.vti", status=2).stderr
