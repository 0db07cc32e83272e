"""Exact distance with sign on grids beside mesh2sdf (sweeps as in SDFGen): same meshes and nodes.

usage: grids.py TIMER OUTPUT.md NODES[,NODES]... MESH[:SUBDIVISIONS]...

TIMER is littoral_grid_timer. Meshes are moved into the middle four fifths of a cube of nodes. Both
use one thread and take turns; answers come first: both are compared with the distance to every
triangle at 400 nodes, and with each other everywhere. Tables hold medians over rounds.
"""

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mesh2sdf
import numpy as np
from compare import Floats, Ints, machine, read_mesh, replace_section, subdivide, write_obj

ROUNDS, SAMPLES = 3, 400


def to_all(p: Floats, a: Floats, b: Floats, c: Floats) -> float:
    """Distance from a point to the nearest of all triangles."""

    def to_side(start: Floats, end: Floats) -> Floats:
        along = end - start
        share = np.clip(((p - start) * along).sum(1) / (along**2).sum(1), 0, 1)
        out: Floats = np.linalg.norm(p - start - share[:, None] * along, axis=1)
        return out

    normal = np.cross(b - a, c - a)
    height = np.abs(((p - a) * normal).sum(1)) / np.linalg.norm(normal, axis=1)
    over = np.ones(len(a), dtype=bool)
    for start, end in ((a, b), (b, c), (c, a)):
        over &= (np.cross(normal, end - start) * (p - start)).sum(1) >= 0
    sides = np.minimum(np.minimum(to_side(a, b), to_side(b, c)), to_side(c, a))
    return float(np.where(over, height, sides).min())


def ours(timer: str, mesh: Path, nodes: int) -> tuple[list[float], Floats]:
    """Processor seconds of both stages, and values by x, y, z."""
    out = mesh.with_suffix(".values")
    done = subprocess.run(
        [timer, str(mesh), str(nodes), "1", str(out)], check=True, capture_output=True, text=True
    )
    seconds = [float(line.split()[0]) for line in done.stdout.splitlines()]
    return seconds, np.fromfile(out).reshape(nodes, nodes, nodes).transpose(2, 1, 0)


def theirs(points: Floats, faces: Ints, nodes: int) -> tuple[float, Floats]:
    begin = time.process_time()
    values = mesh2sdf.core.compute(points.astype(np.float32), faces.astype(np.uint32), nodes)
    return time.process_time() - begin, np.asarray(values, dtype=float)


def measure(timer: str, name: str, points: Floats, faces: Ints, nodes: int) -> str:
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "mesh.obj"
        write_obj(mesh, points, faces)
        mine, peer = [], []
        for _ in range(ROUNDS):
            seconds, values = ours(timer, mesh, nodes)
            mine.append(seconds)
            their_seconds, their_values = theirs(points, faces, nodes)
            peer.append(their_seconds)
    places = np.random.default_rng(1).integers(0, nodes, (SAMPLES, 3))
    corners = [points[faces[:, k]] for k in range(3)]
    truth = np.array([to_all(-1 + 2 / nodes * at, *corners) for at in places])
    size = float(np.ptp(points, axis=0).max())

    def errors(all_values: Floats) -> str:
        off = np.abs(np.abs(all_values[tuple(places.T)]) - truth) / size
        return f"{off.max():.1e}, {off.mean():.1e}"

    own_side, their_side = np.signbit(values), np.signbit(their_values)
    sides = int(np.count_nonzero(own_side != their_side))
    apart = float(np.abs(np.abs(values) - np.abs(their_values)).max()) / size
    n = nodes**3
    prepared, at_nodes, total = (
        statistics.median(x) for x in zip(*((a, b, a + b) for a, b in mine), strict=True)
    )
    theirs_total = statistics.median(peer)
    head = f"| {name} | {len(faces):,} | {nodes} |"
    return (
        f"{head} littoral | {errors(values)} | | {prepared:.2f} | {at_nodes:.2f} "
        f"| {1e6 * total / n:.2f} |\n"
        f"{head} mesh2sdf | {errors(their_values)} | | | {theirs_total:.2f} "
        f"| {1e6 * theirs_total / n:.2f} |\n"
        f"| | | | | differ by {apart:.1e} | {sides:,} | | | ratio {total / theirs_total:.2f} |\n"
    )


def main() -> None:
    timer, page, sizes, *meshes = sys.argv[1:]
    before = machine()
    text = (
        f"Processor seconds of one thread; medians of {ROUNDS} interleaved rounds.\n{before}.\n\n"
        "| mesh | faces | nodes a side | program | error at nodes, largest, mean, of the size "
        "| sides differ | prepared, s | nodes, s | us a node |\n"
        "|---|---|---|---|---|---|---|---|---|\n"
    )
    for spec in meshes:
        path, _, times = spec.partition(":")
        points, faces = read_mesh(path)
        for _ in range(int(times or 0)):
            points, faces = subdivide(points, faces)
        low, high = points.min(axis=0), points.max(axis=0)
        points = (points - (low + high) / 2) * (1.6 / (high - low).max())
        points = points.astype(np.float32).astype(float)  # the same surface for both
        name = Path(path).stem + (f", subdivided {times}x" if times else "")
        for nodes in sizes.split(","):
            text += measure(timer, name, points, faces, int(nodes))
            print(text.splitlines()[-3:], flush=True)
    replace_section(page, "grid peers", text)


if __name__ == "__main__":
    main()
