"""Times closest points with the sign of the winding number, and winding numbers, against libigl.

usage: queries.py TIMER MESH[:SUBDIVISIONS]... [--queries 100000] [--rounds 3] [--threads 1]
                  [--without SHARE]

TIMER is littoral_query_timer; MESH an .obj of triangles. Needs NumPy and PyPI's libigl. Both answer
the same points, drawn evenly from the box of the mesh and a tenth of it around; they take turns,
answers are compared first, medians are printed as a table in Markdown. --without leaves out the
faces in that share of the height, so that the surface has a boundary. libigl decides how many
threads it uses; run the script under `taskset -c 0` for one.
"""

import argparse
import os
import statistics
import subprocess
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import igl  # type: ignore[import-not-found]
import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
Faces = NDArray[np.int64]


class Run(NamedTuple):
    """Processor and clock seconds by stage, and the answers."""

    cpu: list[float]
    clock: list[float]
    distances: Numbers
    windings: Numbers


WORK = ("distance: building", "distance: queries", "winding: building", "winding: queries")


def read(text: str) -> tuple[Numbers, Faces]:
    """Vertices and triangles of MESH[:SUBDIVISIONS]; every triangle is cut into four each time."""
    name, _, times = text.partition(":")
    points, faces = [], []
    for line in Path(name).read_text().splitlines():
        word = line.split()
        if word and word[0] == "v":
            points.append([float(x) for x in word[1:4]])
        if word and word[0] == "f":
            faces.append([int(x.split("/")[0]) - 1 for x in word[1:4]])
    v, f = np.array(points), np.array(faces)
    for _ in range(int(times or 0)):
        sides = np.sort(np.concatenate([f[:, [0, 1]], f[:, [1, 2]], f[:, [2, 0]]]), axis=1)
        edges, which = np.unique(sides, axis=0, return_inverse=True)
        a, b, c = (which.reshape(3, -1) + len(v)).astype(f.dtype)
        v = np.concatenate([v, (v[edges[:, 0]] + v[edges[:, 1]]) / 2])
        f = np.concatenate(
            [
                np.stack([f[:, 0], a, c], 1),
                np.stack([a, f[:, 1], b], 1),
                np.stack([c, b, f[:, 2]], 1),
                np.stack([a, b, c], 1),
            ]
        )
    return v, f


def timed(body: Callable[[], object]) -> tuple[float, float, object]:
    """Processor and clock seconds, and the answer."""
    cpu, clock = time.process_time(), time.perf_counter()
    answer = body()
    return time.process_time() - cpu, time.perf_counter() - clock, answer


def theirs(v: Numbers, f: Faces, q: Numbers) -> Run:
    """Seconds of one call for distances and one for winding numbers, and the answers."""
    kind = igl.SIGNED_DISTANCE_TYPE_FAST_WINDING_NUMBER
    cpu, clock, signed = timed(lambda: igl.signed_distance(q, v, f, kind))
    cpu2, clock2, winding = timed(lambda: igl.fast_winding_number(v, f, q))
    distances = signed[0] if isinstance(signed, tuple) else signed
    return Run([cpu, cpu2], [clock, clock2], np.asarray(distances), np.asarray(winding))


def ours(timer: str, threads: int, folder: Path, n: int) -> Run:
    """Seconds by stage, and the answers."""
    command = [timer, str(folder / "m.obj"), str(folder / "q"), str(threads), str(folder / "out")]
    out = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    cpu, clock = zip(*([float(x) for x in line.split()] for line in out.splitlines()), strict=True)
    answers = np.fromfile(folder / "out").reshape(2, n)
    return Run(list(cpu), list(clock), answers[0], answers[1])


def exact(v: Numbers, f: Faces, q: Numbers) -> Numbers:
    """Winding numbers by all solid angles."""
    out = np.zeros(len(q))
    for i, x in enumerate(q):
        a, b, c = (v[f[:, k]] - x for k in range(3))
        la, lb, lc = (np.linalg.norm(p, axis=1) for p in (a, b, c))
        num = np.einsum("ij,ij->i", a, np.cross(b, c))
        den = la * lb * lc + (a * b).sum(1) * lc + (b * c).sum(1) * la + (c * a).sum(1) * lb
        out[i] = np.arctan2(num, den).sum() / (2 * np.pi)
    return out


def table(name: str, given: argparse.Namespace, folder: Path) -> None:
    """Compares and times one mesh."""
    v, f = read(name)
    height = (v[f[:, 0], 1] - v[:, 1].min()) / np.ptp(v[:, 1])
    f = f[height <= 1 - given.without]
    rows = ["v " + " ".join(repr(float(x)) for x in p) for p in v]
    rows += ["f " + " ".join(str(i + 1) for i in t) for t in f]
    (folder / "m.obj").write_text("\n".join(rows) + "\n")
    low, high = v.min(0), v.max(0)
    size = (high - low).max()
    q = np.random.default_rng(1).uniform(low - size / 10, high + size / 10, (given.queries, 3))
    q.tofile(folder / "q")
    runs, peers = [], []
    for _ in range(given.rounds):
        runs.append(ours(given.timer, given.threads, folder, len(q)))
        peers.append(theirs(v, f, q))
    mine, other = runs[0], peers[0]
    far = np.abs(np.abs(mine.distances) - np.abs(other.distances)).max() / size
    sides = int((np.sign(mine.distances) != np.sign(other.distances)).sum())
    few = np.random.default_rng(2).integers(0, len(q), 300)
    truth = exact(v, f, q[few])
    print(f"\n{Path(name.partition(':')[0]).stem}, {len(f):,} faces, {len(q):,} queries: ", end="")
    print(f"distances differ by {far:.1e} of the size, {sides} sides; largest error of the winding")
    print(
        f"number at 300 of them: {np.abs(mine.windings[few] - truth).max():.1e}, "
        f"libigl {np.abs(other.windings[few] - truth).max():.1e}\n"
    )
    print("| work | littoral, CPU s | clock s | libigl, CPU s | clock s | ratio of CPU |")
    print("|---|---|---|---|---|---|")

    def median(sets: list[list[float]], *columns: int) -> float:
        return statistics.median(sum(s[c] for c in columns) for s in sets)

    for what, columns, column in (("distance", (0, 1), 0), ("winding", (2, 3), 1)):
        cpu, clock = (
            median([r.cpu for r in runs], *columns),
            median([r.clock for r in runs], *columns),
        )
        peer, peer_clock = (
            median([p.cpu for p in peers], column),
            median([p.clock for p in peers], column),
        )
        print(
            f"| {what}, building and queries | {cpu:.3f} | {clock:.3f} | {peer:.3f} "
            f"| {peer_clock:.3f} | {cpu / peer:.2f} |"
        )
    for column, what in enumerate(WORK):
        cpu, clock = median([r.cpu for r in runs], column), median([r.clock for r in runs], column)
        print(f"| {what} alone | {cpu:.3f} | {clock:.3f} | | | |")


def main() -> None:
    """Prints a table for each mesh."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("timer")
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--queries", type=int, default=100000)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--without", type=float, default=0)
    given = parser.parse_args()
    load = os.getloadavg()[0]
    print(f"{os.cpu_count()} cores, load {load:.1f}, {given.threads} threads of ours")
    with tempfile.TemporaryDirectory() as folder:
        for name in given.meshes:
            table(name, given, Path(folder))


if __name__ == "__main__":
    main()
