"""How much faster two threads are than one, beside what the machine's second core can give.

usage: two_threads.py PROGRAM DATA ROUNDS [NAME...]    prints Markdown

Each job is a whole run of the program, with reading and writing: on one thread, on two, and twice
at once on one thread each, which is what two cores are worth where nothing is shared. Rounds are
interleaved; seconds are medians by the clock. What one and two threads write must be the same
bytes. DATA is a folder with meshes in `surfaces`.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

JOBS = {
    "signed heat, 375k faces": "distance surfaces/spot_loop3.ply --vertex 0 --method signed-heat",
    "default, 375k faces": "distance surfaces/spot_loop3.ply --vertex 0",
    "exact, 375k faces": "distance surfaces/spot_loop3.ply --vertex 0 --method exact",
    "quadratic, 94k faces": "distance surfaces/spot_loop2.ply --vertex 0 --method quadratic",
    "regularized, 94k faces": "distance surfaces/spot_loop2.ply --vertex 0 --method regularized",
    "signed heat in space, 200 nodes": "sdf surfaces/fandisk.off --resolution 200"
    " --method signed-heat",
    "default in space, 500 nodes": "sdf surfaces/fandisk.off --resolution 500",
    "repair by a grid": "repair surfaces/stanford-bunny.obj --remesh --resolution 300",
    "pairs of 300 vertices, 70k faces": "pairs surfaces/nefertiti-lowres.obj --vertex "
    + ",".join(str(30 * i) for i in range(300)),
}


def seconds(*commands: list[str]) -> float:
    start = time.perf_counter()
    running = [subprocess.Popen(command, stdout=subprocess.DEVNULL) for command in commands]
    if any(process.wait() != 0 for process in running):
        sys.exit(f"failed: {' '.join(commands[0])}")
    return time.perf_counter() - start


def main(program: str, data: Path, rounds: int, names: list[str]) -> None:
    print(
        "| job | s, one thread | s, two threads | times as fast | two runs at once | same bytes |"
    )
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name in names or JOBS:
            verb, mesh, *words = JOBS[name].split()
            kind = ".ply" if verb == "repair" else ".npy"
            outs = [Path(folder) / f"{i}{kind}" for i in range(3)]
            start = [program, verb, str(data / mesh), *words, "--quiet"]
            first, two_threads, second = (
                [*start, "--threads", str(threads), "-o", str(out)]
                for threads, out in zip((1, 2, 1), outs, strict=True)
            )
            one, two, both = [], [], []
            for _ in range(rounds):
                one.append(seconds(first))
                two.append(seconds(two_threads))
                both.append(seconds(first, second))
            same = outs[0].read_bytes() == outs[1].read_bytes()
            a, b, c = (statistics.median(x) for x in (one, two, both))
            print(
                f"| {name} | {a:.2f} | {b:.2f} | {a / b:.2f} | {2 * a / c:.2f} | "
                f"{'yes' if same else '**no**'} |",
                flush=True,
            )


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), int(sys.argv[3]), sys.argv[4:])
