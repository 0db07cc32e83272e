"""littoral distance: values, formats, statuses."""

import json
import math
from pathlib import Path

import pytest
from conftest import Run

CURVE = ("distance", "square.obj", "--sources", "curve.txt")


def values(path: Path) -> list[float]:
    return [float(x) for x in path.read_text().split()]


def test_left_is_positive_and_flip_negates(run: Run, mesh: Path, tmp_path: Path) -> None:
    run(*CURVE, "-o", "a.txt")
    run(*CURVE, "--flip", "-o", "b.txt")
    a, b = values(tmp_path / "a.txt"), values(tmp_path / "b.txt")
    assert len(a) == 121
    assert a[0] == pytest.approx(0.5, abs=0.05)
    assert a[10] == pytest.approx(-0.5, abs=0.05)
    assert b == pytest.approx([-x for x in a], abs=1e-9)


def test_formats_agree(run: Run, mesh: Path, tmp_path: Path) -> None:
    run(*CURVE, *(x for e in ("txt", "csv", "ply", "obj", "vtp", "npy") for x in ("-o", "a." + e)))
    expected = values(tmp_path / "a.txt")
    rows = (tmp_path / "a.csv").read_text().splitlines()
    assert rows[0] == "vertex,distance"
    assert [float(x.split(",")[1]) for x in rows[1:]] == expected
    for source in ("ply", "obj"):
        run("convert", "a." + source, "-o", source + ".txt")
        assert values(tmp_path / (source + ".txt")) == expected
    data = (tmp_path / "a.npy").read_bytes()
    assert len(data) % 8 == 0
    assert list(memoryview(data[-8 * 121 :]).cast("d")) == expected
    assert "distance" in (tmp_path / "a.vtp").read_text(errors="replace")


def test_picture(run: Run, mesh: Path, tmp_path: Path) -> None:
    run(*CURVE, "-o", "a.png")
    assert (tmp_path / "a.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


def test_vertex_sources(run: Run, mesh: Path, tmp_path: Path) -> None:
    for method in ("signed-heat", "unsigned-heat"):
        run("distance", mesh, "--vertex", 60, "--method", method, "-o", "a.txt")
        a = values(tmp_path / "a.txt")
        assert a[60] == pytest.approx(0, abs=0.05)
        assert a[55] == pytest.approx(0.5, abs=0.1)
    run("distance", mesh, "--vertex", 61, "--index-base", 1, "--method", method, "-o", "b.txt")
    assert values(tmp_path / "b.txt") == a


def test_boundary_is_a_source(run: Run, mesh: Path, tmp_path: Path) -> None:
    for method in ("exact", "fast-marching", "regularized", "signed-heat"):
        run("distance", mesh, "--boundary", "--method", method, "-o", "a.txt", "-o", "a.png")
        a = values(tmp_path / "a.txt")
        assert a[60] == pytest.approx(0.5, abs=0.08)  # the middle of the unit square
        assert max(abs(a[i]) for i in range(11)) == pytest.approx(0, abs=0.06)
    run("distance", mesh, "--boundary", "--vertex", 60, "--method", "exact", "-o", "b.txt")
    b = values(tmp_path / "b.txt")
    assert b[60] == 0 and max(b) < 0.3


def test_quadratic_elements(run: Run, mesh: Path, tmp_path: Path) -> None:
    words = ("distance", mesh, "--vertex", 0, "--method", "regularized", "--elements", "quadratic")
    run(*words, "--subdivide", 2, "-o", "a.ply")
    assert b"element vertex 441" in (tmp_path / "a.ply").read_bytes()
    result = run(*words, "--regularizer", "hessian", "-o", "a.ply", status=2)
    assert "Dirichlet" in result.stderr


def test_quadratic_order_with_sign(run: Run, mesh: Path, tmp_path: Path) -> None:
    exact = [0.5 - i / 10 for _ in range(11) for i in range(11)]
    run(*CURVE, "--method", "quadratic", "--signed", "-o", "a.txt")
    assert values(tmp_path / "a.txt") == pytest.approx(exact, abs=1e-3)
    heat = ("--method", "signed-heat")
    run(*CURVE, *heat, "--sharpen", "quadratic", "-o", "b.txt")
    assert values(tmp_path / "b.txt") == pytest.approx(exact, abs=1e-3)
    # Alone, and before a name that is no word of it.
    run("distance", *heat, "--sharpen", *CURVE[1:], "-o", "c.txt")
    assert values(tmp_path / "c.txt") == pytest.approx(exact, abs=2e-2)
    run(*CURVE, *heat, "--sharpen=nonsense", status=2)


def test_lines_of_the_mesh_are_sources(run: Run, mesh: Path, tmp_path: Path) -> None:
    line = "l " + " ".join(str(6 + 11 * j) for j in range(11)) + "\n"
    (tmp_path / "lines.obj").write_text(mesh.read_text() + line)
    run("distance", "lines.obj", "-o", "a.txt")
    run(*CURVE, "-o", "b.txt")
    assert values(tmp_path / "a.txt") == values(tmp_path / "b.txt")


def test_json_report(run: Run, mesh: Path) -> None:
    report = json.loads(run(*CURVE, "--method", "signed-heat", "--json", "-o", "a.txt").stdout)
    assert report["method"] == "signed-heat"
    assert report["options"]["constraint"] == "zero-set"
    assert report["options"]["time-scale"] > 0
    assert report["sizes"]["faces"] == 200
    assert 0 < report["sizes"]["factor_mb"] < report["peak_memory_mb"]
    assert report["sizes"]["source_pieces"] == 10
    assert report["timings"]["factor"] >= 0
    assert report["warnings"] == []
    assert report["unreachable_components"] == []


def test_the_default_says_what_it_chose(run: Run, mesh: Path) -> None:
    report = json.loads(run(*CURVE, "--json", "-o", "a.txt").stdout)
    assert report["method"] == "auto"
    chosen = {"completion": "none", "metric": "exact", "confidence": False, "tolerance": 0}
    assert report["options"] == chosen
    assert report["sizes"]["curve_ends"] == 0
    assert report["status"] == "converged"


def test_confidence_stands_beside_the_distance(run: Run, mesh: Path, tmp_path: Path) -> None:
    run(*CURVE, "--confidence", "-o", "a.ply")
    header = (tmp_path / "a.ply").read_bytes().split(b"end_header")[0].decode()
    assert "distance" in header
    assert "confidence" in header
    columns = []
    for name in ("distance", "confidence"):
        run("convert", "a.ply", "--field", name, "-o", "one.txt")
        columns.append(values(tmp_path / "one.txt"))
    table = list(zip(*columns, strict=True))
    assert all(0 <= sure <= 1 for sure in columns[1])
    run(*CURVE, "--confidence", "-o", "a.csv", "-o", "a.txt", "-o", "a.npy", "-o", "a.vtp")
    head, *rows = (tmp_path / "a.csv").read_text().split()
    assert head == "vertex,distance,confidence"
    assert [tuple(map(float, row.split(",")[1:])) for row in rows] == table
    lines = (tmp_path / "a.txt").read_text().splitlines()
    assert [tuple(map(float, line.split())) for line in lines] == table
    data = (tmp_path / "a.npy").read_bytes()
    assert b"'fortran_order': True, 'shape': (121, 2)" in data
    assert list(memoryview(data[-16 * 121 :]).cast("d")) == columns[0] + columns[1]
    assert b'Name="confidence"' in (tmp_path / "a.vtp").read_bytes()
    said = run(*CURVE, "--confidence", "-o", "a.obj", status=2).stderr
    assert "a.obj holds one number per vertex: confidence is written to .ply" in said
    run(*CURVE, "--confidence=off", "-o", "a.obj")


def test_clouds_are_measured_exactly_and_have_confidence(
    run: Run, mesh: Path, tmp_path: Path
) -> None:
    lines = [line.split() for line in mesh.read_text().splitlines() if line[0] == "v"]
    (tmp_path / "c.xyz").write_text("".join(f"{x} {y} {z} 0 0 1\n" for _, x, y, z in lines))
    cloud = ("distance", "c.xyz", "--sources", "curve.txt", "--confidence")
    run(*cloud, "-o", "a.txt")
    for (_, x, _, _), distance in zip(lines, values(tmp_path / "a.txt")[::2], strict=True):
        assert abs(distance - (0.5 - float(x))) < 1e-9
    run(*cloud, "-o", "a.ply")
    assert b"property double confidence" in (tmp_path / "a.ply").read_bytes()


def test_options_of_other_methods_name_these(run: Run, mesh: Path) -> None:
    said = run(*CURVE, "--constraint", "none", "-o", "a.txt", status=2).stderr
    assert "signed-heat" in said
    run(*CURVE, "--method", "signed-heat", "--constraint", "none", "-o", "a.txt")


def test_threads_do_not_matter(run: Run, mesh: Path, tmp_path: Path) -> None:
    run(*CURVE, "--threads", 1, "-o", "a.txt")
    run(*CURVE, "--threads", 2, "-o", "b.txt")
    assert (tmp_path / "a.txt").read_bytes() == (tmp_path / "b.txt").read_bytes()


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("--sources", "curve.txt", "--method", "magic"), "unknown method 'magic'"),
        (("--sources", "curve.txt", "--wrong"), "--wrong"),
        (("--sources", "curve.txt", "--metric", "x"), "fast-marching"),
        (("--sources", "curve.txt", "--method", "signed-heat", "--time-scale", "x"), "time-scale"),
        (("--sources", "curve.txt", "--method", "signed-heat", "--constraint", "some"), "zero-set"),
        (("--vertex", 0, "--method", "unsigned-heat", "--soft", 1), "no option 'soft'"),
        (("--sources", "missing.txt"), "missing.txt"),
        (("--vertex", 121), "there is no vertex 121"),
        ((), "--vertex"),
    ],
)
def test_bad_usage(
    run: Run, mesh: Path, tmp_path: Path, arguments: tuple[object, ...], says: str
) -> None:
    assert says in run("distance", mesh, *arguments, "-o", "a.txt", status=2).stderr
    assert not (tmp_path / "a.txt").exists()


def test_missing_mesh_and_unknown_extensions(run: Run, mesh: Path) -> None:
    assert "nothing.obj" in run("distance", "nothing.obj", "-o", "a.txt", status=2).stderr
    for name in ("a.off", "a.xyz", "a"):
        assert "extension" in run(*CURVE, "-o", name, status=2).stderr
    run("distance", mesh, status=2)
    run(status=2)


def test_unwritable_output(run: Run, mesh: Path) -> None:
    assert "nowhere" in run(*CURVE, "-o", "nowhere/a.txt", status=1).stderr


def test_failed_write_keeps_the_old_file(run: Run, mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    run("distance", mesh, "--vertex", 500, "-o", "a.txt", status=2)
    assert (tmp_path / "a.txt").read_text() == "old"
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.txt", "curve.txt", "square.obj"]


def test_help_shows_ranges_and_defaults(run: Run) -> None:
    text = run("distance", "--help-all").stdout
    for word in ("--time-scale", "default zero-set", "multiple of h^2", "--preserve-normals"):
        assert word in text
    assert run("--version").stdout.startswith("littoral ")
    assert "render" in run("--help").stdout


def test_tables_of_distance_that_jumps_have_the_inputs_vertices(
    run: Run, mesh: Path, tmp_path: Path
) -> None:
    # Half of the curve turned round: the distance jumps, and meshes are split there.
    lines = ["signed_curve", *(f"v {5 + 11 * j}" for j in range(6))]
    lines += ["signed_curve", *(f"v {5 + 11 * j}" for j in range(10, 4, -1))]
    (tmp_path / "two.txt").write_text("\n".join(lines) + "\n")
    words = ("distance", mesh, "--sources", "two.txt", "--method", "signed-heat", "--discontinuous")
    files = ("a.csv", "a.txt", "a.npy", "a.ply")
    run(*words, *(word for file in files for word in ("-o", file)))
    # Up to three steps left of the curve's ends the distance is that to its left.
    found = values(tmp_path / "a.txt")
    assert len(found) == 121
    assert len((tmp_path / "a.csv").read_text().splitlines()) == 122
    assert found[3] == pytest.approx(0.2, abs=0.05)
    assert found[3 + 110] == pytest.approx(-0.2, abs=0.05)
    assert b"element vertex 121" not in (tmp_path / "a.ply").read_bytes()
    level = (*words, "--constraint", "level-sets", "-o", "b.txt")
    assert "constraint" in run(*level, status=2).stderr


def test_distance_is_counted_from_values_of_sources(run: Run, mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "s.txt").write_text(
        "unsigned_point value 0.2\nv 0\nunsigned_point\nv 120\n"
        "unsigned_curve value 0.5\nv 10\nv 21\n"
    )
    run("distance", mesh, "--sources", "s.txt", "-o", "a.txt")
    (tmp_path / "s.json").write_text(
        '{"points": [{"v": 0, "value": 0.2}, {"v": 120}],'
        ' "curves": [{"signed": false, "value": 0.5, "nodes": [{"v": 10}, {"v": 21}]}]}'
    )
    run("distance", mesh, "--sources", "s.json", "-o", "b.txt")
    a = values(tmp_path / "a.txt")
    assert a == values(tmp_path / "b.txt")
    for v, found in enumerate(a):
        x, y = v % 11 / 10, v // 11 / 10
        line = math.hypot(1 - x, max(0.0, y - 0.1))
        expected = min(0.2 + math.hypot(x, y), math.hypot(1 - x, 1 - y), 0.5 + line)
        assert found == pytest.approx(expected, abs=1e-12)
    quadratic = ("distance", mesh, "--sources", "s.txt", "--method", "quadratic", "-o", "c.txt")
    assert "sources of one value" in run(*quadratic, status=2).stderr
    (tmp_path / "shadowed.txt").write_text("unsigned_point\nv 0\nunsigned_point value 2\nv 5\n")
    told = run("distance", mesh, "--sources", "shadowed.txt", "-o", "d.txt").stderr
    assert "point source 2 has a value 1.5 above" in told
