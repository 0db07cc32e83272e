"""Many inputs: what becomes of each is a line, and nothing ends the rest."""

import fcntl
import gzip
import hashlib
import json
import os
import signal
import subprocess
import time
from pathlib import Path
from typing import Any

import pytest
from conftest import PROGRAM, Run, square

Lines = list[dict[str, Any]]


def lines(folder: Path, name: str = "status.jsonl") -> Lines:
    return [json.loads(line) for line in (folder / name).read_text().splitlines()]


def files(folder: Path) -> list[str]:
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


def batch(folder: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    """Without the checks of `run`: the summary goes to stderr."""
    return subprocess.run(
        [PROGRAM, "batch", *map(str, arguments)],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=60,
    )


@pytest.fixture
def scans(tmp_path: Path) -> Path:
    """Four small meshes in two folders, two of one name, and one that is none."""
    for name, size in (("a/x.obj", 3), ("a/y.obj", 2), ("b/x.obj", 4), ("b/sub/z.obj", 1)):
        (tmp_path / "in" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "in" / name).write_text(square(size))
    (tmp_path / "in/a/bad.obj").write_text("v 0 0 0\nv 1 0 0\nf 1 2 9\n")
    return tmp_path


TO_PLY = ("--verb", "convert", "--to", ".ply", "-o", "out")


def test_each_input_has_a_line_and_its_results(scans: Path) -> None:
    done = batch(scans, "in", *TO_PLY)
    assert done.returncode == 1, "one has failed"
    assert "4 done, 0 were done before, 1 failed of 5" in done.stderr
    assert "1 input: in/a/bad.obj:3: " in done.stderr
    status = {line["input"]: line for line in lines(scans / "out")}
    assert set(status) == {f"in/{name}" for name in files(scans / "in")}
    x = status["in/a/x.obj"]
    assert x["hash"] == hashlib.sha256((scans / "in/a/x.obj").read_bytes()).hexdigest()
    assert (x["status"], x["message"], x["attempts"]) == ("done", "", 1)
    assert x["options"] == ["convert", "--to=.ply"]
    assert x["outputs"] == ["a/x.ply"]
    assert 0 < x["seconds"] < 60 and x["peak_memory"] > 1e6
    assert status["in/a/bad.obj"]["status"] == "input"
    assert files(scans / "out") == ["a/x.ply", "a/y.ply", "b/sub/z.ply", "b/x.ply", "status.jsonl"]


def test_results_are_those_of_the_verb_alone(run: Run, scans: Path) -> None:
    options = ("--resolution", "12", "--method", "closest-point")
    run("sdf", "in/a/x.obj", *options, "-o", "alone.npz")
    assert batch(scans, "in/a/x.obj", *options, "-o", "out", "--json").returncode == 0
    assert (scans / "out/x.npz").read_bytes() == (scans / "alone.npz").read_bytes()
    [line] = lines(scans / "out")
    assert line["report"]["method"] == "closest-point"
    assert line["report"]["outputs"] == ["out/x.npz"]


def test_processes_start_quickly(scans: Path) -> None:
    summary = json.loads(batch(scans, "in", "--verb", "info", "-o", "out", "--json").stdout)
    assert summary["jobs"] == 5
    print(f"a process starts in {summary['start_seconds'] * 1000:.2f} ms")
    assert summary["start_seconds"] < 0.05, "5 ms, and ten times as much for a busy machine"
    assert lines(scans / "out")[0]["report"] is not None


def test_resume_does_what_is_new_changed_or_failed(scans: Path) -> None:
    batch(scans, "in", *TO_PLY)
    (scans / "in/a/y.obj").write_text(square(5))  # changed
    os.utime(scans / "in/a/x.obj")  # not changed
    (scans / "in/new.obj").write_text(square(1))
    (scans / "out/b/x.ply").unlink()
    again = batch(scans, "in", *TO_PLY)
    assert "3 done, 2 were done before, 1 failed of 6" in again.stderr
    assert [x["name"] for x in lines(scans / "out")[5:] if x["status"] == "done"] != []
    (scans / "in/a/bad.obj").write_text(square(1))
    assert "1 done, 5 were done before, 0 failed" in batch(scans, "in", *TO_PLY).stderr
    other = batch(scans, "in", *TO_PLY, "--triangulate")
    assert "6 done, 0 were done before" in other.stderr, "other options"
    assert "6 done" in batch(scans, "in", *TO_PLY, "--triangulate", "--no-resume").stderr


def test_a_torn_line_is_taken_away(scans: Path) -> None:
    batch(scans, "in", *TO_PLY)
    path = scans / "out/status.jsonl"
    whole = path.read_text().splitlines(keepends=True)
    [torn] = [line for line in whole if "b/x.obj" in line]
    path.write_text("".join(line for line in whole if line != torn) + torn[:40])
    assert "1 done, 3 were done before, 1 failed" in batch(scans, "in", *TO_PLY).stderr
    assert len(lines(scans / "out")) == 6


def test_results_of_one_name_do_not_overwrite_each_other(run: Run, scans: Path) -> None:
    run("convert", "in/a/y.obj", "-o", "in/a/x.ply")
    batch(scans, "in/a/x.*", "--verb", "convert", "--to", ".off", "-o", "out")
    assert files(scans / "out") == ["status.jsonl", "x.obj.off", "x.ply.off"]
    packed = gzip.compress((scans / "in/a/x.obj").read_bytes())
    (scans / "in/a/x.obj.gz").write_bytes(packed)
    batch(scans, "in/a/x.*", "--verb", "convert", "--to", ".off", "-o", "out")
    assert "x.obj.gz.off" in files(scans / "out")
    (scans / "in/a/x.obj.gz").unlink()
    (scans / "twice.txt").write_text("in/a/x.obj\n'in/a/x.obj' --triangulate\n")
    failed = run("batch", "twice.txt", *TO_PLY, status=2)
    assert "would both be named 'in/a/x.obj': give one of them another name" in failed.stderr
    (scans / "twice.txt").write_text("in/a/x.obj\n'in/a/x.obj' --triangulate --name other\n")
    assert batch(scans, "twice.txt", *TO_PLY).returncode == 0
    assert "other.ply" in files(scans / "out")


def test_lists_with_options_by_line(scans: Path) -> None:
    (scans / "list.txt").write_text("# a comment\n\nin/a/x.obj --resolution 9\nin/b/x.obj\n")
    (scans / "list.csv").write_text(
        "input,resolution,flip,verb\nin/a/x.obj,9,true,\nin/b/x.obj,,false,info\n"
    )
    (scans / "list.jsonl").write_text(
        '{"input": "in/a/x.obj", "resolution": 9, "to": [".npz", ".vti"]}\n'
        '{"input": "in/b/x.obj", "verb": "info", "name": "facts"}\n'
    )
    volume = ["sdf", "--to=.npz"]
    for name, options in (
        ("list.txt", [[*volume, "--resolution=9"], [*volume, "--resolution=7"]]),
        ("list.csv", [["sdf", "--to=.npz", "--resolution=9", "--flip"], ["info"]]),
        ("list.jsonl", [["sdf", "--to=.npz", "--to=.vti", "--resolution=9"], ["info"]]),
    ):  # fmt: skip
        made = batch(scans, name, "--resolution", "7", "-o", name + ".out")
        assert made.returncode == 0, made.stderr
        by_input = {line["input"]: line for line in lines(scans / (name + ".out"))}
        assert [by_input[f"in/{x}/x.obj"]["options"] for x in "ab"] == options
    assert by_input["in/b/x.obj"]["name"] == "facts"
    assert files(scans / "list.jsonl.out") == ["in/a/x.npz", "in/a/x.vti", "status.jsonl"]


@pytest.mark.parametrize(
    "jobs, said",
    [
        ("empty", "there are no inputs in the folder empty"),
        ("nothing/*.obj", "no file matches nothing/*.obj"),
        ("in/**/*.obj", "name the folder"),
        ("nowhere.obj", "there is no file or folder nowhere.obj"),
        ("empty.txt", "there are no inputs in the list empty.txt"),
    ],
)
def test_no_inputs(run: Run, scans: Path, jobs: str, said: str) -> None:
    (scans / "empty").mkdir()
    (scans / "empty.txt").write_text("# nothing\n")
    assert said in run("batch", jobs, "-o", "out", status=2).stderr


@pytest.mark.parametrize(
    "name, text, said",
    [
        ("l.jsonl", '{"input": "a.obj"}\n{"input": ', "l.jsonl:2: the line is not valid JSON"),
        ("l.jsonl", "[1]\n", "l.jsonl:1: expected an object"),
        ("l.jsonl", '{"verb": "sdf"}\n', "l.jsonl:1: there is no input"),
        ("l.jsonl", '{"input": "a.obj", "resolutoin": 3}\n', "l.jsonl:1: littoral sdf has no"),
        ("l.jsonl", '{"input": "a.obj", "resolution": "x"}\n', "l.jsonl:1: option --resolution"),
        ("l.csv", "name\na.obj\n", "l.csv:1: the first line names the columns"),
        ("l.csv", "input,flip\na.obj\n", "l.csv:2: 1 cell for 2 columns"),
        ("l.txt", "a.obj\n'b.obj\n", "l.txt:2: a quotation does not end"),
        ("l.txt", "a.obj --verb compare\n", "l.txt:1: option --verb: batch is for verbs of one"),
    ],
)  # fmt: skip
def test_a_bad_line_is_named(run: Run, scans: Path, name: str, text: str, said: str) -> None:
    (scans / name).write_text(text)
    assert said in run("batch", name, "-o", "out", status=2).stderr
    assert not (scans / "out/status.jsonl").exists()


@pytest.mark.parametrize(
    "arguments, said",
    [
        (("--verb", "sfd"), "there is no verb 'sfd'"),
        (("--verb", "compare"), "batch is for verbs of one input, and compare takes 2"),
        (("--verb", "methods"), "methods takes no file"),
        (("--verb", "batch"), "batch is for verbs of one input"),
        (("--resolutoin", "3"), "littoral sdf has no option '--resolutoin'"),
        (("--resolution", "many"), "--resolution"),
        (("--to", ".xyz9"), "no verb writes '.xyz9'; possible: .obj"),
        (("--to", "ply"), "no verb writes 'ply'"),
        (("--shard", "3/2"), "there is no part 3 of 2"),
        (("--shard", "x"), "'x' is not I/N"),
        (("--memory-limit", "lots"), "--memory-limit"),
        (("--memory-limit", "4"), "--memory-limit: 4 bytes are too few: units are MB and GB"),
    ],
)
def test_bad_usage(run: Run, scans: Path, arguments: tuple[str, ...], said: str) -> None:
    assert said in run("batch", "in", *arguments, "-o", "out", status=2).stderr


def test_shards_are_a_partition(scans: Path) -> None:
    for shard in (1, 2, 3):
        assert batch(scans, "in", *TO_PLY, "--shard", f"{shard}/3").returncode in (0, 1)
    seen = [x["input"] for k in (1, 2, 3) for x in lines(scans / "out", f"status.{k}-of-3.jsonl")]
    assert sorted(seen) == [f"in/{name}" for name in files(scans / "in")]
    whole = batch(scans, "in", *TO_PLY)
    assert "0 done, 4 were done before, 1 failed of 5" in whole.stderr, "shards know of each other"


def test_time_limit_and_retry(scans: Path) -> None:
    (scans / "large.obj").write_text(square(300))
    (scans / "list.txt").write_text("large.obj --method quadratic\nin/a/x.obj\n")
    limits = ("--time-limit", "0.3", "--retry", "1", "--verb", "distance", "--vertex", "0")
    begin = time.monotonic()
    assert batch(scans, "list.txt", *limits, "-o", "out").returncode == 1
    assert time.monotonic() - begin < 10
    large = next(x for x in lines(scans / "out") if x["input"] == "large.obj")
    assert (large["status"], large["attempts"]) == ("time", 2)
    assert large["message"] == "stopped after the time limit of 0.3 s"
    assert files(scans / "out") == ["in/a/x.ply", "status.jsonl"]


def test_memory_limit(scans: Path) -> None:
    made = batch(scans, "in/a/x.obj", "--resolution", "300", "--memory-limit", "150MB", "-o", "out")
    assert made.returncode == 1
    [line] = lines(scans / "out")
    assert line["status"] == "memory", line
    assert "memory" in line["message"]
    assert line["peak_memory"] < 400e6
    assert files(scans / "out") == ["status.jsonl"]


def test_memory_that_is_foreseen_not_to_suffice(scans: Path) -> None:
    made = batch(scans, "in/a/x.obj", "--resolution", "900", "--memory-limit", "150MB", "-o", "out")
    assert made.returncode == 1
    [line] = lines(scans / "out")
    assert line["status"] == "memory" and "a grid of" in line["message"], line
    made = batch(scans, "in/a/x.obj", "--verb", "info", "--memory-limit", "4MB", "-o", "little")
    assert made.returncode == 0, lines(scans / "little")


def test_no_more_threads_than_the_memory_limit_has_room_for(scans: Path) -> None:
    """Each reserves a stack, and room for copies of blocks."""
    (scans / "square.obj").write_text(square(60))
    words = ("--verb", "distance", "--vertex", "0", "--method", "signed-heat", "--threads", "64")
    limits = ("--memory-limit", "200MB", "--time-limit", "20")
    made = batch(scans, "square.obj", *words, *limits, "-o", "out")
    assert made.returncode == 0, lines(scans / "out")


def test_vanished_inputs_and_pipes(scans: Path) -> None:
    os.mkfifo(scans / "pipe.obj")
    (scans / "list.txt").write_text("gone.obj\npipe.obj\nin/a/x.obj\n")
    assert batch(scans, "list.txt", *TO_PLY).returncode == 1
    said = {x["input"]: x["message"] for x in lines(scans / "out")}
    assert said["gone.obj"] == "cannot read gone.obj: there is no such file"
    assert said["pipe.obj"] == "cannot read pipe.obj: it is no regular file"
    assert said["in/a/x.obj"] == ""


def test_fail_fast(scans: Path) -> None:
    (scans / "list.txt").write_text("gone.obj\n" + "in/a/x.obj\n")
    made = batch(scans, "list.txt", *TO_PLY, "--fail-fast", "--jobs", "1")
    assert made.returncode == 1
    assert [x["input"] for x in lines(scans / "out")] == ["gone.obj"]


def test_full_disk(scans: Path) -> None:
    """Files may grow to 1024 bytes only: first a result does not fit, then no line."""
    command = f'ulimit -f 1; trap "" XFSZ; exec "{PROGRAM}" batch in {" ".join(TO_PLY)} --jobs 1'
    for name in ("x", "y", "bad"):
        (scans / f"in/a/{name}.obj").write_text(square(30))
    made = subprocess.run(
        ["bash", "-c", command], cwd=scans, capture_output=True, text=True, timeout=60
    )
    assert made.returncode == 1
    assert "littoral: error: cannot write out/status.jsonl: File too large" in made.stderr
    known = lines(scans / "out")  # whole lines
    assert known[0]["status"] == "io"
    assert known[0]["message"].startswith("cannot write out/a/")
    assert "File too large" in known[0]["message"]
    assert ".tmp" not in known[0]["message"]
    assert not [p for p in files(scans / "out") if "tmp" in p]
    assert batch(scans, "in", *TO_PLY).returncode == 0


@pytest.mark.skipif(os.geteuid() == 0, reason="the superuser may write everywhere")
def test_read_only_folder(run: Run, scans: Path) -> None:
    (scans / "out").mkdir(mode=0o555)
    assert "cannot write out/status.jsonl" in run("batch", "in", *TO_PLY, status=1).stderr


def test_folder_that_cannot_be(run: Run, scans: Path) -> None:
    (scans / "out").write_text("a file")
    failed = run("batch", "in", *TO_PLY, status=1)
    assert "cannot make the folder out" in failed.stderr


def test_two_batches_do_not_write_one_file(run: Run, scans: Path) -> None:
    batch(scans, "in", *TO_PLY)
    with (scans / "out/status.jsonl").open("a") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        failed = run("batch", "in", *TO_PLY, status=1)
    assert "another batch is writing out/status.jsonl" in failed.stderr


def descendants(pid: int) -> list[int]:
    found = []
    for task in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = task.read_text().rsplit(")", 1)[1].split()
        except OSError:
            continue
        if int(fields[1]) == pid:
            child = int(task.parent.name)
            found += [child, *descendants(child)]
    return found


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_interrupted_batches_go_on(scans: Path, number: int) -> None:
    (scans / "in/a/large.obj").write_text(square(300))
    hard = ("in/a", "--verb", "distance", "--vertex", "0", "--method", "exact", "-o", "out")
    with subprocess.Popen(
        [PROGRAM, "batch", *hard, "--jobs", "1"],
        cwd=scans,
        stderr=subprocess.PIPE,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    ) as process:
        for _ in range(500):
            if len(descendants(process.pid)) >= 2 and len(lines(scans / "out")) >= 1:
                break
            time.sleep(0.01)
        children = descendants(process.pid)
        os.kill(process.pid, number)
        _, errors = process.communicate(timeout=10)
    assert process.returncode == (130 if number != signal.SIGKILL else -9), errors
    for _ in range(200):
        if not any(Path(f"/proc/{pid}").exists() for pid in children):
            break
        time.sleep(0.01)
    assert not any(Path(f"/proc/{pid}").exists() for pid in children)
    known = lines(scans / "out")
    (scans / "in/a/large.obj").write_text(square(3))
    assert batch(scans, *hard).returncode == 1  # bad.obj
    assert not (scans / "out/.status.tmp").exists()
    done = [x["input"] for x in lines(scans / "out") if x["status"] == "done"]
    assert sorted(done) == ["in/a/large.obj", "in/a/x.obj", "in/a/y.obj"], "each once"
    assert lines(scans / "out")[: len(known)] == known


def test_a_killed_input_is_a_line(scans: Path) -> None:
    (scans / "large.obj").write_text(square(300))
    (scans / "list.txt").write_text("large.obj\nin/a/x.obj\n")
    hard = ("--verb", "distance", "--vertex", "0", "--method", "quadratic", "--jobs", "1")
    with subprocess.Popen(
        [PROGRAM, "batch", "list.txt", *hard, "-o", "out"], cwd=scans, stderr=subprocess.PIPE
    ) as process:
        for _ in range(500):
            children = descendants(process.pid)
            if len(children) == 2:
                break
            time.sleep(0.01)
        time.sleep(0.5)  # until its input is read
        os.kill(children[-1], signal.SIGSEGV)
        process.communicate(timeout=30)
    assert process.returncode == 1
    first, second = lines(scans / "out")
    assert (first["status"], second["status"]) == ("crash", "done")
    assert first["message"].startswith("ended by signal 11 (Segmentation fault)")
    assert len(first["hash"]) == 64


def test_progress_has_a_rate(scans: Path) -> None:
    made = batch(scans, "in", *TO_PLY, "--progress", "always")
    assert "5 of 5, 1 failed, " in made.stderr and " a second, 0 s left" in made.stderr
    assert batch(scans, "in", *TO_PLY, "--quiet").stderr == ""
