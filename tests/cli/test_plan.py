"""--dry-run, --log, and the pages of the manual."""

import json
import re
import resource
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import PROGRAM, Run, square
from test_reports import SCHEMA, check

VERBS = [
    ("distance", "square.obj", "--vertex=0"),
    ("pairs", "square.obj", "--vertex=0"),
    ("winding", "square.obj", "-s", "curve.txt"),
    ("sdf", "square.obj", "--resolution=16"),
    ("offset", "square.obj", "--distance=0.1", "--resolution=16"),
    ("offset", "square.obj", "-s", "curve.txt", "--distance=0.1"),
    ("query", "square.obj", "--points", "square.obj"),
    ("repair", "square.obj", "--resolution=16"),
]
OUT = {"pairs": "a.npy", "query": "a.csv", "winding": "a.txt", "distance": "a.txt", "sdf": "a.vti"}


def plan(run: Run, *arguments: object) -> dict[str, Any]:
    out: dict[str, Any] = json.loads(run(*arguments, "--dry-run", "--json").stdout)
    check(out, json.loads(SCHEMA.read_text()))
    assert out["status"] == "planned"
    return out


@pytest.mark.parametrize("arguments", VERBS)
def test_a_dry_run_writes_nothing(run: Run, mesh: Path, arguments: tuple[str, ...]) -> None:
    out = OUT.get(arguments[0], "a.obj" if "-s" in arguments else "a.ply")
    before = sorted(mesh.parent.iterdir())
    planned = plan(run, *arguments, "-o", out)
    assert planned["method"]
    assert planned["plan"]["reason"].startswith("the default: ")
    assert sorted(mesh.parent.iterdir()) == before
    text = run(*arguments, "--dry-run", "-o", out).stdout
    assert text.startswith(f"method: {planned['method']} (the default: ")
    assert "outputs: " + out in text


def test_a_plan_has_the_sizes_and_grows_with_them(run: Run, mesh: Path) -> None:
    small = plan(run, "sdf", "square.obj", "--resolution=16", "-o", "a.vti")
    large = plan(run, "sdf", "square.obj", "--resolution=160", "-o", "a.vti")
    nodes = [small["sizes"][f"nodes along {axis}"] for axis in "xyz"]
    assert small["sizes"]["nodes"] == nodes[0] * nodes[1] * nodes[2]
    assert max(nodes) == 16
    assert large["plan"]["seconds"] > 5 * small["plan"]["seconds"] > 0
    assert large["plan"]["memory_mb"] > small["plan"]["memory_mb"]
    asked = plan(run, "sdf", "square.obj", "--method=winding", "-o", "a.vti")
    assert asked["method"] == "winding"
    assert asked["plan"]["reason"].startswith("asked for: ")


@pytest.mark.parametrize(("method", "most"), [("signed-heat", 1300), ("unsigned-heat", 1500)])
def test_large_meshes_are_solved_in_parts(
    run: Run, tmp_path: Path, method: str, most: float
) -> None:
    """Tori of 999,936 faces take 748 and 1,177 MB (docs/measurements/performance.md)."""
    n = 700
    points = np.zeros((n + 1, n + 1, 3))
    points[..., :2] = np.stack(np.meshgrid(np.arange(n + 1), np.arange(n + 1)), axis=-1)
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).reshape(-1, 1)
    corners = np.concatenate(
        [first + np.array([0, *ends]) for ends in ((1, n + 2), (n + 2, n + 1))]
    )
    faces = np.zeros(len(corners), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    faces["n"], faces["corners"] = 3, corners
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {(n + 1) ** 2}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz")
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    (tmp_path / "large.ply").write_bytes(head.encode() + points.tobytes() + faces.tobytes())
    words = ("distance", "large.ply", "--vertex=0", "--method", method, "-o", "a.npy")
    planned = plan(run, *words)["plan"]
    assert most / 2 < planned["memory_mb"] < most


def test_a_dry_run_finds_what_is_wrong(run: Run, mesh: Path) -> None:
    assert "a.xyz2" in run("sdf", "square.obj", "--dry-run", "-o", "a.xyz2", status=2).stderr
    run("distance", "square.obj", "--vertex=999", "--dry-run", "-o", "a.txt", status=2)


def test_long_runs_are_announced(tmp_path: Path) -> None:
    """Before the work, and only where it is long."""
    (tmp_path / "large.obj").write_text(square(100))
    arguments = [PROGRAM, "pairs", "large.obj", "--method=exact", "-o", "a.npy", "--time-limit=1"]
    done = subprocess.run(arguments, cwd=tmp_path, capture_output=True, text=True, timeout=60)
    assert done.returncode == 1
    assert done.stderr.startswith("littoral: this will take about ")
    assert "option vertex measures from some vertices only" in done.stderr
    assert "time limit" in done.stderr
    done = subprocess.run(
        [*arguments, "--vertex=0"], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert "this will take" not in done.stderr


def test_more_memory_than_is_free_is_announced(tmp_path: Path) -> None:
    (tmp_path / "large.obj").write_text(square(100))
    limits = (1 << 29, 1 << 29)
    done = subprocess.run(
        [PROGRAM, "pairs", "large.obj", "--method=exact", "-o", "a.npy", "--time-limit=1"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_DATA, limits),
    )
    assert done.returncode == 1
    assert re.search(r"about \d+ MB, more than the \d+ MB that are free", done.stderr), done.stderr


def test_the_log_has_stages_warnings_and_errors(run: Run, mesh: Path) -> None:
    (mesh.parent / "more.obj").write_text(mesh.read_text() + "v 5 5 5\n")
    for _ in range(2):
        run("distance", "more.obj", "--vertex=0", "--quiet", "--log", "log", "-o", "a.txt")
    run("distance", "more.obj", "--vertex=999", "--log", "log", "-o", "a.txt", status=2)
    lines = (mesh.parent / "log").read_text().splitlines()
    assert all(" s  " in line for line in lines)
    assert sum("distance more.obj" in line for line in lines) == 3
    assert sum("[isolated-vertices]" in line for line in lines) == 2
    assert lines[-1].endswith("[no-such-element]")
    assert sum("solving" in line for line in lines) >= 2
    run("info", "square.obj", "--log", "no/log", status=1)


def test_the_manual_has_a_page_for_each_verb(run: Run, tmp_path: Path) -> None:
    run("help", "--man-pages", "man")
    pages = {page.name for page in (tmp_path / "man").iterdir()}
    verbs = [
        line[3:] for line in run("help", "--markdown").stdout.splitlines() if line.startswith("## ")
    ]
    verbs.remove("Options of all verbs")
    assert pages == {"littoral.1"} | {f"littoral-{verb}.1" for verb in verbs}
    text = (tmp_path / "man/littoral-sdf.1").read_text()
    for option in ("resolution", "dry\\-run", "time\\-limit", "hopf\\-cole"):
        assert option in text
    assert "no\\-such\\-element" in (tmp_path / "man/littoral.1").read_text()


@pytest.mark.skipif(not shutil.which("groff"), reason="groff is not installed")
def test_groff_reads_the_manual(run: Run, tmp_path: Path) -> None:
    run("help", "--man-pages", "man")
    for page in sorted((tmp_path / "man").iterdir()):
        done = subprocess.run(
            ["groff", "-man", "-Tascii", "-ww", str(page)],
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stderr == "", page.name
        assert "littoral 0." in done.stdout


SCRIPTS = {
    "zsh": "autoload -Uz compinit; compinit -u; source complete; print $_comps[littoral]",
    "fish": "source complete; complete -C 'littoral query --poi';"
    " complete -C 'littoral distance --method exa'",
    "bash": "source complete; complete -p littoral",
}
SAID = {"zsh": ["_littoral"], "fish": ["--points", "exact"], "bash": ["_littoral"]}


@pytest.mark.parametrize("shell", sorted(SCRIPTS))
def test_shells_take_their_completion(run: Run, tmp_path: Path, shell: str) -> None:
    if not shutil.which(shell):
        pytest.skip(f"{shell} is not installed")
    (tmp_path / "complete").write_text(run("completion", shell).stdout)
    done = subprocess.run(
        [shell, "-c", SCRIPTS[shell]], cwd=tmp_path, capture_output=True, text=True, check=True
    )
    for word in SAID[shell]:
        assert word in done.stdout, done.stderr
