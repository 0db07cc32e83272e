"""Throughput of batches: measure.py LITTORAL INPUTS OUT [SHARE].

What is in the files (`info`) for all inputs by `littoral batch`. Signed distance on a grid of 24
nodes along the longest side, for every SHARE-th of them, by the same, by a shell loop over the
program, and by a Python loop over libigl (as many grid points, fast winding number), which is begun
again where it crashes.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

PEER = """
import sys
import igl, numpy as np
for path in sys.stdin.read().split("\\n"):
    print("begin", path, flush=True)
    try:
        V, F = igl.read_triangle_mesh(path)[:2]
        low, high = V.min(0), V.max(0)
        h = 1.5 * (high - low).max() / 23
        axes = [np.arange(a - .25 * (high - low).max(), b + .25 * (high - low).max(), h)
                for a, b in zip(low, high)]
        x = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
        d = igl.signed_distance(x, V, F, igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER)[0]
        assert np.isfinite(d).all()
        print("done", path, flush=True)
    except Exception as error:
        print("failed", path, type(error).__name__, flush=True)
"""


def resident(pid: int) -> float:
    """Megabytes of a process."""
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * 4096 / 1e6
    except OSError:
        return 0.0


def children(pid: int) -> list[int]:
    path = Path(f"/proc/{pid}/task/{pid}/children")
    return [int(x) for x in path.read_text().split()] if path.exists() else []


def run_batch(program: str, inputs: str, out: str, *words: str) -> None:
    command = [program, "batch", inputs, *words, "-o", out, "--jobs", "2", "--json",
               "--time-limit", "60", "--memory-limit", "2GB"]  # fmt: skip
    memory = []
    begin = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        while process.poll() is None:
            time.sleep(0.5)
            pids = [process.pid, *children(process.pid)]
            memory.append([resident(pid) for pid in pids])
        summary = json.loads(process.stdout.read())
    seconds = time.monotonic() - begin
    lines = [json.loads(line) for line in (Path(out) / "status.jsonl").open()]
    each = [line["input"] for line in lines]
    print(f"batch {' '.join(words)}: {len(each)} lines, {len(set(each))} inputs, "
          f"{summary['done']} done, "
          f"{summary['failed']} failed, {seconds:.1f} s, {len(each) / seconds:.1f} a second, "
          f"load {os.getloadavg()[0]:.1f}, "
          f"start {1000 * summary['start_seconds']:.2f} ms")  # fmt: skip
    quarter = max(1, len(memory) // 4)
    for what, index in (("parent", 0), ("server", 1)):
        values = [m[index] for m in memory if len(m) > index]
        print(f"  {what}: {max(values[:quarter], default=0):.1f} MB in the first quarter, "
              f"{max(values[-quarter:], default=0):.1f} MB in the last")  # fmt: skip
    for failure in summary["failures"][:8]:
        print(f"  {failure['count']} {failure['status']}: {failure['message'][:90]}")


def run_loop(program: str, paths: list[str], out: str) -> None:
    begin = time.monotonic()
    done = 0
    for path in paths:
        command = [
            program,
            "sdf",
            path,
            "--resolution",
            "24",
            "--threads",
            "1",
            "-o",
            f"{out}/x.npz",
        ]
        done += subprocess.run(command, capture_output=True).returncode == 0
    seconds = time.monotonic() - begin
    print(f"loop over the program: {len(paths)} inputs, {done} done, {seconds:.1f} s, "
          f"{len(paths) / seconds:.1f} a second")  # fmt: skip


def run_peer(paths: list[str]) -> None:
    begin = time.monotonic()
    left, done, failed, crashed, hung = list(paths), 0, 0, 0, 0
    while left:
        try:
            ended = subprocess.run(
                [sys.executable, "-c", PEER], input="\n".join(left), capture_output=True,
                text=True, timeout=600,
            )  # fmt: skip
            said = ended.stdout
        except subprocess.TimeoutExpired as stopped:
            said = (stopped.stdout or b"").decode()
            hung += 1
        events = [line.split(" ", 1) for line in said.splitlines()]
        done += sum(event[0] == "done" for event in events)
        failed += sum(event[0] == "failed" for event in events)
        begun = [event[1] for event in events if event[0] == "begin"]
        ends = sum(event[0] in ("done", "failed") for event in events)
        if not begun:
            break
        crashed += len(begun) - ends
        left = left[len(begun) :]
    seconds = time.monotonic() - begin
    print(f"loop over libigl: {len(paths)} inputs, {done} done, {failed} exceptions, {crashed} "
          f"crashes that ended the loop, {hung} hangs, {seconds:.1f} s, "
          f"{len(paths) / seconds:.1f} a second")  # fmt: skip


def main() -> None:
    program, inputs, out = sys.argv[1:4]
    share = int(sys.argv[4]) if len(sys.argv) > 4 else 20
    run_batch(program, inputs, out + "/info", "--verb", "info")
    paths = sorted(str(p) for p in Path(inputs).rglob("*") if p.is_file())[::share]
    Path(out, "list.txt").write_text("".join(f"{path}\n" for path in paths))
    run_batch(program, out + "/list.txt", out + "/sdf", "--resolution", "24")
    run_loop(program, paths, out)
    run_peer(paths)


if __name__ == "__main__":
    main()
