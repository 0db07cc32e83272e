"""Batches where the system or the list of inputs is against them."""

import json
import os
import random
import resource
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from conftest import PROGRAM, Run, square

TO_PLY = ("--verb", "convert", "--to", ".ply", "-o", "out")
UNUSED_USER = 54321
Script = Callable[[str], "subprocess.CompletedProcess[str]"]


def lines(folder: Path, name: str = "status.jsonl") -> list[dict[str, Any]]:
    return [json.loads(line) for line in (folder / name).read_text().splitlines()]


def by_input(folder: Path) -> dict[str, dict[str, Any]]:
    return {line["input"]: line for line in lines(folder)}


def batch(folder: Path, *arguments: object) -> "subprocess.CompletedProcess[str]":
    return subprocess.run(
        [PROGRAM, "batch", *map(str, arguments)],
        cwd=folder, capture_output=True, text=True, errors="surrogateescape", timeout=60,
    )  # fmt: skip


@pytest.fixture
def scans(tmp_path: Path) -> Path:
    (tmp_path / "in/sub").mkdir(parents=True)
    for k in range(12):
        (tmp_path / f"in/{k:02d}.obj").write_text(square(2))
    return tmp_path


@pytest.fixture
def small_disk(tmp_path: Path) -> Script:
    """Runs shell commands where the folder `disk` is a file system of 256 kB, seen by them only."""
    (tmp_path / "disk").mkdir()

    def script(text: str) -> "subprocess.CompletedProcess[str]":
        mount = "mount -t tmpfs -o size=256k none disk"
        return subprocess.run(
            ["unshare", "--user", "--map-root-user", "--mount", "bash", "-c", f"{mount} && {text}"],
            cwd=tmp_path, capture_output=True, text=True, timeout=60,
            env={**os.environ, "LITTORAL": PROGRAM},
        )  # fmt: skip

    if script("true").returncode != 0:
        pytest.skip("this system lets nobody mount a file system of their own")
    return script


def test_disk_full(scans: Path, small_disk: Script) -> None:
    """Results do not fit: lines say so, nothing is half written; with more room all is done."""
    for k in range(12):
        (scans / f"in/{k:02d}.obj").write_text(square(40))
    run = '"$LITTORAL" batch in --verb convert --to .off --jobs 1 -o disk/out; echo "status $?"; '
    keep = "cp -r disk/out {0}; ls -A disk/out > {0}.list; "
    made = small_disk(
        run + keep.format("full") + "mount -o remount,size=16m disk; " + run + keep.format("whole")
    )
    assert made.stdout.splitlines() == ["status 1", "status 0"], made.stderr
    full = lines(scans / "full")
    assert len(full) == 12
    failed = [line for line in full if line["status"] != "done"]
    assert failed and {line["status"] for line in failed} == {"io"}
    for line in failed:
        place = line["input"].replace("in/", "disk/out/").replace(".obj", ".off")
        assert line["message"] == f"cannot write {place}: No space left on device"
    kept = {line["name"] + ".off" for line in full if line["status"] == "done"}
    assert set((scans / "full.list").read_text().split()) == kept | {"status.jsonl"}
    assert f"{len(failed)} done, {len(kept)} were done before, 0 failed" in made.stderr
    texts = {(scans / f"whole/{k:02d}.off").read_text() for k in range(12)}
    assert len(texts) == 1


def test_disk_full_to_the_last_byte(scans: Path, small_disk: Script) -> None:
    made = small_disk(
        'mkdir disk/out; "$LITTORAL" batch in/00.obj --verb info -o disk/out --quiet; '
        'head -c 1M /dev/zero > disk/much; "$LITTORAL" batch in --verb info -o disk/out --jobs 1; '
        'echo "status $?"; cp disk/out/status.jsonl kept; ls -A disk/out; rm disk/much; '
        '"$LITTORAL" batch in --verb info -o disk/out; echo "status $?"'
    )
    assert made.stdout.split() == ["status", "1", "status.jsonl", "status", "0"], made.stderr
    assert "No space left on device" in made.stderr
    assert all(json.loads(line) for line in (scans / "kept").read_text().splitlines())
    assert " 0 failed of 12" in made.stderr


def test_read_only_output(scans: Path, small_disk: Script) -> None:
    made = small_disk(
        'mkdir disk/out; mount -o remount,ro disk; "$LITTORAL" batch in --verb info -o disk/out; '
        'echo "status $?"; "$LITTORAL" batch in --verb info -o disk/new; ls -A disk/out'
    )
    assert made.stdout == "status 1\n"
    assert made.stderr.splitlines() == [
        "littoral: error: cannot write disk/out/status.jsonl: Read-only file system [cannot-write]",
        "littoral: error: cannot make the folder disk/new: Read-only file system [cannot-write]",
    ]


def test_folders_become_read_only_underway(scans: Path, small_disk: Script) -> None:
    """A result's place is taken by a file system that nothing can be written to."""
    (scans / "in/sub/z.obj").write_text(square(1))
    made = small_disk(
        "mkdir -p disk/out/sub; mount -t tmpfs -o ro none disk/out/sub; "
        '"$LITTORAL" batch in --verb convert --to .off -o disk/out; echo "status $?"; '
        "cp disk/out/status.jsonl kept; ls -A disk/out/sub"
    )
    assert made.stdout == "status 1\n", made.stderr
    [z] = [x for x in map(json.loads, (scans / "kept").open()) if x["status"] != "done"]
    assert (z["input"], z["status"], z["outputs"]) == ("in/sub/z.obj", "io", [])
    assert z["message"].startswith("cannot write disk/out/sub/z.off")


def test_no_place_for_more_processes(scans: Path) -> None:
    """Files that may be open for three processes at once, not for twelve: the others wait."""
    made = subprocess.run(
        ["bash", "-c", 'ulimit -n 20; exec "$0" batch in --verb info -o out --jobs 12', PROGRAM],
        cwd=scans, capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert made.returncode == 0, made.stderr
    assert "12 done, 0 were done before, 0 failed of 12" in made.stderr
    assert len(by_input(scans / "out")) == 12


@pytest.mark.parametrize("files", [4, 7, 8])
def test_no_place_for_any_process(scans: Path, files: int) -> None:
    """So few files may be open that a batch does nothing: one message, and nothing is left."""
    limited = f'ulimit -n {files}; exec "$0" batch in {" ".join(TO_PLY)} --jobs 1'
    made = subprocess.run(
        ["bash", "-c", limited, PROGRAM], cwd=scans, capture_output=True, text=True, timeout=60
    )
    assert made.returncode in (1, 2)
    [said] = made.stderr.splitlines()
    assert said.startswith("littoral: error: cannot ") and "Too many open files" in said
    assert {path.name for path in scans.glob("out/*")} <= {"status.jsonl"}
    assert not (scans / "out/status.jsonl").exists() or lines(scans / "out") == []
    assert batch(scans, "in", *TO_PLY).returncode == 0


@pytest.mark.skipif(
    os.geteuid() != 0, reason="another user's processes can be limited by root only"
)
def test_no_place_for_threads() -> None:
    """The user may have no second thread or process: work goes on in one, or a message says why."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        folder.chmod(0o777)
        (folder / "a.obj").write_text(square(2))

        def alone(*words: str) -> "subprocess.CompletedProcess[str]":
            def limit() -> None:
                resource.setrlimit(resource.RLIMIT_NPROC, (1, 1))

            return subprocess.run(
                [PROGRAM, *words], cwd=folder, capture_output=True, text=True, timeout=60,
                user=UNUSED_USER, group=UNUSED_USER, extra_groups=[], preexec_fn=limit,
            )  # fmt: skip

        made = alone("distance", "a.obj", "--vertex", "0", "-o", "a.ply")
        assert made.returncode == 0, made.stderr
        assert (folder / "a.ply").exists()
        limited = alone("distance", "a.obj", "--vertex", "0", "--time-limit", "9", "-o", "b.ply")
        assert limited.returncode == 1
        assert limited.stderr == (
            "littoral: error: cannot start a thread for the time limit: "
            "Resource temporarily unavailable [system]\n"
        )
        many = alone("batch", "a.obj", *TO_PLY)
        assert many.returncode == 1 and "cannot start a process: Resource" in many.stderr
        assert sorted(os.listdir(folder)) == ["a.obj", "a.ply"]


def test_inputs_vanish_underway(scans: Path) -> None:
    (scans / "in/00.obj").write_text(square(150))
    hard = ("--verb", "distance", "--vertex", "0", "--method", "exact", "--jobs", "1")
    with subprocess.Popen(
        [PROGRAM, "batch", "in", *hard, "-o", "out"], cwd=scans, stderr=subprocess.PIPE
    ) as process:
        while not (scans / "out/.status.tmp").is_dir() or not any(
            (scans / "out/.status.tmp").iterdir()
        ):
            time.sleep(0.001)
        for k in range(6, 12):
            (scans / f"in/{k:02d}.obj").unlink()
        process.communicate(timeout=60)
    assert process.returncode == 1
    status = by_input(scans / "out")
    assert [status[f"in/{k:02d}.obj"]["status"] for k in range(12)] == ["done"] * 6 + ["input"] * 6
    assert status["in/11.obj"]["message"] == "cannot read in/11.obj: there is no such file"


def test_links(scans: Path) -> None:
    """Links to files and folders are inputs; one that leads back to where it lies is not."""
    for k in range(2, 12):
        (scans / f"in/{k:02d}.obj").unlink()
    (scans / "elsewhere").mkdir()
    (scans / "elsewhere/far.obj").write_text(square(3))
    (scans / "elsewhere/back").symlink_to(scans / "in")
    (scans / "in/file.obj").symlink_to("00.obj")
    (scans / "in/folder").symlink_to(scans / "elsewhere")
    (scans / "in/loop").symlink_to(".")
    (scans / "in/sub/up").symlink_to("..")
    (scans / "in/gone.obj").symlink_to("nowhere.obj")
    batch(scans, "in", *TO_PLY)
    status = by_input(scans / "out")
    ends = {name.removeprefix("in/"): line["status"] for name, line in status.items()}
    assert ends == {
        "00.obj": "done", "01.obj": "done", "file.obj": "done", "folder/far.obj": "done",
        "gone.obj": "input",
    }  # fmt: skip
    (scans / "elsewhere/far.obj").write_text(square(4))
    assert "1 done, 3 were done before, 1 failed" in batch(scans, "in", *TO_PLY).stderr


@pytest.mark.parametrize(
    "name", [" a  b ", "é日本", "two\nlines", "quo'te\"", "-dash", "[x]*?", "caf\udce9", "a\\b"]
)
def test_names_of_all_kinds(scans: Path, name: str) -> None:
    (scans / "odd").mkdir()
    (scans / f"odd/{name}.obj").write_text(square(2))
    (scans / "odd/x.obj").write_text(square(3))
    assert batch(scans, "odd", *TO_PLY).returncode == 0
    assert sorted(os.listdir(scans / "out")) == sorted([f"{name}.ply", "status.jsonl", "x.ply"])
    assert len(lines(scans / "out")) == 2
    again = batch(scans, "odd", *TO_PLY)
    assert "0 done, 2 were done before" in again.stderr
    (scans / "out" / f"{name}.ply").unlink()
    assert "1 done, 1 were done before" in batch(scans, "odd", *TO_PLY).stderr


def test_lists_of_other_programs(scans: Path) -> None:
    """Marks of the byte order and ends of lines as on Windows; zero bytes are refused."""
    mark = b"\xef\xbb\xbf"
    (scans / "l.txt").write_bytes(mark + b"in/00.obj\r\nin/01.obj --triangulate\r\n")
    (scans / "l.csv").write_bytes(mark + b"input,triangulate\r\nin/00.obj,\r\nin/01.obj,true\r\n")
    (scans / "l.jsonl").write_bytes(
        mark + b'{"input": "in/00.obj"}\r\n{"input": "in/01.obj", "triangulate": true}\r\n'
    )
    for end in ("txt", "csv", "jsonl"):
        assert batch(scans, f"l.{end}", *TO_PLY[:-1], end).returncode == 0
        options = {x: line["options"] for x, line in by_input(scans / end).items()}
        plain = ["convert", "--to=.ply"]
        assert options == {"in/00.obj": plain, "in/01.obj": [*plain, "--triangulate"]}
    (scans / "zero.jsonl").write_text('{"input": "in/00.obj\\u0000"}\n')
    assert "has a zero byte in it" in batch(scans, "zero.jsonl", *TO_PLY).stderr
    assert not (scans / "out").exists()


def test_a_second_batch_at_the_same_time_is_told(run: Run, scans: Path) -> None:
    (scans / "in/00.obj").write_text(square(150))
    hard = ("--verb", "distance", "--vertex", "0", "--method", "exact", "-o", "out", "--jobs", "1")
    with subprocess.Popen(
        [PROGRAM, "batch", "in", *hard], cwd=scans, stderr=subprocess.PIPE, text=True
    ) as first:
        while not (scans / "out/.status.tmp").is_dir():
            time.sleep(0.001)
        second = run("batch", "in", *TO_PLY, status=1)
        _, said = first.communicate(timeout=60)
    assert "another batch is writing out/status.jsonl" in second.stderr
    assert "12 done, 0 were done before, 0 failed" in said
    assert len(lines(scans / "out")) == 12
    assert not list((scans / "out").glob("*.tmp"))


def test_long_lists(scans: Path) -> None:
    """A part of many lines; the memory is that of their text, a few times."""
    count = 20000
    (scans / "l.jsonl").write_text(
        "".join(f'{{"input": "gone/{k}.obj", "resolution": {k % 7 + 8}}}\n' for k in range(count))
    )
    with subprocess.Popen(
        [PROGRAM, "batch", "l.jsonl", "-o", "out", "--shard", f"7/{count}", "--quiet"], cwd=scans
    ) as process:
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 1
    [line] = lines(scans / "out", f"status.7-of-{count}.jsonl")
    assert line["input"] == "gone/6.obj"
    own = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert usage.ru_maxrss <= max(own, 100_000), "kB; a child begins with its parent's"


def slurm(folder: Path, task: int, first: int, count: int, *words: str) -> int:
    script = Path(__file__).parents[2] / "scripts/slurm_batch.sh"
    return subprocess.run(
        ["bash", script, "in", "out", *words], cwd=folder, capture_output=True, timeout=60,
        env={
            "PATH": os.environ["PATH"], "LITTORAL": PROGRAM, "SLURM_ARRAY_TASK_ID": str(task),
            "SLURM_ARRAY_TASK_MIN": str(first), "SLURM_ARRAY_TASK_COUNT": str(count),
            "SLURM_CPUS_PER_TASK": "1",
        },
    ).returncode  # fmt: skip


def test_tasks_of_a_slurm_array(scans: Path) -> None:
    """In any order, one of them twice, as after it was requeued: each input is done once."""
    tasks = [5, 6, 7, 8, 9, 6]
    random.Random(1).shuffle(tasks)
    for task in tasks:
        assert slurm(scans, task, 5, 5, "--verb", "convert", "--to", ".ply") == 0
    names = sorted(p.name for p in (scans / "out").glob("status*"))
    assert names == [f"status.{k}-of-5.jsonl" for k in range(1, 6)]
    seen = [line["input"] for name in names for line in lines(scans / "out", name)]
    assert sorted(seen) == [f"in/{k:02d}.obj" for k in range(12)]
    assert len(list((scans / "out").glob("*.ply"))) == 12
    assert slurm(scans, 5, 5, 5, "--verb", "nonsense") == 2
