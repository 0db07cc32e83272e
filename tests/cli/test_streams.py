"""Standard input and output as files, packed files, and arguments that are easily mistyped."""

import gzip
import json
import os
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest
from conftest import PROGRAM, Run, square, wait_for_handler


def piped(folder: Path, given: bytes, *words: str) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([PROGRAM, *words], cwd=folder, input=given, capture_output=True)


def test_standard_input_and_output_are_files_of_a_format(run: Run, mesh: Path) -> None:
    run("distance", mesh, "--vertex", 0, "-o", "a.ply", "-o", "a.csv")
    for name in ("ply", "csv"):
        words = ("distance", "obj:-", "--vertex=0", "--json", "-o", f"{name}:-")
        done = piped(mesh.parent, mesh.read_bytes(), *words)
        assert done.returncode == 0, done.stderr
        assert done.stdout == (mesh.parent / f"a.{name}").read_bytes()
        assert json.loads(done.stderr)["outputs"] == [f"{name}:-"]  # the report stands aside


def test_standard_input_is_not_kept(mesh: Path) -> None:
    """Beside what is made of it, as much of it is in memory as of a file."""
    given = (square(250) + "# " + 8_000_000 * ".").encode()
    (mesh.parent / "large.obj").write_bytes(given)
    peak = []
    for name in ("large.obj", "obj:-"):
        words = ("distance", name, "--vertex=0", "--method=fast-marching", "--json", "-o=a.npy")
        done = piped(mesh.parent, given, *words)
        peak.append(json.loads(done.stdout)["peak_memory_mb"])
    assert peak[1] - peak[0] < 0.6 * len(given) / 2**20


def test_a_failure_leaves_standard_output_to_results(mesh: Path) -> None:
    words = ("distance", "obj:-", "--vertex=999", "--json", "-o", "ply:-")
    failed = piped(mesh.parent, mesh.read_bytes(), *words)
    assert (failed.returncode, failed.stdout) == (2, b"")
    assert b"no-such-element" in failed.stderr


@pytest.mark.parametrize("name", ["-", "/dev/stdin"])
def test_a_stream_needs_a_format(run: Run, name: str) -> None:
    failed = run("info", name, status=2)
    assert "write obj:- for the format '.obj'" in failed.stderr
    assert "[unknown-format]" in failed.stderr


def test_a_stream_is_used_once(run: Run, mesh: Path) -> None:
    assert "as one file only" in run("compare", "obj:-", "obj:-", status=2).stderr
    words = ("distance", mesh, "--vertex=0", "-o")
    assert "one output" in run(*words, "ply:-", "-o", "csv:-", status=2).stderr


def test_results_replace_neither_input_nor_each_other(run: Run, mesh: Path) -> None:
    before = mesh.read_bytes()
    words = ("distance", mesh, "--vertex=0", "-o")
    assert "would replace the input" in run(*words, "square.obj", status=2).stderr
    os.symlink(mesh, mesh.parent / "link.obj")
    assert "would replace the input" in run(*words, "link.obj", status=2).stderr
    for log, of in (("link.obj", "input"), ("./square.obj", "input"), ("a.ply", "results")):
        failed = run(*words, "a.ply", "--log", log, status=2)
        assert f"--log: {log} is a file of the {of}" in failed.stderr
    assert mesh.read_bytes() == before
    assert "name it once" in run(*words, "a.ply", "-o", "a.ply", status=2).stderr


def test_files_packed_by_gzip_are_read(run: Run, mesh: Path) -> None:
    packed = mesh.parent / "square.OBJ.gz"
    packed.write_bytes(gzip.compress(mesh.read_bytes()))
    assert run("info", packed).stdout == run("info", mesh).stdout
    packed.write_bytes(packed.read_bytes()[:-9])
    assert "[bad-file]" in run("info", packed, status=2).stderr
    packed.write_bytes(b"v 0 0 0")
    assert "not packed by gzip" in run("info", packed, status=2).stderr
    refused = run("distance", mesh, "--vertex=0", "-o", "a.ply.gz", status=2).stderr
    assert "results are not packed by gzip" in refused


@pytest.mark.parametrize(
    ("words", "said", "code"),
    [
        ((), "no verb given", "usage"),
        (("version",), "did you mean '--version'?", "unknown-name"),
        (("-V",), "littoral has no option '-V'", "unknown-name"),
        (("info",), "no FILE given: littoral info FILE", "usage"),
        (("info", "square.obj", "b.obj"), "'b.obj' is one argument too many", "usage"),
        (("sdf", "square.obj", "-x", "-o", "a.vti"), "has no option '-x'", "unknown-name"),
        (("sdf", "square.obj", "--out", "a.vti"), "did you mean '--output'?", "unknown-name"),
        (("distance", "square.obj", "-s", "-o", "a.ply"), "option -s has no value", "usage"),
        (("distance", "square.obj", "--sources=", "-o", "a.ply"), "has no value", "usage"),
        (("sdf", "square.obj", "-o"), "option -o has no value", "usage"),
        (("distance", "square.obj", "--vertex", "1.5", "-o", "a.ply"), "whole", "option-value"),
        (("sdf", "square.obj", "--resolution", "24%", "-o", "a.vti"), "whole", "option-value"),
        (("sdf", "square.obj", "--padding", "10x", "-o", "a.vti"), "no number", "option-value"),
        (
            ("sdf", "square.obj", "--resolution=8", "--resolution=9", "-o", "a.vti"),
            "is given 2 times",
            "usage",
        ),
        (("render", "square.obj", "--up", "up", "-o", "a.png"), "no direction", "option-value"),
    ],
)
def test_mistyped_arguments_are_named(
    run: Run, mesh: Path, words: tuple[str, ...], said: str, code: str
) -> None:
    failed = run(*words, status=2).stderr
    assert said in failed
    assert failed.endswith(f" [{code}]\n")


def test_lists_of_numbers_have_blanks_or_commas(run: Run, mesh: Path) -> None:
    files = []
    for box in (["-1", "-1", "-1", "2", "2", "1"], ["-1,-1,-1, 2,2,1"], ["-1,-1,-1,2,2,1"]):
        run("sdf", mesh, "--method=closest-point", "--bounds", *box, "--resolution=6", "-o=a.npz")
        files.append((mesh.parent / "a.npz").read_bytes())
    assert files[0] == files[1] == files[2]


@pytest.mark.parametrize(
    "head", ["x (mm),y (mm),z (mm)", "x [mm],y [mm],z [mm]", "//X,Y,Z", "X,Y,Z"]
)
def test_units_and_marks_of_heads_are_no_part_of_names(run: Run, mesh: Path, head: str) -> None:
    (mesh.parent / "p.csv").write_text(f"{head}\n0.5,0.5,2\n")
    run("query", mesh, "--method=closest-point", "--points", "p.csv", "-o", "v.csv")
    rows = (mesh.parent / "v.csv").read_text().splitlines()
    assert rows == [f"{head},distance", "0.5,0.5,2,2"]


def test_a_decimal_comma_is_named(run: Run, mesh: Path) -> None:
    (mesh.parent / "p.csv").write_text("x;y;z\n0,5;0;1\n")
    failed = run("query", mesh, "--points", "p.csv", "-o", "v.csv", status=2)
    assert "p.csv:2: expected a number, found '0,5'; write a point, not a comma" in failed.stderr


def test_half_precision_is_read(run: Run, mesh: Path) -> None:
    points = np.array([[0.5, 0.5, 2], [0.25, 0.5, 6e-8], [0.1, 0.2, -300]], np.float16)
    np.save(mesh.parent / "p.npy", points)
    np.save(mesh.parent / "q.npy", points.astype(float))
    answers = []
    for name in ("p.npy", "q.npy"):
        run("query", mesh, "--method=closest-point", "--points", name, "-o", "v.npy")
        answers.append(np.load(mesh.parent / "v.npy"))
    assert (answers[0] == answers[1]).all()


def test_faces_of_text_may_have_more_than_their_head_says(run: Run, mesh: Path) -> None:
    head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    head += "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
    points = "0 0 0\n1 0 0\n0 1 0\n"
    (mesh.parent / "a.ply").write_text(head + points + "3 0 1 2 9 1 1\n")
    assert "faces: 1\n" in run("info", "a.ply").stdout
    (mesh.parent / "a.ply").write_text(head + points.replace("1 0 0", "1 0 0 7") + "3 0 1 2\n")
    assert "a.ply:11: unexpected '7'" in run("info", "a.ply", status=2).stderr


def writing_much(folder: Path, *words: str) -> subprocess.Popen[bytes]:
    """A run whose result is larger than a pipe holds; nobody reads it yet."""
    (folder / "fine.obj").write_text(square(100))
    run = (PROGRAM, "distance", "fine.obj", "--vertex=0", "-o", "a.ply", "-o", "csv:-", *words)
    return subprocess.Popen(
        run, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, start_new_session=True
    )


def left_in(folder: Path) -> list[str]:
    return sorted(path.name for path in folder.iterdir())


def test_a_reader_that_ends_early_ends_the_program_quietly(tmp_path: Path) -> None:
    with writing_much(tmp_path) as program:
        assert program.stdout and program.stderr
        assert program.stdout.read(6) == b"vertex"
        program.stdout.close()
        assert program.wait(timeout=30) == -signal.SIGPIPE  # as other programs end
        assert program.stderr.read() == b""
    assert left_in(tmp_path) == ["a.ply", "fine.obj"]  # whole, as it was written before


@pytest.mark.parametrize("to", ["> /dev/full", "| head -c 6"])
def test_a_stream_that_takes_only_a_part_is_an_error(tmp_path: Path, to: str) -> None:
    command = f"trap '' PIPE; {PROGRAM} distance fine.obj --vertex=0 -o csv:- {to}"
    (tmp_path / "fine.obj").write_text(square(100))
    shell = ["bash", "-c", command + '; exit "${PIPESTATUS[0]}"']
    done = subprocess.run(shell, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 1
    assert "littoral: error: cannot write csv:-: " in done.stderr
    assert done.stderr.endswith(" [cannot-write]\n")


def test_ctrl_c_ends_a_write_that_nobody_reads(tmp_path: Path) -> None:
    with writing_much(tmp_path) as program:
        wait_for_handler(program.pid, signal.SIGINT)
        while not (tmp_path / "a.ply").exists():
            time.sleep(0.01)
        time.sleep(0.3)  # the pipe is full
        program.send_signal(signal.SIGINT)
        assert program.wait(timeout=5) == 130
        assert program.stderr and b"interrupted" in program.stderr.read()
    assert left_in(tmp_path) == ["a.ply", "fine.obj"]


def test_no_thread_waits_beside_the_program(tmp_path: Path) -> None:
    """Libraries may start some as they are loaded, which look for work for a while."""
    os.mkfifo(tmp_path / "slow.obj")  # reading waits until somebody writes
    words = [PROGRAM, "info", "slow.obj"]
    with subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE) as program:
        wait_for_handler(program.pid, signal.SIGINT)
        threads = len(list(Path(f"/proc/{program.pid}/task").iterdir()))
        (tmp_path / "slow.obj").write_text(square(2))
        assert program.wait(timeout=30) == 0
    assert threads == 2  # its own, and the one that waits for Ctrl-C
