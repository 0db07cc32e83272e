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
