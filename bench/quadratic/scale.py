"""Quadratic-order geodesics by the number of faces.

usage: scale.py MESH[:SUBDIVISIONS]... [--limit SECONDS]      prints a Markdown table

One vertex source, default options, all cores; seconds of the whole program by the clock and of the
processor, in brackets those of the solver alone by the clock.
"""

import argparse
import subprocess
import tempfile
import time
from pathlib import Path

from surface import load, subdivided, timed, write_obj


def row(name: str, limit: int) -> str:
    """What one mesh takes."""
    path, _, times = name.partition(":")
    points, faces = subdivided(*load(Path(path)), int(times or 0))
    first = f"| {Path(path).stem} | {len(faces)} | "
    with tempfile.TemporaryDirectory() as folder:
        mesh = Path(folder) / "mesh.obj"
        write_obj(mesh, points, faces)
        out = ["--method", "quadratic", "-o", str(Path(folder) / "d.npy")]
        start = time.monotonic()
        try:
            report, seconds = timed(["distance", str(mesh), "--vertex", "0", *out], limit)
        except subprocess.CalledProcessError:
            return first + f"not ended after {limit} processor seconds |"
        clock = time.monotonic() - start
    steps, residuals = report["iterations"]["interior point"], report["residuals"]
    return (
        f"{first}{report['sizes']['samples']} | {steps:.0f} | {clock:.1f} "
        f"({report['timings']['solve']:.1f}) | {seconds:.1f} | {report['peak_memory_mb']:.0f} "
        f"| {residuals['duality gap']:.1e} | {report['status']} |"
    )


def main() -> None:
    """Prints the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("meshes", nargs="+")
    parser.add_argument("--limit", type=int, default=1000)
    arguments = parser.parse_args()
    titles = ["mesh", "faces", "samples", "steps", "clock, s (solver)", "processor, s", "peak, MB"]
    titles += ["gap", "status"]
    print("| " + " | ".join(titles) + " |\n" + "|---" * len(titles) + "|")
    for name in arguments.meshes:
        print(row(name, arguments.limit), flush=True)


if __name__ == "__main__":
    main()
