"""Times signed distance on grids against PyPI's signedheat3d, on the same input.

usage: space_speed.py LITTORAL MESH [--peer PYTHON] [--sizes 32 64 128] [--repeats 3]

PYTHON is an interpreter that has the peer and NumPy (`python -m venv V; V/bin/pip install
signedheat3d numpy`). Runs are interleaved; medians and the peak of memory are printed as a table in
Markdown. The peer and its answer are left out where no interpreter is named.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import tempfile
from pathlib import Path

PEER = """
points, faces = [], []
for line in open(sys.argv[1]):
    word = line.split()
    if word and word[0] == "v": points.append([float(x) for x in word[1:4]])
    if word and word[0] == "f": faces.append([int(x.split("/")[0]) - 1 for x in word[1:]])
start = time.process_time()
solver = signedheat3d.SignedHeatGridSolver(verbose=False)
phi, dimensions = solver.compute_distance_to_mesh(
    numpy.array(points), faces, {"resolution": [int(sys.argv[2])] * 3})[:2]
print(time.process_time() - start)
"""


def measured(command: list[str]) -> tuple[float, float, str]:
    """CPU seconds, peak memory in MB and what the command printed."""
    with tempfile.NamedTemporaryFile("w+") as out:
        child = subprocess.Popen(command, stdout=out)
        _, status, usage = os.wait4(child.pid, 0)
        if status != 0:
            raise SystemExit(f"failed: {' '.join(command)}")
        out.seek(0)
        return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024, out.read()


def ours(program: str, mesh: Path, n: int, folder: Path) -> tuple[float, float, float]:
    """CPU seconds, MB, seconds by the clock, of the whole program."""
    command = [program, "sdf", str(mesh), "--resolution", str(n), "--json"]
    cpu, memory, text = measured([*command, "-o", str(folder / "out.npy")])
    timings: dict[str, float] = json.loads(text)["timings"]
    return cpu, memory, sum(timings.values())


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program")
    parser.add_argument("mesh", type=Path)
    parser.add_argument("--peer")
    parser.add_argument("--sizes", type=int, nargs="+", default=[32, 64, 128])
    parser.add_argument("--repeats", type=int, default=3)
    given = parser.parse_args()
    script = Path(__file__).parent
    commit = subprocess.run(
        ["git", "-C", str(script), "rev-parse", "--short", "HEAD"], capture_output=True, text=True
    ).stdout.strip()
    print(f"{platform.machine()}, {os.cpu_count()} cores, commit {commit}, {given.mesh.name}\n")
    print("| nodes a side | littoral, CPU s | clock s | MB | signedheat3d, CPU s | ratio |")
    print("|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for n in given.sizes:
            runs, peer = [], []
            for _ in range(given.repeats):
                runs.append(ours(given.program, given.mesh, n, Path(folder)))
                if given.peer:
                    text = measured([given.peer, "-c", PEER, str(given.mesh), str(n)])[2]
                    peer.append(float(text.split()[-1]))
            cpu, memory, clock = (statistics.median(r[i] for r in runs) for i in range(3))
            theirs = statistics.median(peer) if peer else 0
            ratio = f"{theirs:.1f} | {theirs / cpu:.0f}" if peer else "- | -"
            print(f"| {n} | {cpu:.2f} | {clock:.2f} | {memory:.0f} | {ratio} |")


if __name__ == "__main__":
    main()
