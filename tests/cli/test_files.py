"""littoral info, convert, contour, methods, view and render."""

import json
import re
import subprocess
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any

import pytest
from conftest import PROGRAM, Run, square
from test_reports import SCHEMA, check


def facts(run: Run, file: str, *options: str) -> dict[str, Any]:
    result: dict[str, Any] = json.loads(run("info", file, *options, "--json").stdout)
    check(result, json.loads((SCHEMA.parent / "info.schema.json").read_text()))
    return result


def test_info_on_a_square(run: Run, mesh: Path) -> None:
    info = facts(run, "square.obj")
    assert (info["vertices"], info["faces"], info["edges"]) == (121, 200, 320)
    assert info["faces_by_corners"] == {"3": [200]}
    assert (info["boundary_loops"], info["boundary_edges"]) == (1, 40)
    assert (info["euler_characteristic"], info["components"]) == (1, 1)
    assert info["orientable"] is True
    assert info["bounding_box"] == [0, 0, 0, 1, 1, 0]
    assert abs(info["smallest_angle"] - 45) < 1e-9
    for key in ("nonmanifold_edges", "nonmanifold_vertices", "degenerate_faces"):
        assert info[key] == 0
    assert "boundary edges: 40\n" in run("info", "square.obj").stdout


def test_info_on_broken_meshes(run: Run, tmp_path: Path) -> None:
    base = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nv 0 0 1\n"
    (tmp_path / "book.obj").write_text(base + "f 1 2 3\nf 1 2 4\nf 1 2 5\nf 2 1 3\nf 1 1 2\n")
    book = facts(run, "book.obj")
    assert book["nonmanifold_edges"] == 1
    assert book["duplicate_faces"] == 1
    assert book["degenerate_faces"] == 1
    assert book["coincident_vertices"] == 1
    assert book["isolated_vertices"] == 1
    (tmp_path / "flipped.obj").write_text(base + "f 1 2 3\nf 1 2 4\n")
    assert facts(run, "flipped.obj")["inconsistently_oriented_edges"] == 1
    assert facts(run, "flipped.obj")["orientable"] is True
    (tmp_path / "nan.obj").write_text("v nan 0 0\n" + base + "f 1 2 3\nf 2 3 4\n")
    nan = facts(run, "nan.obj")
    assert (nan["vertices_not_finite"], nan["faces_not_finite"]) == (1, 1)
    (tmp_path / "bow.obj").write_text(base + "f 1 2 3\nf 1 4 5\n")
    assert facts(run, "bow.obj")["nonmanifold_vertices"] == 1


BOX = "f 1 3 2\nf 2 3 4\nf 5 6 7\nf 6 8 7\nf 1 2 5\nf 2 6 5\n"
BOX += "f 3 7 4\nf 4 7 8\nf 1 5 3\nf 3 5 7\nf 2 4 6\nf 4 8 6\n"


def box(z: float) -> str:
    corners = [f"v {i} {j} {k * z}\n" for k in (0, 1) for j in (0, 1) for i in (0, 1)]
    return "".join(corners) + BOX


@pytest.mark.parametrize("faces", [BOX, BOX.replace("f 1 3 2\nf 2 3 4", "f 1 2 3\nf 2 4 3")])
def test_info_recommends(run: Run, tmp_path: Path, faces: str) -> None:
    (tmp_path / "box.obj").write_text(box(1).replace(BOX, faces))
    info = facts(run, "box.obj")
    assert info["closed"] is True
    assert info["watertight"] == (faces == BOX)
    assert info["share_of_turned_triangles"] == (0 if faces == BOX else 2 / 12)
    assert info["recommendation"].startswith("sdf, query: auto, which")
    assert ("2 triangles turned" in info["recommendation"]) == (faces != BOX)
    assert ("exact here" in info["recommendation"]) == (faces == BOX)
    assert info["unit_guess"] == "metres, or scaled to about 1"


def test_info_estimates_thickness(run: Run, tmp_path: Path) -> None:
    """Where the ball touches, 2 e thick at a distance e from the nearest edge: (1 - 2 e)^2 of the
    area is farther from edges."""
    (tmp_path / "cube.obj").write_text(box(1))
    cube = facts(run, "cube.obj")
    assert cube["thickness_median"] == pytest.approx(1 - 0.5**0.5, abs=0.02)
    assert cube["thickness_5_percent"] == pytest.approx(1 - 0.95**0.5, abs=0.01)
    (tmp_path / "inside_out.obj").write_text(
        box(1).replace(BOX, "".join(f"f {a} {c} {b}\n" for a, b, c in triples(BOX)))
    )
    assert facts(run, "inside_out.obj")["thickness_median"] == pytest.approx(
        cube["thickness_median"], abs=0.02
    )
    (tmp_path / "plate.obj").write_text(box(0.01))
    assert facts(run, "plate.obj")["thickness_median"] == pytest.approx(0.01, rel=2e-3)
    (tmp_path / "square.obj").write_text(square(3))
    assert "thickness_median" not in facts(run, "square.obj")


def triples(faces: str) -> list[list[str]]:
    return [line.split()[1:] for line in faces.splitlines()]


def test_info_on_sources(run: Run, mesh: Path) -> None:
    run("info", "curve.txt", status=2)
    info = facts(run, "curve.txt", "--mesh", "square.obj")
    assert (info["signed_curves"], info["nodes"], info["pieces"]) == (1, 11, 10)
    assert abs(info["length"] - 1) < 1e-12


def test_triangulate_a_concave_polygon(run: Run, tmp_path: Path) -> None:
    corners = [(0, 0), (4, 0), (4, 4), (2, 1), (0, 4)]
    text = "".join(f"v {x} {y} 0\n" for x, y in corners) + "f 1 2 3 4 5\n"
    (tmp_path / "m.obj").write_text(text)
    run("convert", "m.obj", "-o", "m.stl", status=2)
    run("convert", "m.obj", "--triangulate", "-o", "t.obj")
    rows = (tmp_path / "t.obj").read_text().splitlines()
    faces = [[int(x.split("/")[0]) - 1 for x in r.split()[1:]] for r in rows if r[:2] == "f "]
    assert len(faces) == 3
    areas = []
    for a, b, c in ((corners[i], corners[j], corners[k]) for i, j, k in faces):
        areas.append(((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])) / 2)
    assert min(areas) > 0
    assert sum(areas) == 10


def plane_field(tmp_path: Path) -> None:
    """The square with x as texture u."""
    rows = square(10).splitlines()
    texture = [f"vt {r.split()[1]} 0" for r in rows if r[:2] == "v "]
    faces = ["f " + " ".join(f"{i}/{i}" for i in r.split()[1:]) for r in rows if r[:2] == "f "]
    points = [r for r in rows if r[:2] == "v "]
    (tmp_path / "field.obj").write_text("\n".join(points + texture + faces) + "\n")


def test_contour_of_a_plane(run: Run, tmp_path: Path) -> None:
    plane_field(tmp_path)
    run("contour", "field.obj", "--level", "0.25,0.55", "-o", "lines.obj")
    rows = (tmp_path / "lines.obj").read_text().splitlines()
    points = [[float(x) for x in r.split()[1:]] for r in rows if r[:2] == "v "]
    assert sum(r[:2] == "l " for r in rows) == 2
    assert {round(p[0], 12) for p in points} == {0.25, 0.55}
    run("contour", "field.obj", "--level", "0.25", "-o", "lines.ply")
    assert facts(run, "lines.ply")["lines"] == 1
    assert "level" in run("contour", "field.obj", "--level", "9", "-o", "x.obj", status=2).stderr
    run("contour", "field.obj", "--level", "a", "-o", "x.obj", status=2)
    run("contour", "field.obj", "--level", "1", "--field", "no", "-o", "x.obj", status=2)


def test_vtp_holds_what_has_no_values(run: Run, tmp_path: Path) -> None:
    """Surfaces, lines and clouds, wherever one is written."""
    plane_field(tmp_path)
    (tmp_path / "square.obj").write_text(square(10))
    run("convert", "square.obj", "-o", "a.vtp")
    assert facts(run, "a.vtp") == facts(run, "square.obj")
    run("convert", "a.vtp", "-o", "a.obj")
    run("convert", "square.obj", "-o", "b.obj")
    assert (tmp_path / "a.obj").read_bytes() == (tmp_path / "b.obj").read_bytes()
    run("contour", "field.obj", "--level", "0.25,0.55", "-o", "l.vtp")
    assert facts(run, "l.vtp")["lines"] == 2
    run("sdf", "square.obj", "--resolution", 16, "--level", 0.1, "-o", "s.vtp", "-o", "v.vti")
    run("contour", "v.vti", "--level", "0.1", "-o", "c.vtp")
    run("offset", "square.obj", "--resolution", 16, "--distance", 0.1, "-o", "o.vtp")
    run("repair", "square.obj", "--resolution", 16, "--thicken", 0.2, "-o", "r.vtp", "--quiet")
    for name in ("s.vtp", "c.vtp", "o.vtp", "r.vtp"):
        assert facts(run, name)["closed"], name
    run("query", "square.obj", "--points", "square.obj", "-o", "p.vtp")
    assert facts(run, "p.vtp")["vertices"] == 121


def test_methods(run: Run) -> None:
    methods = json.loads(run("methods", "--json").stdout)
    names = [m["name"] for m in methods]
    assert names[0] == "auto"
    assert len({(m["name"], *m["domains"]) for m in methods}) == len(methods)
    heat = next(m for m in methods if m["name"] == "signed-heat")
    options = {o["name"]: o for o in heat["options"]}
    assert options["constraint"]["choices"] == ["none", "zero-set", "level-sets"]
    assert options["time-scale"]["kind"] == "number" and options["time-scale"]["low"] == 0
    assert options["preserve-normals"]["kind"] == "toggle"
    for arguments in ((), ("--markdown",)):
        text = run("methods", *arguments).stdout
        assert all(name in text for name in names)


def test_render_and_view(run: Run, mesh: Path, tmp_path: Path) -> None:
    plane_field(tmp_path)
    arguments = ("--sources", "curve.txt", "--width", 80, "--height", 60, "--isolines", 3)
    run("render", "field.obj", *arguments, "-o", "a.png")
    assert (tmp_path / "a.png").read_bytes()[16:24] == b"\0\0\0\x50\0\0\0\x3c"
    run("render", "field.obj", "-o", "a.jpg", status=2)
    run("render", "field.obj", "--width", 1, "-o", "b.png", status=2)
    run("view", "field.obj", "-o", "a.html")
    assert (tmp_path / "a.html").read_text().lower().startswith("<!doctype html>")


def test_view_serves_the_page(mesh: Path) -> None:
    with subprocess.Popen(
        [PROGRAM, "view", str(mesh)], stdout=subprocess.PIPE, text=True
    ) as server:
        assert server.stdout is not None
        address = server.stdout.readline().strip()
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/\?token=[0-9a-f]{32}", address)
        with pytest.raises(urllib.error.HTTPError, match="403"):
            urllib.request.urlopen(address.split("?")[0], timeout=10)
        with urllib.request.urlopen(address, timeout=10) as answer:
            assert answer.status == 200
            assert b"<html" in answer.read().lower()
        server.terminate()
        assert server.wait(timeout=5) == 130


def test_view_edit_says_what_it_cannot_do(run: Run, mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "wrong.txt").write_text("signed_curve\nv 0\nv 99999\n")
    assert "99999" in run("view", mesh, "--edit", "-s", "wrong.txt", status=2).stderr
    assert "missing.obj" in run("view", "missing.obj", "--edit", status=2).stderr
    for option in (("-o", "a.html"), ("--isolines", 3), ("--axis", "x"), (mesh,)):
        error = run("view", mesh, "--edit", *option, status=2).stderr
        assert "does not go with --edit" in error


def test_support_table_in_the_docs_is_the_registry(run: Run) -> None:
    docs = Path(__file__).parents[2] / "docs/reference/support.md"
    assert docs.read_text() == run("methods", "--markdown").stdout


def test_a_missing_file_without_extension_is_missing(run: Run) -> None:
    for words in (("info", "nothere"), ("sdf", "nothere", "-o", "x.npy")):
        assert "there is no such file" in run(*words, status=2).stderr
