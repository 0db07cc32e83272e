"""What the default of `distance` costs beside signed heat: processor time of the whole program.

usage: default_time.py ROUNDS MESH...    needs littoral and scipy, and the program as LITTORAL;
prints Markdown

Sources: vertex 0, the nodal line of the second eigenfunction, the same with 30 % of its runs
missing. Rounds are interleaved; figures are medians of user seconds on one thread, and their
ratios.
"""

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from nodal import Lines, damaged, nodal_lines

import littoral

METHODS = ("auto", "signed-heat")


def user_seconds(words: list[str]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    subprocess.run(words, check=True, capture_output=True)
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before


def write_lines(path: Path, lines: Lines) -> None:
    """Curves in space, as lines of an OBJ file."""
    rows, first = [], 1
    for line in lines:
        rows += [f"v {x!r} {y!r} {z!r}" for x, y, z in line.tolist()]
        rows.append("l " + " ".join(str(first + i) for i in range(len(line))))
        first += len(line)
    path.write_text("\n".join(rows) + "\n")


def main(rounds: int, paths: list[Path]) -> None:
    program = os.environ["LITTORAL"]
    print("| mesh | triangles | from one vertex | closed curve | broken curve |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for path in paths:
            mesh = littoral.read(path)
            lines = nodal_lines(mesh, 2)[1]
            write_lines(Path(folder) / "whole.obj", lines)
            write_lines(Path(folder) / "broken.obj", damaged(lines, 0.3, 0, 5))
            sources = (["--vertex", "0"], ["-s", "whole.obj"], ["-s", "broken.obj"])
            cells = []
            for source in sources:
                words = [str(Path(folder) / w) if w.endswith(".obj") else w for w in source]
                seconds: dict[str, list[float]] = {name: [] for name in METHODS}
                for _ in range(rounds):
                    for name in METHODS:
                        run = [program, "distance", str(path), *words, "--method", name]
                        run += ["--threads", "1", "-o", str(Path(folder) / "out.npy")]
                        seconds[name].append(user_seconds(run))
                auto, heat = (float(np.median(seconds[name])) for name in METHODS)
                cells.append(f"{auto:.2f} / {heat:.2f} = {auto / heat:.2f}")
            print(f"| {path.stem} | {len(mesh.faces)} | " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]), [Path(p) for p in sys.argv[2:]])
