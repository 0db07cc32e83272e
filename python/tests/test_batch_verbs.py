"""Verbs of the program for many files, from Python: the same as `littoral batch`."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

import littoral

program = shutil.which(os.environ.get("LITTORAL", "littoral"))
pytestmark = pytest.mark.skipif(program is None, reason="needs the program littoral")

FACE = ",".join(str(v) for v in littoral.examples.sphere(3).faces[0][[0, 1, 2, 0]])

# Options that make the verb short, and what it writes by itself.
VERBS: dict[str, tuple[dict[str, object], list[str]]] = {
    "sdf": ({"resolution": 8}, ["ball.npz"]),
    "samples": ({"resolution": 12, "surface": 20, "space": 20}, ["ball.json", "ball.npz"]),
    "distance": ({"vertex": [0, 5], "method": "exact"}, ["ball.ply"]),
    "offset": ({"distance": 0.1, "resolution": 8}, ["ball.ply"]),
    "repair": ({"resolution": 8}, ["ball.ply"]),
    "convert": ({"triangulate": True}, ["ball.off"]),
    "info": ({}, []),
    "contour": ({"level": "0.5,1"}, ["ball.ply"]),
    "winding": ({"curve_vertices": FACE}, ["ball.obj"]),
    "query": ({"points": "points.csv"}, ["ball.csv"]),
    "pairs": ({"vertex": [0, 5]}, ["ball.npy"]),
    "fit-tori": ({}, ["ball.ply"]),
    "view": ({}, ["ball.html"]),
    "render": ({"width": 64, "height": 48}, ["ball.png"]),
}


@pytest.fixture
def scans(tmp_path: Path, sphere, monkeypatch) -> Path:
    (tmp_path / "in").mkdir()
    sphere.save(tmp_path / "in/ball.obj")
    (tmp_path / "fields").mkdir()
    littoral.distance(sphere, points=0).save(tmp_path / "fields/ball.ply")
    (tmp_path / "points.csv").write_text("x,y,z\n0,0,0\n2,0,0\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("verb", VERBS)
def test_each_verb_is_as_in_the_program(scans: Path, verb: str) -> None:
    options, outputs = VERBS[verb]
    to = ".off" if verb == "convert" else ""
    items = "fields" if verb == "contour" else "in"
    done = littoral.batch(items, verb, "out", to=to, options=options)
    assert (done.jobs, done.done, done.failed) == (1, 1, 0), done.failures
    [line] = map(json.loads, (scans / "out/status.jsonl").read_text().splitlines())
    assert line["outputs"] == outputs
    assert line["options"][0] == verb and line["status"] == "done"
    assert sorted(p.name for p in (scans / "out").iterdir()) == sorted([*outputs, "status.jsonl"])
    words = [str(x) for x in line["options"][1:]]
    assert program is not None
    again = subprocess.run(
        [program, "batch", items, "--verb", verb, *words, "-o", "out", "--json"],
        capture_output=True, text=True,
    )  # fmt: skip
    assert json.loads(again.stdout)["unchanged"] == 1, "the program knows what Python has done"


def test_items_of_all_kinds(scans: Path) -> None:
    (scans / "in/bad.obj").write_text("nothing")
    (scans / "jobs.csv").write_text("input,resolution\nin/ball.obj,9\nin/bad.obj,\n")
    ball = "in/ball.obj"
    heard: list[tuple[float, str]] = []
    for k, items in enumerate(("jobs.csv", ["in/bad.obj", Path(ball)], {"a": ball, "b/c": ball})):
        done = littoral.batch(items, "sdf", f"out{k}", to=[".npz", ".vti"],
                              options={"resolution": 8}, retries=1, processes=1,
                              progress=lambda f, text: heard.append((f, text)))  # fmt: skip
        assert (done.done, done.failed) == ((2, 0) if k == 2 else (1, 1))
    assert done.start_seconds < 0.1
    assert any("of 2" in text and "a second" in text for _, text in heard)
    assert {p.name for p in scans.rglob("out2/*/*")} == {"c.npz", "c.vti"}
    for wrong in ({"work": "sfd"}, {"options": {"nonsense": 1}}, {"shard": (2, 1)},
                  {"items": "no/*.obj"}, {"state": "elsewhere"}):  # fmt: skip
        with pytest.raises(littoral.InputError):
            littoral.batch(**({"items": "in", "work": "sdf", "out": "out"} | wrong))
    with pytest.raises(littoral.UnsupportedError), pytest.MonkeyPatch.context() as patch:
        patch.setenv("LITTORAL", "no-such-program")
        littoral.batch("in", "sdf", "out")


def test_urls_are_fetched_for_verbs(scans: Path) -> None:
    pytest.importorskip("fsspec")
    (scans / "in/bad.obj").write_text("nothing")
    url = f"file://{scans}"
    for n in (1, 0):
        done = littoral.batch(f"{url}/in", "sdf", f"{url}/results", options={"resolution": 8},
                              state="state")  # fmt: skip
        assert (done.done, done.unchanged, done.failed) == (n, 1 - n, 1), done.failures
    names = sorted(p.name for p in (scans / "results").iterdir())
    assert names == ["ball.npz", "status.jsonl"]


def test_functions_get_the_files_and_names_of_the_program(scans: Path) -> None:
    (scans / "in/sub").mkdir()
    shutil.copy(scans / "in/ball.obj", scans / "in/sub/ball.obj")
    (scans / "in/.hidden.obj").write_text("")
    (scans / "in/loop").symlink_to(".")

    def work(path: str, output: str) -> None:
        shutil.copy(path, output)

    for items in ("in", f"{scans}/in"):
        for n in (2, 0):  # what is written is no input of the next run
            done = littoral.batch(items, work, f"{items}/out", to=".obj")
            assert (done.jobs, done.done) == (2, n)
        shutil.rmtree(f"{items}/out")
    littoral.batch("in/*.obj", work, "out", to=".obj")
    assert sorted(p.name for p in (scans / "out").iterdir()) == ["ball.obj", "status.jsonl"]
    with pytest.raises(littoral.InputError, match="there are no files"):
        littoral.batch("in/*.ply", work, "out")
