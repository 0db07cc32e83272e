"""littoral sdf --tets tetgen, with programs in the place of tetgen that do what it might."""

import json
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import PROGRAM, wait_for_handler
from test_space import CUBE
from test_tets import cube_mesh

COMMAND = ("sdf", "cube.obj", "--domain", "tets", "--tets", "tetgen", "--resolution", "9")
OUT = ("-o", "a.npy", "-o", "a.ply")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with cube.obj, one for programs, and one for temporary files."""
    (tmp_path / "cube.obj").write_text(CUBE)
    (tmp_path / "bin").mkdir()
    (tmp_path / "tmp").mkdir()
    return tmp_path


def environment(folder: Path) -> dict[str, str]:
    """PATH begins with our programs."""
    path = f"{folder / 'bin'}:/usr/bin:/bin"
    return {**os.environ, "PATH": path, "TMPDIR": str(folder / "tmp")}


def put(folder: Path, script: str) -> None:
    """Makes `tetgen` of a shell script."""
    program = folder / "bin" / "tetgen"
    program.write_text("#!/bin/sh\n" + script)
    program.chmod(0o755)


def call(folder: Path, *more: str, path: str | None = None) -> subprocess.CompletedProcess[str]:
    """Runs the command; nothing may be left behind where it fails."""
    env = environment(folder)
    if path is not None:
        env["PATH"] = path
    result = subprocess.run(
        [PROGRAM, *COMMAND, *OUT, *more],
        cwd=folder,
        env=env,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert list((folder / "tmp").iterdir()) == []
    if result.returncode != 0:
        assert len(result.stderr.splitlines()) == 1, result.stderr
        assert not list(folder.glob("a.*"))
        assert not list(folder.glob(".a.*"))
    return result


def test_it_must_be_installed_and_asked_for(folder: Path) -> None:
    result = call(folder, path=str(folder / "bin"))
    assert result.returncode == 2
    assert "tetgen was not found" in result.stderr
    assert "--tets lattice" in result.stderr
    (folder / "bin" / "tetgen").write_text("not a program")  # nobody may execute it
    assert "was not found" in call(folder, path=str(folder / "bin")).stderr
    words = [word for word in COMMAND if word not in ("--domain", "tets")]
    result = subprocess.run(
        [PROGRAM, *words, *OUT], cwd=folder, capture_output=True, text=True, timeout=60
    )
    assert result.returncode == 2
    assert "--domain tets" in result.stderr


@pytest.mark.parametrize(
    ("script", "words"),
    [
        ("kill -SEGV $$", ["signal 11"]),
        ("kill -ABRT $$", ["signal 6"]),
        ("echo Two facets intersect; exit 3", ["status 3", "Two facets intersect"]),
        ("printf '\\033[31mred\\n' >&2; exit 1", ["status 1", "red"]),
        ("exit 0", ["wrote no tets"]),
        ("echo nonsense > in.1.mesh", ["not a tet mesh"]),
        ("head -c 100000 /dev/urandom > in.1.mesh", ["not a tet mesh"]),
        (
            "printf 'MeshVersionFormatted 1\\nDimension 3\\nVertices\\n9000000\\n' > in.1.mesh",
            ["9"],
        ),
        ("mkdir in.1.mesh", ["in.1.mesh"]),
    ],
)
def test_whatever_it_does_ends_in_an_error(folder: Path, script: str, words: list[str]) -> None:
    put(folder, script)
    result = call(folder)
    assert result.returncode == 1
    for word in words:
        assert word in result.stderr
    assert "\033" not in result.stderr


def pids(folder: Path) -> list[int]:
    """What the script wrote down: itself, and a process that it started."""
    return [int(word) for word in (folder / "pids").read_text().split()]


def are_gone(numbers: list[int]) -> bool:
    """Within a second, no such process runs any more."""
    for _ in range(100):
        alive = [n for n in numbers if Path(f"/proc/{n}/cmdline").exists()]
        alive = [n for n in alive if " Z " not in Path(f"/proc/{n}/stat").read_text()]
        if not alive:
            return True
        time.sleep(0.01)
    return False


def test_it_may_not_take_for_ever(folder: Path) -> None:
    put(folder, f"sleep 300 &\necho $$ $! > {folder}/pids\nsleep 300")
    begin = time.monotonic()
    result = call(folder, "--tetgen-timeout", "0.5")
    assert time.monotonic() - begin < 10
    assert result.returncode == 1
    assert "0.5 s" in result.stderr
    assert "--tetgen-timeout" in result.stderr
    assert are_gone(pids(folder))


def test_it_ends_with_an_interrupt(folder: Path) -> None:
    put(folder, f"sleep 300 &\necho $$ $! > {folder}/pids\nsleep 300")
    with subprocess.Popen(
        [PROGRAM, *COMMAND, *OUT],
        cwd=folder,
        env=environment(folder),
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as process:
        wait_for_handler(process.pid, signal.SIGINT)
        for _ in range(500):
            if (folder / "pids").exists() and len((folder / "pids").read_text().split()) == 2:
                break
            time.sleep(0.01)
        begin = time.monotonic()
        os.kill(process.pid, signal.SIGINT)
        process.communicate(timeout=10)
        assert time.monotonic() - begin < 1
    assert process.returncode == 130
    assert are_gone(pids(folder))
    assert list((folder / "tmp").iterdir()) == []
    assert not list(folder.glob("a.*"))


def test_its_tets_are_used(folder: Path) -> None:
    """A lattice of [-2, 2]^3 whose faces include those of the cube."""
    lines = cube_mesh(8).splitlines()
    first = lines.index("Vertices") + 2
    for i in range(first, first + 9**3):
        x, y, z, _ = map(float, lines[i].split())
        lines[i] = f"{4 * x - 2} {4 * y - 2} {4 * z - 2} 0"
    (folder / "answer.mesh").write_text("\n".join(lines) + "\n")
    put(folder, f"cp in.poly in.mtr {folder}; cp {folder}/answer.mesh in.1.mesh")
    more = ("--bounds=-1.9,-1.9,-1.9,1.9,1.9,1.9", "--json")
    result = call(folder, *more)
    assert result.returncode == 0, result.stderr
    assert "tetgen mesh" in result.stdout
    # Eight corners of the cube and of the box, twelve triangles and six sides.
    words = (folder / "in.poly").read_text().split()
    assert words[0] == "16"
    assert words[4 + 4 * 16] == "18"
    assert len((folder / "in.mtr").read_text().split()) == 2 + 16
    text = subprocess.run(
        [PROGRAM, "info", "a.ply", "--json"], cwd=folder, capture_output=True, text=True, check=True
    ).stdout
    facts = json.loads(text)
    assert facts["boundary_edges"] == 0
    # Held at zero where it is given.
    assert facts["bounding_box"] == pytest.approx([-1, -1, -1, 1, 1, 1], abs=0.05)


@pytest.mark.skipif(shutil.which("tetgen") is None, reason="needs the program tetgen")
def test_tetgen_itself(folder: Path) -> None:
    assert call(folder).returncode == 0
