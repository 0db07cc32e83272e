"""Functions called for many items, each in a process of its own."""

from __future__ import annotations

import contextlib
import faulthandler
import hashlib
import json
import os
import resource
import shutil
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import littoral


def status(folder: Path) -> dict[str, dict[str, Any]]:
    found = [
        json.loads(line)
        for path in sorted(folder.glob("status*.jsonl"))
        for line in path.read_text().splitlines()
    ]
    return {line["name"]: line for line in found}


def test_each_item_has_a_process_a_line_and_results(tmp_path: Path, sphere) -> None:
    sphere.save(tmp_path / "a.obj")
    (tmp_path / "bad.obj").write_text("nothing")
    seen: list[str] = []

    def work(path: str, output: str, scale: float) -> dict[str, Any]:
        seen.append(path)  # in another process
        mesh = littoral.read(path)
        np.save(output, scale * littoral.SDF(mesh)(mesh.points))
        return {"pid": os.getpid(), "vertices": mesh.n_vertices}

    items = [tmp_path / "a.obj", tmp_path / "bad.obj", tmp_path / "gone.obj"]
    named = {p.stem: p for p in items}
    done = littoral.batch(named, work, tmp_path / "out", to=".npy", options={"scale": 2.0})
    assert (done.jobs, done.done, done.failed) == (3, 1, 2)
    assert seen == []
    lines = status(tmp_path / "out")
    a = lines["a"]
    assert a["report"]["pid"] != os.getpid()
    assert a["report"]["vertices"] == sphere.n_vertices
    assert a["hash"] == hashlib.sha256((tmp_path / "a.obj").read_bytes()).hexdigest()
    assert a["outputs"] == ["a.npy"]
    assert len(np.load(tmp_path / "out/a.npy")) == sphere.n_vertices
    assert {lines[x]["status"] for x in ("bad", "gone")} == {"input"}
    assert done.start_seconds < 0.2
    again = littoral.batch(named, work, tmp_path / "out", to=".npy", options={"scale": 2.0})
    assert (again.done, again.unchanged, again.failed) == (0, 1, 2)
    other = littoral.batch(named, work, tmp_path / "out", to=".npy", options={"scale": 3.0})
    assert other.done == 1


def misbehave(item: list[Any], output: str) -> None:
    how, _ = item
    if how == "hang":
        time.sleep(100)
    if how == "memory":
        b"x" * (1 << 33)
    if how == "segv":
        faulthandler.disable()  # pytest's would print where
        os.kill(os.getpid(), signal.SIGSEGV)
    if how == "exit":
        os._exit(3)
    if how == "raise":
        raise KeyError("no such key")
    if how == "system exit":
        raise SystemExit(0)
    Path(output).mkdir()
    (Path(output) / "part").write_text(how)


def test_what_misbehaves_is_a_line(tmp_path: Path) -> None:
    ways = ["hang", "memory", "segv", "exit", "raise", "system exit", "fine"]
    done = littoral.batch(
        {way: [way, 1] for way in ways},
        misbehave,
        tmp_path / "out",
        time_limit=1.0,
        memory_limit=4e9,
        to=".dir",
    )
    lines = status(tmp_path / "out")
    assert {way: lines[way]["status"] for way in ways} == {
        "hang": "time", "memory": "memory", "segv": "crash", "exit": "crash",
        "raise": "internal", "system exit": "internal", "fine": "done",
    }  # fmt: skip
    assert "the limit is 4000 MB" in lines["memory"]["message"]
    assert lines["raise"]["message"] == "KeyError: 'no such key'"
    assert (tmp_path / "out/fine.dir/part").read_text() == "fine"
    assert sum(failure.count for failure in done.failures) == 6


@contextlib.contextmanager
def files_of_at_most(size: int) -> Iterator[None]:
    """As on a full disk: files cannot grow beyond so many bytes."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def test_results_that_do_not_fit_and_inputs_that_vanish(tmp_path: Path, sphere) -> None:
    """The library's files and others, with room for the status; later there is room for all."""
    for name in ("a", "b", "gone"):
        sphere.save(tmp_path / f"{name}.obj")

    def work(path: str, output: str) -> None:
        mesh = littoral.read(path)
        if Path(path).stem == "a":
            mesh.save(output)
        else:
            Path(output).write_bytes(b"x" * 10_000)

    items = [tmp_path / f"{name}.obj" for name in ("a", "b", "gone")]
    (tmp_path / "gone.obj").unlink()
    out = tmp_path / "out"
    named = {item.stem: item for item in items}
    with files_of_at_most(5000):
        full = littoral.batch(named, work, out, to=".ply")
    assert (full.done, full.failed) == (0, 3)
    lines = status(out)
    assert {name: line["status"] for name, line in lines.items()} == {
        "a": "io", "b": "io", "gone": "input"
    }  # fmt: skip
    assert lines["a"]["message"] == f"cannot write {out}/a.ply: File too large"
    assert "File too large" in lines["b"]["message"]
    assert lines["gone"]["message"] == f"cannot read {items[2]}: there is no such file"
    assert [path.name for path in out.iterdir()] == ["status.jsonl"]
    again = littoral.batch(named, work, out, to=".ply")
    assert (again.done, again.failed) == (2, 1)


def test_a_status_that_cannot_be_written(tmp_path: Path) -> None:
    def work(value: int, output: str) -> None:
        Path(output).write_text(str(value))

    out = tmp_path / "out"
    with files_of_at_most(600), pytest.raises(littoral.IoError, match=r"status\.jsonl: File too"):
        littoral.batch(range(20), work, out)
    lines = status(out)  # whole ones
    assert 1 <= len(lines) < 20
    again = littoral.batch(range(20), work, out)
    assert (again.done, again.unchanged) == (20 - len(lines), len(lines))
    assert len(status(out)) == 20
    with pytest.raises(littoral.IoError, match="cannot make the folder /proc/out"):
        littoral.batch(range(20), work, "/proc/out")


def test_large_values_and_reports(tmp_path: Path) -> None:
    """More at once than the system keeps between two processes: neither waits for the other."""

    def work(value: list[int], output: str) -> str:
        return "x" * 1_000_000

    items = [[k] + [7] * 100_000 for k in range(8)]
    made = littoral.batch(items, work, tmp_path / "out", processes=2)
    assert made.done == 8
    assert all(len(line["report"]) == 1_000_000 for line in status(tmp_path / "out").values())


def test_values_as_items_and_shards(tmp_path: Path) -> None:
    def square(value: int, output: str) -> int:
        return value * value

    for k in (1, 2, 3):
        littoral.batch(range(10), square, tmp_path / "out", shard=(k, 3))
    lines = status(tmp_path / "out")
    assert sorted(line["report"] for line in lines.values()) == [n * n for n in range(10)]
    whole = littoral.batch(range(10), square, tmp_path / "out")
    assert (whole.done, whole.unchanged) == (0, 10)
    with pytest.raises(littoral.InputError, match="no part 4 of 3"):
        littoral.batch(range(10), square, tmp_path / "out", shard=(4, 3))
    with pytest.raises(littoral.InputError, match="would both be named"):
        littoral.batch([1, 1], square, tmp_path / "out")
    with pytest.raises(TypeError, match="paths or what JSON can hold"):
        littoral.batch([object()], square, tmp_path / "out")


def test_interrupts_stop_a_batch(tmp_path: Path) -> None:
    def slow(value: int, output: str) -> None:
        time.sleep(0 if value == 0 else 100)

    def interrupt() -> None:
        for _ in range(300):
            if len(status(tmp_path / "out")) == 1:
                break
            time.sleep(0.01)
        os.kill(os.getpid(), signal.SIGINT)

    watcher = threading.Thread(target=interrupt)
    watcher.start()
    with pytest.raises(KeyboardInterrupt):
        littoral.batch(range(5), slow, tmp_path / "out", processes=1)
    watcher.join()
    assert [line["status"] for line in status(tmp_path / "out").values()] == ["done"]
    assert not (tmp_path / "out/.status.tmp").exists()


def test_paths_of_object_stores(tmp_path: Path, sphere) -> None:
    pytest.importorskip("fsspec")
    sphere.save(tmp_path / "a.obj")

    def work(path: str, output: str) -> str:
        Path(output).write_text(str(littoral.read(path).n_vertices))
        return path

    url = f"file://{tmp_path}"
    both = [f"{url}/a.obj", f"{url}/gone.obj"]
    for n in (1, 0):
        done = littoral.batch(both, work, f"{url}/results", to=".txt", state=tmp_path / "state")
        assert (done.done, done.unchanged, done.failed) == (n, 1 - n, 1)
    [written] = (tmp_path / "results").rglob("a.txt")
    assert written.read_text() == str(sphere.n_vertices)
    assert not list((tmp_path / "results").rglob("*.part"))
    assert (tmp_path / "results/status.jsonl").read_bytes() == (
        tmp_path / "state/status.jsonl"
    ).read_bytes()
    for state in (None, tmp_path / "new"):  # what is done is known from there
        done = littoral.batch(both, work, f"{url}/results", to=".txt", state=state)
        assert (done.done, done.unchanged, done.failed) == (0, 1, 1)
    with pytest.raises(littoral.InputError, match="state"):
        littoral.batch(both, work, tmp_path / "local", state=tmp_path / "state")


@pytest.fixture(scope="module")
def bucket() -> Iterator[str]:
    """The URL of an empty bucket in an object store of this machine."""
    pytest.importorskip("s3fs")
    moto = pytest.importorskip("moto.server")
    server = moto.ThreadedMotoServer(ip_address="127.0.0.1", port=0)
    with pytest.MonkeyPatch.context() as patch:
        for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
            patch.setenv(name, "none")
        server.start()
        host, port = server.get_host_and_port()
        patch.setenv("AWS_ENDPOINT_URL_S3", f"http://{host}:{port}")
        import fsspec

        fsspec.filesystem("s3").mkdir("littoral-tests")
        yield "s3://littoral-tests"
        server.stop()


@pytest.mark.parametrize("work", ["thickness", "convert"])
def test_an_object_store(bucket: str, tmp_path: Path, sphere, work: str) -> None:
    """Inputs, results and status of functions and verbs, in parts that know of each other."""
    if work == "convert" and shutil.which(os.environ.get("LITTORAL", "littoral")) is None:
        pytest.skip("needs the program littoral")
    import fsspec

    fs = fsspec.filesystem("s3")
    sphere.save(tmp_path / "ball.obj")
    (tmp_path / "bad.obj").write_text("nothing")
    folder = f"{bucket}/{work}"
    for name, path in (("a/x", "ball"), ("y", "ball"), ("z", "bad")):
        fs.put_file(str(tmp_path / f"{path}.obj"), f"{folder}/in/{name}.obj")

    def thickness(path: str, output: str) -> float:
        volume = littoral.SDF(littoral.read(path)).sample(8)
        volume.save(output)
        return float(volume.values.min())

    what, to = (thickness, ".npz") if work == "thickness" else ("convert", ".ply")
    made = [littoral.batch(f"{folder}/in", what, f"{folder}/out", to=to, shard=(k, 2))
            for k in (1, 2)]  # fmt: skip
    assert [(s.jobs, s.done, s.failed) for s in made] == [(2, 1, 1), (1, 1, 0)]
    whole = littoral.batch(f"{folder}/in", what, f"{folder}/out", to=to)
    assert (whole.done, whole.unchanged, whole.failed) == (0, 2, 1)
    names = [path.partition("/out/")[2] for path in fs.find(f"{folder}/out")]
    results = [f"a/x{to}", "status.1-of-2.jsonl", "status.2-of-2.jsonl", "status.jsonl", f"y{to}"]
    assert sorted(names) == sorted(results)
    lines = [json.loads(x) for n in names if n.startswith("status") for x in
             fs.cat_file(f"{folder}/out/{n}").splitlines()]  # fmt: skip
    by_input = {line["input"].rpartition("/in/")[2]: line["status"] for line in lines}
    assert by_input == {"a/x.obj": "done", "y.obj": "done", "z.obj": "input"}


def counting() -> Callable[[int, str], int]:
    """A function that no module holds, so that workers get it as it is."""

    def counted(item: int, output: str) -> int:
        time.sleep(0.05)
        Path(output).write_text(str(item))
        return os.getppid()

    return counted


@pytest.mark.slow
def test_dask_workers_may_die(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    from littoral.dask import batch

    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, dashboard_address=None, processes=True
        ) as cluster,
        distributed.Client(cluster) as client,
    ):
        victim = next(iter(client.run(os.getpid).values()))

        def kill() -> None:
            while len(status(tmp_path / "out")) < 10:
                time.sleep(0.01)
            os.kill(victim, signal.SIGKILL)

        killer = threading.Thread(target=kill, daemon=True)
        killer.start()
        batch(client, list(range(60)), counting(), tmp_path / "out", shards=6)
        killer.join()
    assert_all_once(tmp_path / "out", 60)


def assert_all_once(folder: Path, count: int) -> None:
    lines = [
        json.loads(line)
        for path in folder.glob("status*.jsonl")
        for line in path.read_text().splitlines()
    ]
    done = sorted(line["input"] for line in lines if line["status"] == "done")
    assert done == sorted(str(n) for n in range(count)), "each once"
    results = sorted(int(p.read_text()) for p in folder.iterdir() if p.suffix == "")
    assert results == list(range(count))


def test_ray_workers_may_die(tmp_path: Path) -> None:
    ray = pytest.importorskip("ray")
    from littoral.ray import batch

    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, configure_logging=False)
    try:
        killed: list[int] = []

        def kill() -> None:
            while len(status(tmp_path / "out")) < 10:
                time.sleep(0.01)
            for line in Path("/proc").glob("[0-9]*/cmdline"):
                try:
                    text = line.read_bytes()
                except OSError:
                    continue
                if text.startswith(b"ray::batch") and not killed:
                    killed.append(int(line.parent.name))
                    os.kill(killed[0], signal.SIGKILL)

        killer = threading.Thread(target=kill, daemon=True)
        killer.start()
        batch(list(range(60)), counting(), tmp_path / "out", shards=6)
        killer.join()
        assert killed
    finally:
        ray.shutdown()
    assert_all_once(tmp_path / "out", 60)
