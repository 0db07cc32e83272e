"""What pages hold: docs/reference/scene.md."""

import json
import re
from pathlib import Path

from conftest import Run, square


def scene(page: Path) -> dict:
    text = page.read_text()
    found = re.search(r'<script id="scene" type="application/json">(.*?)</script>', text, re.S)
    assert found
    return json.loads(found[1])


def test_two_results_are_shown_in_one_frame(run: Run, tmp_path: Path) -> None:
    (tmp_path / "mesh.obj").write_text(square(4))
    for vertex in (0, 24):
        run("distance", "mesh.obj", "--vertex", vertex, "-o", f"from-{vertex}.ply")
    run("view", "from-0.ply", "from-24.ply", "-o", "both.html")
    shown = scene(tmp_path / "both.html")
    assert (shown["format"], shown["version"]) == ("littoral scene", 2)
    assert shown["title"] == "from-0" and shown["beside"]["title"] == "from-24"
    assert shown["frame"] == shown["beside"]["frame"]
    assert shown["surface"]["positions"] == shown["beside"]["surface"]["positions"]
    assert shown["fields"][0]["values"] != shown["beside"]["fields"][0]["values"]
    assert run("view", "from-0.ply", "missing.ply", "-o", "x.html", status=2).stderr


def test_options_and_warnings_stand_apart_from_facts(run: Run, tmp_path: Path) -> None:
    (tmp_path / "mesh.obj").write_text(square(4))
    run("distance", "mesh.obj", "--vertex", 0, "-o", "page.html")
    shown = scene(tmp_path / "page.html")
    names = [name for name, _ in shown["facts"]]
    assert "method" in names and "warning" not in names
    assert shown["options"] and not {name for name, _ in shown["options"]} & set(names)
    assert shown["surface"]["nodes"] == "faces"


def test_the_first_view_keeps_the_up_axis_of_the_input(run: Run, tmp_path: Path) -> None:
    corners = [(x, y, z) for z in (0, 2) for y in (-1, 1) for x in (-1, 1)]
    quads = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (2, 4, 8, 6), (4, 3, 7, 8), (3, 1, 5, 7)]

    def write(name: str, shift: float) -> None:
        lines = [f"v {x} {y} {z + shift}" for x, y, z in corners]
        lines += [f"f {a} {b} {c}\nf {a} {c} {d}" for a, b, c, d in quads]
        (tmp_path / name).write_text("\n".join(lines) + "\n")

    def up(page: str) -> list[float]:
        return scene(tmp_path / page)["frame"]["up"]

    write("standing.obj", 0)
    write("floating.obj", 1)
    run("sdf", "standing.obj", "--resolution", 8, "-o", "volume.html")
    assert up("volume.html")[2] > 0.4  # though the grid around it stands nowhere
    run("view", "floating.obj", "-o", "obj.html")
    assert up("obj.html")[1] > 0.4
    run("convert", "floating.obj", "-o", "floating.stl")
    run("view", "floating.stl", "-o", "stl.html")
    assert up("stl.html")[2] > 0.4  # as on a build plate
    run("view", "floating.stl", "--up", "x", "-o", "asked.html")
    assert up("asked.html")[0] > 0.4


def test_options_of_volumes_are_no_options_of_surfaces(run: Run, tmp_path: Path) -> None:
    (tmp_path / "mesh.obj").write_text(square(4))
    for words in (["--slice", "0"], ["--axis", "x"], ["--level", "0"], ["--no-surface"]):
        for verb, out in (("render", "a.png"), ("view", "a.html")):
            failed = run(verb, "mesh.obj", *words, "-o", out, status=2)
            assert f"option {words[0]} is of volumes" in failed.stderr
            assert "options-conflict" in failed.stderr
    run("sdf", "mesh.obj", "--resolution", 6, "-o", "box.vti")
    run("view", "mesh.obj", "box.vti", "--axis", "x", "-o", "both.html")  # of the second one


def test_what_cannot_be_shown_says_why(run: Run, tmp_path: Path) -> None:
    (tmp_path / "lines.obj").write_text("v 0 0 0\nv 1 0 0\nl 1 2\n")
    failed = run("render", "lines.obj", "-o", "a.png", status=2)
    assert "lines.obj: " in failed.stderr and "[empty-input]" in failed.stderr
    nan = (
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty float distance\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n"
        "0 0 0 1\n1 0 0 nan\n0 1 0 2\n3 0 1 2\n"
    )
    (tmp_path / "nan.ply").write_text(nan)
    failed = run("render", "nan.ply", "-o", "a.png", status=2)
    assert "nan.ply: " in failed.stderr and "[not-finite]" in failed.stderr
    (tmp_path / "mesh.obj").write_text(square(4))
    failed = run("view", "mesh.obj", "nan.ply", "-o", "both.html", status=2)
    assert "nan.ply: scene" in failed.stderr and "mesh.obj" not in failed.stderr


def test_tets_are_cut_open_where_their_boundary_has_one_sign(run: Run, tmp_path: Path) -> None:
    """A field about a ball in a box: its inside is seen by default, and where an axis is named."""
    n = 6
    points = [(i, j, k) for k in range(n) for j in range(n) for i in range(n)]
    path = ((0, 1, 3, 7), (0, 1, 5, 7), (0, 2, 3, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 4, 6, 7))
    corner = [(c & 1) + (c >> 1 & 1) * n + (c >> 2) * n * n for c in range(8)]
    first = [i + j * n + k * n * n for k in range(5) for j in range(5) for i in range(5)]
    tets = [[f + corner[c] for c in way] for f in first for way in path]
    values = [sum((x - 2.4) ** 2 for x in p) ** 0.5 - 1.4 for p in points]

    def write(name: str, shift: float) -> None:
        lines = ["# vtk DataFile Version 3.0", "field", "ASCII", "DATASET UNSTRUCTURED_GRID"]
        lines += [f"POINTS {len(points)} double", *(f"{x} {y} {z}" for x, y, z in points)]
        lines += [f"CELLS {len(tets)} {5 * len(tets)}"]
        lines += ["4 " + " ".join(map(str, t)) for t in tets]
        lines += [f"CELL_TYPES {len(tets)}", *["10"] * len(tets)]
        lines += [f"POINT_DATA {len(points)}", "SCALARS distance double 1", "LOOKUP_TABLE default"]
        (tmp_path / name).write_text("\n".join([*lines, *(str(v + shift) for v in values), ""]))

    write("ball.vtk", 0)
    write("outside.vtk", 3)

    def least(*words: str) -> float:
        run("view", *words, "-o", "a.html")
        shown = scene(tmp_path / "a.html")["fields"][0]
        return float(shown["low"])

    assert least("ball.vtk") < 0
    assert least("outside.vtk") > 3.5 > least("outside.vtk", "--axis", "y")
