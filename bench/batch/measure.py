"""Throughput of batches: measure.py LITTORAL INPUTS OUT [SHARE].

What is in the files (`info`) for all inputs by `littoral batch`. Then, for every SHARE-th of them,
the signed distance on a grid of 24 nodes along the longest side, by the same and by a plain Python
loop over libigl (as many grid points, fast winding number), which is begun again behind an input
that crashes it or takes over 60 seconds. The same for every tenth of these by a shell loop over the
program. Others may use the machine: processor seconds stand beside those of the clock.
"""

import json
import os
import re
import resource
import select
import statistics
import subprocess
import sys
import time
from pathlib import Path

LIMIT = 60.0  # seconds for an input

PEER = """
import sys
import igl, numpy as np
for line in sys.stdin:
    path = line.rstrip("\\n")
    try:
        V, F = igl.read_triangle_mesh(path)[:2]
        low, high = V.min(0), V.max(0)
        h = 1.5 * (high - low).max() / 23
        axes = [np.arange(a - .25 * (high - low).max(), b + .25 * (high - low).max(), h)
                for a, b in zip(low, high)]
        x = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
        d = igl.signed_distance(x, V, F, igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER)[0]
        print("\\nend done" if np.isfinite(d).all() else "\\nend not finite", flush=True)
    except Exception as error:
        print("\\nend exception", type(error).__name__, flush=True)
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


class Cost:
    """Seconds by the clock and of the processor of what is run and waited for since."""

    def __init__(self) -> None:
        self.begin = time.monotonic()
        self.before = self.used()
        self.loads: list[float] = []

    @staticmethod
    def used() -> float:
        usage = resource.getrusage(resource.RUSAGE_CHILDREN)
        return usage.ru_utime + usage.ru_stime

    def text(self, inputs: int) -> str:
        seconds, processor = time.monotonic() - self.begin, self.used() - self.before
        load = statistics.mean([*self.loads, os.getloadavg()[0]])
        each = 1000 * processor / inputs
        return (f"{seconds:.0f} s, {inputs / seconds:.2f} a second, "
                f"{each:.1f} ms of a processor each, load {load:.1f}")  # fmt: skip


def run_batch(program: str, inputs: str, out: str, *words: str) -> None:
    command = [program, "batch", inputs, *words, "-o", out, "--jobs", "2", "--json",
               "--time-limit", str(LIMIT), "--memory-limit", "2GB"]  # fmt: skip
    memory = []
    cost = Cost()
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        while process.poll() is None:
            time.sleep(0.5)
            cost.loads.append(os.getloadavg()[0])
            pids = [process.pid, *children(process.pid)]
            memory.append([resident(pid) for pid in pids])
        summary = json.loads(process.stdout.read())
    lines = [json.loads(line) for line in (Path(out) / "status.jsonl").open()]
    each = [line["input"] for line in lines]
    kept = [line for line in lines if line["status"] == "done"]
    gone = sum(not (Path(out) / name).exists() for line in kept for name in line["outputs"])
    print(f"batch {' '.join(words)}: {summary['jobs']} inputs, {len(each)} lines of "
          f"{len(set(each))}, {summary['done']} done with {gone} results missing, "
          f"{summary['failed']} failed, "
          f"{cost.text(len(each))}, start {1000 * summary['start_seconds']:.2f} ms, "
          f"largest {summary['peak_memory'] / 1e6:.0f} MB")  # fmt: skip
    quarter = max(1, len(memory) // 4)
    for what, index in (("parent", 0), ("server", 1)):
        values = [m[index] for m in memory if len(m) > index]
        print(f"  {what}: {max(values[:quarter], default=0):.1f} MB in the first quarter, "
              f"{max(values[-quarter:], default=0):.1f} MB in the last")  # fmt: skip
    by_status: dict[str, int] = {}
    for line in lines:
        by_status[line["status"]] = by_status.get(line["status"], 0) + 1
    print(f"  {by_status}")
    for failure in summary["failures"][:12]:
        print(f"  {failure['count']} {failure['status']}: {failure['message'][:90]}", flush=True)


def run_loop(program: str, paths: list[str], out: str) -> None:
    cost = Cost()
    done = 0
    for path in paths:
        command = [program, "sdf", path, "--resolution", "24", "--threads", "1",
                   "-o", f"{out}/x.npz"]  # fmt: skip
        done += subprocess.run(command, capture_output=True).returncode == 0
        cost.loads.append(os.getloadavg()[0])
    print(f"loop over the program: {len(paths)} inputs, {done} done, {cost.text(len(paths))}",
          flush=True)  # fmt: skip


def run_peer(paths: list[str]) -> None:
    cost = Cost()
    ends: dict[str, int] = {}
    largest: list[float] = []
    left = list(paths)
    while left:
        with subprocess.Popen(
            [sys.executable, "-c", PEER], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, bufsize=0,
        ) as process:  # fmt: skip
            pending = b""
            while left:
                path = left.pop(0)
                process.stdin.write(path.encode() + b"\n")
                deadline = time.monotonic() + LIMIT
                while not (end := re.search(rb"^end (.*)\n", pending, re.M)):  # libigl prints too
                    ready = select.select([process.stdout], [], [], deadline - time.monotonic())[0]
                    got = process.stdout.read(4096) if ready else None
                    if not got:
                        break
                    pending += got
                how = end[1].decode() if end else "crash" if got == b"" else "hang"
                pending = b""
                ends[how] = ends.get(how, 0) + 1
                largest.append(resident(process.pid))
                cost.loads.append(os.getloadavg()[0])
                if not end:
                    process.kill()
                    break
            process.stdin.close()
    quarter = max(1, len(largest) // 4)
    print(f"loop over libigl: {len(paths)} inputs, {ends}, {cost.text(len(paths))}\n"
          f"  memory {max(largest[:quarter]):.1f} MB in the first quarter, "
          f"{max(largest[-quarter:]):.1f} MB in the last", flush=True)  # fmt: skip


def main() -> None:
    program, inputs, out = sys.argv[1:4]
    share = int(sys.argv[4]) if len(sys.argv) > 4 else 1
    run_batch(program, inputs, out + "/info", "--verb", "info")
    paths = sorted(str(p) for p in Path(inputs).rglob("*") if p.is_file())[::share]
    Path(out, "list.txt").write_text("".join(f"{path}\n" for path in paths))
    run_batch(program, out + "/list.txt", out + "/sdf", "--resolution", "24")
    run_peer(paths)
    run_loop(program, paths[::10], out)


if __name__ == "__main__":
    main()
