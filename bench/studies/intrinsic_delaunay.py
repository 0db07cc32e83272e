"""What intrinsic Delaunay refinement does for distances on triangulations, bad ones and good ones.

usage: intrinsic_delaunay.py PROGRAM PAGE.md MESH... [-- MESH...]    needs numpy

Distance from one vertex against exact polyhedral distance, without and with --intrinsic-delaunay:
mean / largest error in per cent of the largest distance. Meshes with a smallest angle below one
degree get a row in one section of the page, the others in another. Those after -- are only refined,
by both methods, to see that this ends: what it took goes below the first table.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]
Ints = npt.NDArray[np.int64]

METHODS = ("signed-heat", "unsigned-heat")
COUNTS = ("flips", "vertices_added", "edges_not_delaunay")
LIMIT = 120  # seconds a call


def read_obj(path: Path) -> tuple[Floats, Ints]:
    rows = [line.split() for line in path.read_text().splitlines()]
    points = np.array([row[1:4] for row in rows if row[:1] == ["v"]], dtype=float)
    faces = [[int(c.split("/")[0]) - 1 for c in row[1:]] for row in rows if row[:1] == ["f"]]
    return points, np.array(faces)


def smallest_angle(points: Floats, faces: Ints) -> float:
    smallest = 180.0
    for k in range(3):
        a, b, c = (points[faces[:, (k + i) % 3]] for i in range(3))
        u, v = b - a, c - a
        angle = np.arctan2(np.linalg.norm(np.cross(u, v), axis=1), (u * v).sum(1))
        smallest = min(smallest, float(np.degrees(angle.min())))
    return smallest


def distance(program: str, mesh: Path, source: int, *options: str) -> tuple[Floats, dict[str, Any]]:
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out.txt"
        command = [program, "distance", str(mesh), "--vertex", str(source), "-o", str(out)]
        command += ["--json", "--quiet", *options]
        run = subprocess.run(command, check=True, capture_output=True, text=True, timeout=LIMIT)
        return np.loadtxt(out), json.loads(run.stdout)


def row(program: str, path: Path, folder: Path) -> tuple[float, str]:
    """The smallest angle and a line of a table."""
    mesh = folder / "mesh.obj"
    convert = [program, "convert", str(path), "--triangulate", "-o", str(mesh), "--quiet"]
    subprocess.run(convert, check=True, capture_output=True, text=True, timeout=LIMIT)
    points, faces = read_obj(mesh)
    source = int(np.unique(faces)[len(np.unique(faces)) // 3])
    exact, _ = distance(program, mesh, source, "--method", "exact")
    cells: list[str] = []
    sizes: dict[str, float] = {}
    seconds = 0.0
    for method in METHODS:
        for more in ([], ["--intrinsic-delaunay"]):
            phi, report = distance(program, mesh, source, "--method", method, *more)
            sizes = report["sizes"]
            seconds = report["timings"].get("retriangulation", 0.0)
            ok = np.isfinite(phi) & np.isfinite(exact)
            error = 100 * abs(phi[ok] - exact[ok]) / exact[ok].max()
            cells.append(f"{error.mean():.2f} / {error.max():.1f}")
    angle = smallest_angle(points, faces)
    numbers = [f"{sizes[f'intrinsic_{n}']:.0f}" for n in COUNTS]
    print(path.name, len(faces), f"{angle:.3g}", *numbers, f"{seconds:.2f} s", *cells, flush=True)
    line = [path.stem, str(len(faces)), f"{angle:.2g}°", *numbers, *cells]
    return angle, "| " + " | ".join(line) + " |"


def ends(program: str, paths: list[Path]) -> str:
    """Refines meshes of any kind; says what it took."""
    done, refused, late, flips, added, left = 0, 0, [], 0.0, 0.0, 0.0
    slowest = (0.0, "")
    for path in paths:
        try:
            for method in METHODS:
                more = ("--method", method, "--intrinsic-delaunay")
                _, report = distance(program, path, 0, *more)
        except subprocess.CalledProcessError as error:
            refused += 1
            print(path.name, error.stderr.strip().splitlines()[-1:], flush=True)
            continue
        except subprocess.TimeoutExpired:
            late.append(path.name)
            continue
        sizes = report["sizes"]
        if "intrinsic_flips" not in sizes:  # not a mesh
            continue
        done += 1
        flips += sizes["intrinsic_flips"]
        added += sizes["intrinsic_vertices_added"]
        left += sizes["intrinsic_edges_not_delaunay"]
        slowest = max(slowest, (report["timings"]["retriangulation"], path.name))
        print(path.name, sizes["faces"], *(sizes[f"intrinsic_{n}"] for n in COUNTS), flush=True)
    return (
        f"Refining alone ended on all of {done} further files: {flips:.0f} flips, {added:.0f} "
        f"vertices added, {left:.0f} edges left, at most {slowest[0]:.1f} s ({slowest[1]}); "
        f"{refused} files were refused with a message"
        + (f"; not done after {LIMIT} s: {', '.join(late)}.\n" if late else ".\n")
    )


def replace(page: Path, section: str, text: str) -> None:
    begin, end = f"<!-- {section} -->\n", f"<!-- end of {section} -->\n"
    head, rest = page.read_text().split(begin)
    page.write_text(head + begin + text + end + rest.split(end)[1])


def main(program: str, page: Path, meshes: list[Path], others: list[Path]) -> None:
    heads = ["mesh", "faces", "smallest angle", "flips", "added", "not Delaunay"]
    heads += [f"{m}{s}" for m in METHODS for s in ("", ", refined")]
    head = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    lines: dict[bool, list[str]] = {True: head[:], False: head[:]}
    refused = []
    for path in meshes:
        with tempfile.TemporaryDirectory() as folder:
            try:
                angle, line = row(program, path, Path(folder))
                lines[angle < 1].append(line)
            except subprocess.CalledProcessError as error:
                refused.append(f"{path.name} ({error.stderr.strip().splitlines()[-1]})")
                print(refused[-1], flush=True)
            except subprocess.TimeoutExpired:
                refused.append(f"{path.name} (not done after {LIMIT} s)")
    text = f"{len(meshes) - len(refused)} meshes were run"
    text += f"; left out: {', '.join(refused)}.\n" if refused else ".\n"
    if others:
        text += "\n" + ends(program, others)
    replace(page, "bad triangulations", "\n".join(lines[True]) + "\n\n" + text)
    replace(page, "other triangulations", "\n".join(lines[False]) + "\n")


if __name__ == "__main__":
    arguments = sys.argv[1:]
    split = arguments.index("--") if "--" in arguments else len(arguments)
    files = [Path(a) for a in arguments]
    main(arguments[0], files[1], files[2:split], files[split + 1 :])
