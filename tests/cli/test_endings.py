"""How runs end: interrupted, out of space; and what is shown on the way."""

import os
import re
import resource
import signal
import subprocess
import time
from pathlib import Path

import pytest
from conftest import PROGRAM, Run, square, wait_for_handler

CURVE = ("distance", "square.obj", "--sources", "curve.txt")
SIDES = 1200  # of `large`: what is interrupted must take longer than the longest wait


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path: Path = tmp_path_factory.mktemp("large") / "large.obj"
    path.write_text(square(SIDES))
    return path


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("wait", [0.2, 0.6, 1.2])
def test_interrupt(run: Run, tmp_path: Path, large: Path, number: int, wait: float) -> None:
    """The promise is 0.2 s; what was measured is printed, and a busy machine is allowed for."""
    arguments = [PROGRAM, "distance", str(large), "--vertex", "0", "-o", "a.ply"]
    arguments += ["-o", "a.html"]
    with subprocess.Popen(
        arguments,
        cwd=tmp_path,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),  # may be ignored around here
    ) as process:
        wait_for_handler(process.pid, number)
        time.sleep(wait)
        begin = time.monotonic()
        os.kill(process.pid, number)
        _, errors = process.communicate(timeout=10)
        took = time.monotonic() - begin
    assert process.returncode == 130, errors
    print(f"ended after {took:.3f} s")
    assert took < 1.0, "0.2 s, and four times as much again for a busy machine"
    assert errors.endswith(b"littoral: interrupted\n")
    left = [file.name for file in tmp_path.iterdir()]
    assert left in ([], ["a.ply"]), "what was written before is whole, and nothing else is there"
    if left:
        assert f"vertices: {(SIDES + 1) ** 2}" in run("info", "a.ply").stdout


def test_full_disk_leaves_nothing_behind(mesh: Path, tmp_path: Path) -> None:
    """Files may grow to 1000 bytes only; the result needs more."""

    def limit() -> None:
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)

    before = sorted(p.name for p in tmp_path.iterdir())
    for name in ("a.txt", "a.ply", "a.html", "a.png"):
        result = subprocess.run(
            [PROGRAM, *CURVE, "-o", name],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            timeout=60,
            preexec_fn=limit,
        )
        assert result.returncode == 1, result.stderr
        assert f"littoral: error: cannot write {name}: File too large" in result.stderr
        assert sorted(p.name for p in tmp_path.iterdir()) == before


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
def test_full_device(run: Run, mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "full.txt").symlink_to("/dev/full")
    before = sorted(p.name for p in tmp_path.iterdir())
    assert "No space left on device" in run(*CURVE, "-o", "full.txt", status=1).stderr
    assert sorted(p.name for p in tmp_path.iterdir()) == before


def test_a_failed_write_keeps_what_was_there(mesh: Path, tmp_path: Path) -> None:
    (tmp_path / "a.txt").write_text("old")
    command = f'ulimit -f 1; trap "" XFSZ; exec "{PROGRAM}" {" ".join(CURVE)} -o a.txt'
    result = subprocess.run(["bash", "-c", command], cwd=tmp_path, capture_output=True, timeout=60)
    assert result.returncode == 1, result.stderr
    assert (tmp_path / "a.txt").read_text() == "old"


def test_progress_bar(run: Run, mesh: Path) -> None:
    assert run(*CURVE, "-o", "a.txt").stderr == ""  # not a terminal
    assert run(*CURVE, "--progress", "never", "-o", "a.txt").stderr == ""
    heat = (*CURVE, "--method", "signed-heat")
    shown = run(*heat, "--progress", "always", "-o", "a.txt").stderr
    # carriage returns were translated to newlines
    frames = re.findall(r"\n\x1b\[K\[(#*)(\.*)\] +(\d+) % ([^\n]*)", shown)
    assert len(frames) >= 5
    shares = [int(frame[2]) for frame in frames]
    assert shares == sorted(shares)
    assert all(len(done) + len(left) == 30 for done, left, _, _ in frames)
    stages = {frame[3] for frame in frames}
    assert {"placing the sources", "factor vector heat", "writing"} <= stages
    assert shown.endswith("\n\x1b[K")  # the line is cleared in the end
    assert "progress" in run(*CURVE, "--progress", "some", "-o", "a.txt", status=2).stderr
